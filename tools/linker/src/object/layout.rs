//! Layout of an object: decides which functions may move, and moves their sections.

use object::build::elf::{Section, SectionId};
use object::elf;

use super::Object;
use crate::edit::Reference;
use crate::instruction::{falls_through, may_skip_next};
use crate::order::{Call, Pieces};

/// The approximate size of the routines of `frames.S`, bytes, for estimates of distances.
const ROUTINES_SIZE: u32 = 320;

impl Object<'_> {
    /// Puts the functions into an order in which calls are short, with the routines of
    /// `frames.S` in their middle: sections before the routines are named `.lowtext`, as in the
    /// linker's script, and the others follow the routines if these are linked first. Does
    /// nothing if one section could fall through into the next, or branches to another.
    /// Returns the number of bytes saved.
    pub(super) fn order(&mut self) -> i64 {
        let functions = self.functions();
        let may_move = |section: &Section| {
            let Some(code) = self.code(section.id()) else {
                return false;
            };
            let stops_at_end = match code.instructions.as_slice() {
                [.., skip, last] => !may_skip_next(skip.code) && !falls_through(last.code),
                [last] => !falls_through(last.code),
                [] => true,
            };
            // A branch to another section would have a limited reach.
            let is_near = |reference: &Reference| {
                let short_reach_kinds = [elf::R_AVR_7_PCREL, elf::R_AVR_13_PCREL];
                !short_reach_kinds.contains(&reference.kind)
                    || self.0.symbols.get(reference.symbol).section == Some(section.id())
            };
            stops_at_end && code.references.iter().all(is_near)
        };
        let is_code =
            |section: &&Section| *section.name == *b".text" || section.name.starts_with(b".text.");
        let code_sections = || self.0.sections.iter().filter(is_code);
        if !code_sections().all(may_move) {
            return 0;
        }
        // The pieces are each function, then the routines together with the sections that stay after
        // them, then all other files.
        let [middle_piece, other_files_piece] = [functions.len(), functions.len() + 1];
        let piece_of =
            |section: SectionId| functions.iter().position(|function| *function == section);
        let mut pieces = Pieces::default();
        let is_long = |reference: &&Reference| reference.kind == elf::R_AVR_CALL;
        for section in &functions {
            // The size is estimated as if all calls in the function were short.
            let saved_bytes = 2 * self.references(*section).iter().filter(is_long).count() as u64;
            let size = self.0.sections.get(*section).sh_size - saved_bytes;
            pieces.sizes.push(size as u32);
        }
        let staying = code_sections().filter(|section| piece_of(section.id()).is_none());
        let staying: u64 = staying.map(|section| section.sh_size).sum();
        pieces.sizes.extend([ROUTINES_SIZE + staying as u32, 0]);
        for section in code_sections() {
            for reference in self.references(section.id()) {
                let symbol = self.0.symbols.get(reference.symbol);
                let from = piece_of(section.id()).unwrap_or(middle_piece);
                let to = match symbol.section {
                    Some(section) => piece_of(section).unwrap_or(middle_piece),
                    None if symbol.name.starts_with(b"__frame_") => middle_piece,
                    None => other_files_piece,
                };
                if is_long(&&reference) && from != to {
                    let offset = if from == middle_piece {
                        0
                    } else {
                        reference.offset as u32
                    };
                    pieces.calls.push(Call { from, offset, to });
                }
            }
        }
        let order = pieces.find_order();
        let compiled_order: Vec<usize> = (0..=other_files_piece).collect();
        let saved_total = 2
            * (pieces.far_call_count(&compiled_order) as i64
                - pieces.far_call_count(&order) as i64);
        if saved_total <= 0 {
            return 0;
        }
        let mut is_low = true;
        for piece in order {
            match functions.get(piece) {
                Some(section) => self.move_to_the_end(*section, is_low),
                None => is_low = false,
            }
        }
        saved_total
    }

    /// Moves a section of code and its table of relocations to the end of the file. Both must move,
    /// because the linker places a section where it reads the first of the two.
    fn move_to_the_end(&mut self, section: SectionId, is_low: bool) {
        let new_section = self.0.sections.copy(section);
        if let (true, Some(name)) = (is_low, new_section.name.strip_prefix(b".text")) {
            new_section.name = [b".lowtext", name].concat().into();
        }
        let new_section = new_section.id();
        self.0.sections.get_mut(section).delete = true;
        for symbol in &mut self.0.symbols {
            if symbol.section == Some(section) {
                symbol.section = Some(new_section);
            }
        }
        let tables = self.0.sections.iter();
        let tables = tables.filter(|table| table.sh_info_section == Some(section));
        let tables: Vec<SectionId> = tables.map(Section::id).collect();
        for table in tables {
            self.0.sections.copy(table).sh_info_section = Some(new_section);
            self.0.sections.get_mut(table).delete = true;
        }
    }
}
