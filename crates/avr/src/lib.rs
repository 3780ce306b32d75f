//! Access to AVR features that plain Rust does not offer.
//!
//! The firmware's core is plain Rust without `unsafe`, so that it can run and be tested on any machine. Such code
//! cannot use two features of an AVR: its second address space, which keeps tables out of the scarce RAM, and its
//! multiplier. (For the product of two 16-bit factors, the compiler calls a 32-bit library routine.) This crate offers
//! both features as safe functions, which are plain Rust on any other machine.
//!
//! Do not use this crate on an AVR with more than 64 KiB of flash: its addresses are 16 bits long. `avr-progmem` also
//! keeps tables in flash and has a richer interface; it panics if an index is out of bounds, and needs a nightly
//! compiler on other machines, too.

#![no_std]
#![allow(unsafe_code)] // Reading flash (flash.rs, region.rs) and multiplying (multiply.rs) need it.
#![cfg_attr(target_arch = "avr", feature(asm_experimental_arch))]

mod flash;
mod multiply;
mod region;

pub use flash::{Flash, Pod};
pub use multiply::{mul, mul_unsigned};
pub use region::{REGION_BYTES, Region, START_ADDRESS};
