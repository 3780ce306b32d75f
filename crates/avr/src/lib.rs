//! Access to AVR features that plain Rust does not offer.
//!
//! The firmware's core is plain Rust without `unsafe`, so that it can run and be tested on any machine. Two features of
//! an AVR are out of reach for such code: its second address space, which keeps tables out of the scarce RAM, and its
//! multiplier, which the compiler leaves idle when it calls a 32-bit library routine for a product of two 16-bit
//! factors. This crate offers both behind safe functions, which are plain Rust everywhere else.
//!
//! Do not use this crate on an AVR with more than 64 KiB of flash: addresses have 16 bits here. For tables that
//! are always indexed within their bounds, `avr-progmem` also keeps them in flash; it has a richer interface, and
//! needs a nightly compiler on other machines, too.

#![no_std]
#![allow(unsafe_code)] // Access to flash and the multiplier needs it; see flash.rs, multiply.rs.
#![cfg_attr(target_arch = "avr", feature(asm_experimental_arch))]

mod flash;
mod multiply;
mod region;

pub use flash::{Flash, Plain};
pub use multiply::{mul, mul_unsigned};
pub use region::{Region, SPACE_BYTES, START_ADDRESS};
