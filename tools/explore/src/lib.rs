//! Explores the supervisor instead of sampling it: what a user may rely on after any
//! commands and any faults, in as many orders as time allows.
//!
//! It does not explore a model of the firmware, but the firmware's own core, [`Main`], on
//! the board without a chip, [`VirtualBoard`]. A [`World`] contains both and what an
//! [`Observer`](lizard_rules::Observer) remembers. An [`Action`] is what may happen to it. [`search()`]
//! goes from all beginnings through all actions, breadth first, so the first sequence
//! found that breaks a rule is a shortest one.
//!
//! [`Main`]: lizard_core::step::Main
//! [`VirtualBoard`]: lizard_core::virtual_board::VirtualBoard

pub mod action;
pub mod beginnings;
pub mod fingerprint;
pub mod search;
pub mod small;
pub mod world;

pub use action::Action;
pub use search::search;
pub use world::World;
