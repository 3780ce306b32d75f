//! Editor of object files that makes programs smaller before linking, with optimisations that avr-gcc has and LLVM does
//! not have.
//!
//! Flash is the scarcest resource of this firmware. A sixth of the program was copies of the same few instructions:
//! registers pushed at the start of a function and popped at its end, and the eight instructions that move the stack
//! pointer. With `-mcall-prologues`, avr-gcc calls shared routines instead, so the program contains these instructions
//! once. LLVM has no such option, but its object files can be edited safely. Every function has its own section. Each
//! jump and each address is a relocation, because the linker may shorten calls (`--relax`), so no distance in the
//! object is final.
//!
//! This program reads the object, replaces prologues and epilogues with calls of the routines in `frames.S`
//! ([`frame`]), replaces branches over jumps with the opposite branch ([`branch`]), places functions near their callers
//! ([`order`]), and passes the result to avr-gcc. A function that differs in any way from the known safe forms stays
//! unchanged.
//!
//! Do not use this program with `-enable-ipra`, for a chip whose return addresses have three bytes, or on objects of a
//! compiler other than rustc and avr-gcc, which the tests cover.

pub mod branch;
mod code;
mod edit;
pub mod frame;
mod instruction;
mod object;
pub mod order;

pub use object::{Savings, shrink};

/// The assembly code of the shared prologues and epilogues. It must be linked before the object, so that the linker
/// places the routines in the middle of the object's functions.
pub const ROUTINES: &str = include_str!("frames.S");
