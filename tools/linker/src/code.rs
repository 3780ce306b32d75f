//! Code of one function: its instructions and their references.

use crate::edit::Reference;
use crate::instruction::{is_relative, is_two_words};

/// The first word of an instruction, and its offset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlacedInstruction {
    /// Bytes from the beginning of the code.
    pub offset: u64,
    /// The first word of the instruction.
    pub code: u16,
}

/// A function's code.
#[derive(Debug, Clone)]
pub struct Code {
    /// The instructions in the order of their offsets.
    pub instructions: Vec<PlacedInstruction>,
    /// The references in the order of their offsets.
    pub references: Vec<Reference>,
    /// The size in bytes.
    pub size: u64,
}

impl Code {
    /// Decodes the code; `None` if a jump in it has no relocation, because then its target is
    /// unknown and nothing may be moved.
    pub fn read(bytes: &[u8], references: Vec<Reference>) -> Option<Self> {
        let word = |at: usize| Some(u16::from_le_bytes([*bytes.get(at)?, *bytes.get(at + 1)?]));
        let mut instructions = Vec::new();
        let mut at = 0;
        while at < bytes.len() {
            let code = word(at)?;
            instructions.push(PlacedInstruction {
                offset: at as u64,
                code,
            });
            at += if is_two_words(code) { 4 } else { 2 };
        }
        let code = Self {
            instructions,
            references,
            size: bytes.len() as u64,
        };
        let known =
            |at: &PlacedInstruction| !is_relative(at.code) || code.reference(at.offset).is_some();
        let is_valid = at == bytes.len() && code.instructions.iter().all(known);
        is_valid.then_some(code)
    }

    /// Returns the reference of the instruction at an offset in bytes; `None` if the instruction has no reference.
    pub fn reference(&self, offset: u64) -> Option<&Reference> {
        self.references
            .iter()
            .find(|reference| reference.offset == offset)
    }

    /// Returns the first word of each instruction from the instruction with this index on.
    pub fn words(&self, index: usize) -> impl Iterator<Item = u16> {
        self.instructions[index..].iter().map(|at| at.code)
    }

    /// Returns the offset in bytes of the instruction with this index, or the size of the code if the index is
    /// beyond the last instruction.
    pub fn offset(&self, index: usize) -> u64 {
        self.instructions
            .get(index)
            .map_or(self.size, |at| at.offset)
    }
}
