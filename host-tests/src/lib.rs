//! What the tests share: a bench with the running firmware on it, and little
//! AVR programs to test the bench itself.

pub mod avr_gcc;
mod bench;

pub use bench::{FRAME, FirmwareBench, Frame, SERVO_PINS};
