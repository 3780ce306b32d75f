//! What the tests share: a bench with the running firmware on it, and little
//! AVR programs to test the bench itself.

pub mod avr_gcc;
mod bench;

pub use bench::{FirmwareBench, robot};
pub use lizard_host::sim::console::Line;
pub use lizard_host::sim::frame::{FRAME, Frame};
