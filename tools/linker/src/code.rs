//! The code of one function: its instructions and their references.

use object::build::elf::Relocation;

use crate::instruction::{is_relative, is_two_words};

/// An instruction with its offset in the code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlacedInstruction {
    /// Offset from the start of the code, bytes.
    pub offset: u64,
    /// The first word of the instruction.
    pub first_word: u16,
}

/// A function's code.
#[derive(Debug, Clone)]
pub struct Code {
    /// The instructions in the order of their offsets.
    pub instructions: Vec<PlacedInstruction>,
    /// The references in the order of their offsets.
    pub references: Vec<Relocation>,
    /// The size in bytes.
    pub size: u64,
}

impl Code {
    /// Decodes a function's code. Returns `None` if the code ends inside an instruction, or if a jump has no reference:
    /// the jump's target is then unknown, so nothing may be moved.
    pub fn decode(bytes: &[u8], references: Vec<Relocation>) -> Option<Self> {
        let mut instructions = Vec::new();
        let mut offset = 0;
        while offset < bytes.len() {
            let first_word = u16::from_le_bytes(*bytes[offset..].first_chunk()?);
            instructions.push(PlacedInstruction {
                offset: offset as u64,
                first_word,
            });
            offset += if is_two_words(first_word) { 4 } else { 2 };
        }
        let code = Self {
            instructions,
            references,
            size: bytes.len() as u64,
        };
        let has_known_target = |instruction: &PlacedInstruction| {
            !is_relative(instruction.first_word) || code.reference_at(instruction.offset).is_some()
        };
        let is_valid = offset == bytes.len() && code.instructions.iter().all(has_known_target);
        is_valid.then_some(code)
    }

    /// Returns the reference of the instruction at an offset in bytes; `None` if the instruction has no reference.
    pub fn reference_at(&self, offset: u64) -> Option<&Relocation> {
        let mut references = self.references.iter();
        references.find(|reference| reference.r_offset == offset)
    }

    /// Returns the first words of the instructions, from the instruction with this index to the last.
    pub fn words_from(&self, index: usize) -> impl Iterator<Item = u16> {
        let instructions = self.instructions[index..].iter();
        instructions.map(|instruction| instruction.first_word)
    }

    /// Returns the offset of the instruction with this index in bytes, or the size of the code if the index is beyond
    /// the last instruction.
    pub fn instruction_offset(&self, index: usize) -> u64 {
        let instruction = self.instructions.get(index);
        instruction.map_or(self.size, |instruction| instruction.offset)
    }
}
