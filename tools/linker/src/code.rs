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
    /// Decodes the code; `None` if it ends inside an instruction, or if a jump in it has no reference, because then
    /// its target is unknown and nothing may be moved.
    pub fn read(bytes: &[u8], references: Vec<Reference>) -> Option<Self> {
        let word = |index: usize| {
            Some(u16::from_le_bytes([
                *bytes.get(index)?,
                *bytes.get(index + 1)?,
            ]))
        };
        let mut instructions = Vec::new();
        let mut index = 0;
        while index < bytes.len() {
            let code = word(index)?;
            instructions.push(PlacedInstruction {
                offset: index as u64,
                code,
            });
            index += if is_two_words(code) { 4 } else { 2 };
        }
        let code = Self {
            instructions,
            references,
            size: bytes.len() as u64,
        };
        let has_known_target = |instruction: &PlacedInstruction| {
            !is_relative(instruction.code) || code.reference(instruction.offset).is_some()
        };
        let is_valid = index == bytes.len() && code.instructions.iter().all(has_known_target);
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
        self.instructions[index..]
            .iter()
            .map(|instruction| instruction.code)
    }

    /// Returns the offset in bytes of the instruction with this index, or the size of the code if the index is
    /// beyond the last instruction.
    pub fn offset(&self, index: usize) -> u64 {
        self.instructions
            .get(index)
            .map_or(self.size, |instruction| instruction.offset)
    }
}
