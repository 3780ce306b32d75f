//! The control: it carries out orders, computes a frame fifty times a second, and reacts
//! to faults.
//!
//! It knows no text: it takes an [`order`] and may answer with a [`refusal`]. [`supervisor`] is the table
//! of its decisions; [`safety`], [`supply`], [`contact`] and [`fault`] watch the hardware.

mod controller;

pub mod contact;
pub mod fault;
pub mod order;
pub mod refusal;
pub mod safety;
pub mod supervisor;
pub mod supply;

pub use controller::Control;
