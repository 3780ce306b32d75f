//! The control: it carries out orders, computes a frame fifty times a second, and reacts
//! to faults.
//!
//! This layer handles no text: it accepts an [`order`] or answers with a [`refusal`]. [`supervisor`] has the tables
//! of its decisions; [`safety`], [`supply`] and [`contact`] monitor the hardware; [`fault`] shows a fault on the LED.

mod controller;

pub mod contact;
pub mod fault;
pub mod order;
pub mod refusal;
pub mod safety;
pub mod supervisor;
pub mod supply;

pub use controller::Controller;
