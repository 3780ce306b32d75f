//! Control: executes orders, computes a frame fifty times a second, and reacts to faults.
//!
//! This layer handles no text: it accepts an [`order`] or refuses it with a [`refusal`]. [`supervisor`] contains the
//! decision tables; [`safety`] and [`supply`] monitor the hardware; [`contact`] reads the button or the obstacle switch
//! for which a step of a routine waits; [`fault`] signals a fault with the LED.

mod controller;

pub mod contact;
pub mod fault;
pub mod order;
pub mod refusal;
pub mod safety;
pub mod supervisor;
pub mod supply;

pub use controller::Controller;
