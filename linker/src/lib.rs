//! What avr-gcc does to a program's size and LLVM does not, done to the object files on
//! their way to the linker.
//!
//! Flash is what this firmware has least of, and a sixth of it was the same few
//! instructions again and again: registers pushed at the beginning of a function and
//! popped at its end, and the eight instructions that move the stack pointer.
//! avr-gcc's `-mcall-prologues` calls routines for that, of which the program has one
//! copy. LLVM has no such option. But its object files can be edited safely: every
//! function has a section of its own, and since the linker may shorten calls
//! (`--relax`), no distance in them is final, each jump and address is a relocation. So
//! this program reads the object, replaces beginnings and ends with calls of the routines
//! of `frames.S` ([`frame`]), and jumps over jumps with the opposite branch
//! ([`branch`]), leaves out comparisons whose answer is known ([`compare`]), makes a
//! branch of a truth value that is made and asked for at once ([`truth`]), writes of
//! variables that are nearly zero only what is not ([`sparse`]), puts functions near those
//! that call them ([`order`]), and hands the result to avr-gcc. A function that differs in
//! anything from what is known to be safe stays as it is.

pub mod branch;
mod code;
pub mod compare;
mod edit;
mod flow;
pub mod frame;
mod instruction;
mod object;
pub mod order;
pub mod sparse;
pub mod truth;

pub use object::{Savings, ShrinkError, shrink};

/// The assembly of the shared beginnings and ends. To be linked before the object, so that
/// they lie in the middle of its functions.
pub const ROUTINES: &str = include_str!("frames.S");
