//! Replacement of a piece of code with a shorter piece, and the new offsets of the remaining code. A reference is a
//! relocation: the linker writes the address of a symbol plus an addend at an offset.

use object::build::elf::Relocation;

/// A replacement of the bytes from `offset` on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edit {
    /// Offset from the start of the code, bytes.
    pub offset: u64,
    /// The number of bytes to replace, together with their references.
    pub removed_size: u64,
    /// The new code, in words.
    pub new_words: Vec<u16>,
    /// The references of the new code, with offsets relative to the start of the new code.
    pub references: Vec<Relocation>,
}

impl Edit {
    fn end(&self) -> u64 {
        self.offset + self.removed_size
    }

    /// Returns the number of bytes that the edit saves.
    pub fn saved_bytes(&self) -> i64 {
        self.removed_size as i64 - 2 * self.new_words.len() as i64
    }

    /// True if the byte at an offset is replaced.
    pub fn replaces(&self, offset: u64) -> bool {
        self.offset <= offset && offset < self.end()
    }

    /// True if an offset is inside the replaced bytes, but not at their start.
    fn splits_at(&self, offset: u64) -> bool {
        self.offset < offset && offset < self.end()
    }
}

/// Edits of one function in the order of their offsets; they do not overlap.
#[derive(Debug, Clone, Default)]
pub struct Edits(Vec<Edit>);

impl Edits {
    /// Sorts the edits. Returns `None` if two edits overlap, or if an edit splits the bytes at a reference target.
    pub fn new(mut edits: Vec<Edit>, targets: &[u64]) -> Option<Self> {
        edits.sort_by_key(|edit| edit.offset);
        let are_apart = edits.windows(2).all(|pair| pair[0].end() <= pair[1].offset);
        let is_kept = |target: &u64| !edits.iter().any(|edit| edit.splits_at(*target));
        let are_targets_kept = targets.iter().all(is_kept);
        (are_apart && are_targets_kept).then_some(Self(edits))
    }

    /// Returns the number of bytes that the edits save.
    pub fn saved_bytes(&self) -> i64 {
        self.0.iter().map(Edit::saved_bytes).sum()
    }

    /// Returns the new offset of the code that was at `offset` before the edits.
    pub fn new_offset(&self, offset: u64) -> u64 {
        let is_earlier = |edit: &&Edit| edit.offset < offset && edit.end() <= offset;
        let earlier_edits = self.0.iter().filter(is_earlier);
        offset.wrapping_add_signed(-earlier_edits.map(Edit::saved_bytes).sum::<i64>())
    }

    /// Returns the code after the edits.
    pub fn apply_to_bytes(&self, old_bytes: &[u8]) -> Vec<u8> {
        let mut new_bytes = Vec::with_capacity(old_bytes.len());
        let mut copied_end = 0;
        for edit in &self.0 {
            new_bytes.extend_from_slice(&old_bytes[copied_end..edit.offset as usize]);
            new_bytes.extend(edit.new_words.iter().flat_map(|word| word.to_le_bytes()));
            copied_end = edit.end() as usize;
        }
        new_bytes.extend_from_slice(&old_bytes[copied_end..]);
        new_bytes
    }

    /// Returns the references after the edits, with new offsets but old addends.
    pub fn apply_to_references(&self, mut references: Vec<Relocation>) -> Vec<Relocation> {
        let is_replaced = |offset: u64| self.0.iter().any(|edit| edit.replaces(offset));
        references.retain(|reference| !is_replaced(reference.r_offset));
        for reference in &mut references {
            reference.r_offset = self.new_offset(reference.r_offset);
        }
        for edit in &self.0 {
            let start = self.new_offset(edit.offset);
            references.extend(edit.references.iter().map(|reference| Relocation {
                r_offset: start + reference.r_offset,
                ..*reference
            }));
        }
        references.sort_by_key(|reference| reference.r_offset);
        references
    }
}
