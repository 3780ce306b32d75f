//! Replacement of a piece of code by a shorter one, and the new offsets of the remaining code.

use object::build::elf::SymbolId;
use object::elf::RelocationType;

/// The content of a relocation: the address `symbol + addend`, to be filled in at an offset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reference {
    /// Bytes from the beginning of the code.
    pub offset: u64,
    /// The form in which the linker fills the address in.
    pub kind: RelocationType,
    /// The symbol from which the address is counted.
    pub symbol: SymbolId,
    /// Bytes after the symbol.
    pub addend: i64,
}

/// A replacement of the bytes from `at` on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edit {
    /// Bytes from the beginning of the code.
    pub offset: u64,
    /// The number of bytes that are replaced, together with their references.
    pub remove: u64,
    /// The new code, in words.
    pub insert: Vec<u16>,
    /// The references of the new code; their offsets count from the beginning of the new code.
    pub references: Vec<Reference>,
}

impl Edit {
    fn end(&self) -> u64 {
        self.offset + self.remove
    }

    fn length(&self) -> u64 {
        self.insert.len() as u64 * 2
    }

    /// Returns the number of bytes that the edit saves.
    pub fn gain(&self) -> i64 {
        self.remove as i64 - self.length() as i64
    }

    /// True if an offset is inside the replaced bytes: after their first byte and before their end.
    pub fn covers(&self, offset: u64) -> bool {
        self.offset < offset && offset < self.end()
    }
}

/// Edits of one function in the order of their offsets; they do not overlap.
#[derive(Debug, Clone, Default)]
pub struct Edits(Vec<Edit>);

impl Edits {
    /// Orders the edits; `None` if two overlap or one covers an offset that something refers to.
    pub fn new(mut edits: Vec<Edit>, targets: &[u64]) -> Option<Self> {
        edits.sort_by_key(|edit| edit.offset);
        let apart = edits.windows(2).all(|pair| pair[0].end() <= pair[1].offset);
        let keep_targets = !targets
            .iter()
            .any(|target| edits.iter().any(|edit| edit.covers(*target)));
        (apart && keep_targets).then_some(Self(edits))
    }

    /// Returns the number of bytes that the edits save.
    pub fn gain(&self) -> i64 {
        self.0.iter().map(Edit::gain).sum()
    }

    /// Returns the new offset of the code that was at `offset`.
    pub fn new_offset(&self, offset: u64) -> u64 {
        let before = self
            .0
            .iter()
            .filter(|edit| edit.offset < offset && edit.end() <= offset);
        offset.wrapping_add_signed(-before.map(Edit::gain).sum::<i64>())
    }

    /// Returns the edited code.
    pub fn bytes(&self, old: &[u8]) -> Vec<u8> {
        let mut new = Vec::with_capacity(old.len());
        let mut done = 0;
        for edit in &self.0 {
            new.extend_from_slice(&old[done..edit.offset as usize]);
            new.extend(edit.insert.iter().flat_map(|word| word.to_le_bytes()));
            done = edit.end() as usize;
        }
        new.extend_from_slice(&old[done..]);
        new
    }

    /// Returns the references of the edited code, with new offsets but old addends.
    pub fn references(&self, old: &[Reference]) -> Vec<Reference> {
        let inside = |offset: u64| {
            let holds = |edit: &Edit| edit.offset <= offset && offset < edit.end();
            self.0.iter().any(holds)
        };
        let kept = old.iter().filter(|reference| !inside(reference.offset));
        let kept = kept.map(|reference| Reference {
            offset: self.new_offset(reference.offset),
            ..*reference
        });
        let new = self.0.iter().flat_map(|edit| {
            let start = self.new_offset(edit.offset);
            let at_its_place = move |reference: &Reference| Reference {
                offset: start + reference.offset,
                ..*reference
            };
            edit.references.iter().map(at_its_place)
        });
        let mut all: Vec<Reference> = kept.chain(new).collect();
        all.sort_by_key(|reference| reference.offset);
        all
    }
}
