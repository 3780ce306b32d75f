//! The code of one function: its instructions, and what they refer to.

use crate::edit::Reference;
use crate::instruction::{is_long, is_relative};

/// An instruction and where it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct At {
    /// Bytes from the beginning.
    pub offset: u64,
    /// Its first word.
    pub code: u16,
}

/// A function's code.
#[derive(Debug, Clone)]
pub struct Code {
    /// One after the other, as they lie there.
    pub instructions: Vec<At>,
    /// In the order of their offsets.
    pub references: Vec<Reference>,
    /// Bytes.
    pub size: u64,
}

impl Code {
    /// Reads the code; none if a jump in it does not say where it goes, so that nothing
    /// may be moved.
    pub fn read(bytes: &[u8], references: Vec<Reference>) -> Option<Self> {
        let word = |at: usize| Some(u16::from_le_bytes([*bytes.get(at)?, *bytes.get(at + 1)?]));
        let mut instructions = Vec::new();
        let mut at = 0;
        while at < bytes.len() {
            let code = word(at)?;
            instructions.push(At {
                offset: at as u64,
                code,
            });
            at += if is_long(code) { 4 } else { 2 };
        }
        let code = Self {
            instructions,
            references,
            size: bytes.len() as u64,
        };
        let known = |at: &At| !is_relative(at.code) || code.reference(at.offset).is_some();
        let whole = at == bytes.len() && code.instructions.iter().all(known);
        whole.then_some(code)
    }

    /// What the instruction at an offset refers to.
    pub fn reference(&self, offset: u64) -> Option<&Reference> {
        self.references
            .iter()
            .find(|reference| reference.offset == offset)
    }

    /// The first words from the instruction of an index on.
    pub fn words(&self, index: usize) -> impl Iterator<Item = u16> {
        self.instructions[index..].iter().map(|at| at.code)
    }

    /// Where the instruction of an index begins, or the code ends.
    pub fn offset(&self, index: usize) -> u64 {
        self.instructions
            .get(index)
            .map_or(self.size, |at| at.offset)
    }
}
