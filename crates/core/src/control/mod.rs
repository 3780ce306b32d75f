//! Control: executes orders, computes a frame fifty times a second, and reacts to faults.
//!
//! This layer handles no text: it accepts an [`order`] or returns a [`refusal`]. [`supervisor`] contains the decision
//! tables; [`safety`], [`supply`] and [`contact`] monitor the hardware; [`fault`] shows a fault on the LED.

mod controller;

pub mod contact;
pub mod fault;
pub mod order;
pub mod refusal;
pub mod safety;
pub mod supervisor;
pub mod supply;

pub use controller::Controller;
