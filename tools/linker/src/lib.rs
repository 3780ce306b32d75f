//! Makes programs smaller in ways that avr-gcc has and LLVM has not, by editing the
//! object files before they are linked.
//!
//! Flash is the scarcest resource of this firmware, and a sixth of it was the same few
//! instructions again and again: registers pushed at the beginning of a function and
//! popped at its end, and the eight instructions that move the stack pointer. avr-gcc's
//! `-mcall-prologues` calls routines for that, so the program has one copy of them. LLVM
//! has no such option. But its object files can be edited safely: every function has a
//! section of its own, and because the linker may shorten calls (`--relax`), each jump
//! and address is a relocation, so no distance in them is final. This program reads the
//! object, replaces beginnings and ends by calls of the routines of `frames.S`
//! ([`frame`]), replaces jumps over jumps by the opposite branch ([`branch`]), puts functions
//! near their callers ([`order`]), and hands the result to avr-gcc. A function that differs in any way from the shapes known
//! to be safe stays as it is.

pub mod branch;
mod code;
mod edit;
pub mod frame;
mod instruction;
mod object;
pub mod order;

pub use object::{Savings, ShrinkError, shrink};

/// The assembly of the shared beginnings and ends. To be linked before the object, so that
/// they lie in the middle of its functions.
pub const ROUTINES: &str = include_str!("frames.S");
