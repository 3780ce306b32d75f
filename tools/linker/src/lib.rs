//! Editor of object files that makes programs smaller before they are linked, by optimizations that
//! avr-gcc has and LLVM does not have.
//!
//! Flash is the scarcest resource of this firmware. A sixth of the program was copies of the same few
//! instructions: registers pushed at the start of a function and popped at its end, and the eight
//! instructions that move the stack pointer. With `-mcall-prologues`, avr-gcc calls shared routines
//! instead, so the program has these instructions once. LLVM has no such option. But its object files
//! can be edited safely: every function has its own section. Each jump and each address is a
//! relocation, because the linker may shorten calls (`--relax`), so no distance in the object is
//! final. This program reads the object, replaces prologues and epilogues by calls of the routines of `frames.S`
//! ([`frame`]), replaces branches over jumps by the opposite branch ([`branch`]), puts functions
//! near their callers ([`order`]), and passes the result to avr-gcc. A function that differs in any
//! way from the forms known to be safe stays unchanged.
//!
//! Do not use this program with `-enable-ipra`, for a chip whose return addresses have three bytes, or on
//! objects of a compiler that its tests do not cover; they cover rustc and avr-gcc.

pub mod branch;
mod code;
mod edit;
pub mod frame;
mod instruction;
mod object;
pub mod order;

pub use object::{Savings, ShrinkError, shrink};

/// The assembly of the shared prologues and epilogues. It must be linked before the object, so that the
/// routines are placed in the middle of the object's functions.
pub const ROUTINES: &str = include_str!("frames.S");
