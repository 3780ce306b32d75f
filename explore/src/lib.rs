//! The supervisor, explored and not sampled: what a user may rely on after any
//! commands and any troubles, in every order that there is room for.
//!
//! No model of the firmware is explored but the firmware's own core, [`Main`], on
//! its board without a chip, [`VirtualBoard`]. A [`World`] is both and what a
//! bystander remembers ([`Seen`]); an [`Action`] is what may happen to it; and
//! [`search()`] goes from all beginnings through all actions, breadth first, so that the
//! first sequence found that breaks a rule is a shortest one.
//!
//! [`Main`]: lizard_core::step::Main
//! [`VirtualBoard`]: lizard_core::virtual_board::VirtualBoard

pub mod action;
pub mod beginnings;
pub mod fingerprint;
pub mod search;
pub mod seen;
pub mod small;
pub mod world;

pub use action::Action;
pub use search::search;
pub use seen::Seen;
pub use world::World;
