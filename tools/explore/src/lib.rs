//! An exhaustive search for sequences of commands and faults that break a safety rule. It tries all
//! sequences, not a random sample, the shortest first, as many as time allows.
//!
//! The search does not explore a model of the firmware, but the firmware's own core, [`Main`], on
//! the board without a chip, [`VirtualBoard`]. A [`World`] contains both and an
//! [`Observer`](lizard_rules::Observer). An [`Action`] is a command or a fault. [`search()`]
//! applies all actions to all initial states and to every state reached, breadth first, so the
//! first sequence found that breaks a rule is a shortest one. States that differ little count as
//! one ([`fingerprint`]).
//!
//! [`Main`]: lizard_core::step::Main
//! [`VirtualBoard`]: lizard_core::virtual_board::VirtualBoard

pub mod action;
pub mod fingerprint;
pub mod initial_states;
pub mod search;
pub mod small;
pub mod world;

pub use action::Action;
pub use search::search;
pub use world::World;
