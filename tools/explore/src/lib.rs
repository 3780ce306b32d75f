//! A model checker: an exhaustive search for sequences of commands and faults that violate a safety rule. The search
//! tries all sequences, the shortest first, up to a maximum number of states.
//!
//! The search does not explore a model of the firmware, but the firmware's own core, [`Main`], on the
//! [`VirtualBoard`]. A [`World`] contains both and an [`Observer`](lizard_rules::Observer). An [`Action`] is a command
//! or a fault. [`search()`] applies all actions to all initial states and to every state that it reaches. The search is
//! breadth first, so the first sequence that violates a rule is one of the shortest. States that differ little count as
//! equal ([`fingerprint`]).
//!
//! [`Main`]: lizard_core::step::Main
//! [`VirtualBoard`]: lizard_core::virtual_board::VirtualBoard

pub mod action;
pub mod fingerprint;
pub mod initial_states;
pub mod search;
pub mod small_robot;
pub mod world;

pub use action::Action;
pub use search::search;
pub use world::World;
