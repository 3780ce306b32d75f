//! The control: it carries out orders, computes a frame fifty times a second, and reacts
//! to faults.
//!
//! It handles no text: it takes an [`order`] and may answer with a [`refusal`]. [`supervisor`] has the tables
//! of its decisions; [`safety`], [`supply`] and [`contact`] watch the hardware; [`fault`] shows a fault on the LED.

mod controller;

pub mod contact;
pub mod fault;
pub mod order;
pub mod refusal;
pub mod safety;
pub mod supervisor;
pub mod supply;

pub use controller::Controller;
