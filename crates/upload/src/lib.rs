//! Writes firmware and robot to a UNO or a Nano through the board's own boot loader.
//!
//! The boot loader uses the same USB cable as the console, but it listens only for a second after a reset, it has
//! no checksums, and a cable pulled during an upload leaves flash partly written. Therefore [`upload`] reads the flash
//! first, writes only pages that differ, reads them back, and writes the page at which the program starts last.
//!
//! The crate does not access ports or clocks itself: a [`Board`] is a serial connection with time limits, which this
//! machine or a browser provides. The functions are `async`, since a browser must not block; where reads may block, any
//! executor is suitable.
//!
//! # When not to use it
//! The crate writes only the flash of an ATmega328P whose boot loader uses STK500, version 1. Use avrdude for other
//! chips, for programmers wired to the chip's pins, and for fuses and the EEPROM.
#![deny(unsafe_code)]
#![warn(clippy::missing_errors_doc)]

mod board;
mod chip;
mod contents;
mod image;
mod loader;
mod target;
mod upload;

pub use board::{Board, BoardError};
pub use chip::Chip;
pub use contents::{FlashContents, Program, RobotInFlash, find_robot, format_robot_label};
pub use image::{BLANK, BOOT_ADDRESS, Image, ImageError, NANO_BOOT_ADDRESS, PAGE_BYTES, Page};
pub use loader::{Loader, LoaderError, LoaderKind};
pub use target::{ImageTooLong, Model, Target};
pub use upload::{Event, FlashState, PageCounts, Step, UploadError, identify, upload};
