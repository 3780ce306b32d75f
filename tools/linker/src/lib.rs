//! Makes programs smaller in ways that avr-gcc has and LLVM does not have, by editing the
//! object files before they are linked.
//!
//! Flash is the scarcest resource of this firmware, and a sixth of it was copies of the same few
//! instructions: registers pushed at the beginning of a function and
//! popped at its end, and the eight instructions that move the stack pointer. avr-gcc's
//! `-mcall-prologues` calls routines for that, so the program has one copy of them. LLVM
//! has no such option. But its object files can be edited safely: every function has a
//! section of its own, and because the linker may shorten calls (`--relax`), each jump
//! and address is a relocation, so no distance in them is final. This program reads the
//! object, replaces prologues and epilogues by calls of the routines of `frames.S`
//! ([`frame`]), replaces branches over jumps by the opposite branch ([`branch`]), puts functions
//! near their callers ([`order`]), and passes the result to avr-gcc. A function that differs in any
//! way from the forms known to be safe stays unchanged.
//!
//! Do not use it with `-enable-ipra`, for a chip whose return addresses have three bytes, or on objects
//! of a compiler that its tests do not cover; they cover rustc and avr-gcc.

pub mod branch;
mod code;
mod edit;
pub mod frame;
mod instruction;
mod object;
pub mod order;

pub use object::{Savings, ShrinkError, shrink};

/// The assembly of the shared prologues and epilogues. It must be linked before the object, so that
/// they are in the middle of its functions.
pub const ROUTINES: &str = include_str!("frames.S");
