//! What the tests share: a bench with the running firmware on it, and little
//! AVR programs to test the bench itself.

pub mod avr_gcc;
mod bench;

pub use bench::{FirmwareBench, bench_of, robot};
pub use lizard_host::sim::frame::{FRAME, Frame};
pub use lizard_host::sim::lines::Line;
