//! A piece of code that is replaced by a shorter one, and where everything is then.

use object::build::elf::SymbolId;
use object::elf::RelocationType;

/// What a relocation is about: `symbol + addend`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reference {
    /// Bytes from the beginning of the code.
    pub offset: u64,
    /// What the linker fills in there.
    pub kind: RelocationType,
    /// The symbol.
    pub symbol: SymbolId,
    /// And how many bytes behind it.
    pub addend: i64,
}

/// The bytes from `at` on that are replaced.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edit {
    /// Bytes from the beginning of the code.
    pub at: u64,
    /// How many are replaced, with all that refers to something from there.
    pub remove: u64,
    /// By what.
    pub insert: Vec<u16>,
    /// What that refers to; offsets from its own beginning.
    pub references: Vec<Reference>,
}

impl Edit {
    fn end(&self) -> u64 {
        self.at + self.remove
    }

    fn length(&self) -> u64 {
        self.insert.len() as u64 * 2
    }

    /// Bytes that the code gets shorter by it.
    pub fn gain(&self) -> i64 {
        self.remove as i64 - self.length() as i64
    }

    /// Whether an offset is inside: neither its beginning nor behind it.
    pub fn covers(&self, offset: u64) -> bool {
        self.at < offset && offset < self.end()
    }
}

/// Edits of one piece of code in the order of their places, none in another.
#[derive(Debug, Clone, Default)]
pub struct Edits(Vec<Edit>);

impl Edits {
    /// Takes those that leave everything that is jumped to in place.
    pub fn new(mut edits: Vec<Edit>, targets: &[u64]) -> Option<Self> {
        edits.sort_by_key(|edit| edit.at);
        let apart = edits.windows(2).all(|pair| pair[0].end() <= pair[1].at);
        let whole = !targets
            .iter()
            .any(|target| edits.iter().any(|edit| edit.covers(*target)));
        (apart && whole).then_some(Self(edits))
    }

    /// Bytes that the code gets shorter.
    pub fn gain(&self) -> i64 {
        self.0.iter().map(Edit::gain).sum()
    }

    /// Where an offset is afterwards.
    pub fn moved(&self, offset: u64) -> u64 {
        let before = self
            .0
            .iter()
            .filter(|edit| edit.at < offset && edit.end() <= offset);
        offset.wrapping_add_signed(-before.map(Edit::gain).sum::<i64>())
    }

    /// The code afterwards.
    pub fn bytes(&self, old: &[u8]) -> Vec<u8> {
        let mut new = Vec::with_capacity(old.len());
        let mut done = 0;
        for edit in &self.0 {
            new.extend_from_slice(&old[done..edit.at as usize]);
            new.extend(edit.insert.iter().flat_map(|word| word.to_le_bytes()));
            done = edit.end() as usize;
        }
        new.extend_from_slice(&old[done..]);
        new
    }

    /// What the code refers to afterwards; where in it, not yet what.
    pub fn references(&self, old: &[Reference]) -> Vec<Reference> {
        let inside = |offset: u64| {
            let holds = |edit: &Edit| edit.at <= offset && offset < edit.end();
            self.0.iter().any(holds)
        };
        let kept = old.iter().filter(|reference| !inside(reference.offset));
        let kept = kept.map(|reference| Reference {
            offset: self.moved(reference.offset),
            ..*reference
        });
        let new = self.0.iter().flat_map(|edit| {
            let begin = self.moved(edit.at);
            let at_its_place = move |reference: &Reference| Reference {
                offset: begin + reference.offset,
                ..*reference
            };
            edit.references.iter().map(at_its_place)
        });
        let mut all: Vec<Reference> = kept.chain(new).collect();
        all.sort_by_key(|reference| reference.offset);
        all
    }
}
