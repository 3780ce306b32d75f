//! Layout of an object, in which functions are ordered so that calls are short.

use object::build::elf::{Relocation, Section, SectionId};
use object::elf;

use super::Object;
use crate::instruction::{falls_through, may_skip_next};
use crate::order::{Call, Pieces};

/// The approximate size of the routines of `frames.S`, bytes, for estimates of distances.
const ROUTINES_SIZE: u32 = 320;

impl Object<'_> {
    /// Orders the functions so that calls are short, with the routines of `frames.S` in the middle. Sections before the
    /// routines are named `.lowtext`, as in the linker script; the other sections follow the routines if the routines
    /// are linked first. Does nothing if a section could fall through into the next section, or branches to another
    /// section. Returns the number of bytes saved.
    pub(super) fn order_functions(&mut self) -> i64 {
        let functions = self.find_function_sections();
        let may_move = |section: &Section| {
            let Some(code) = self.decode(section.id()) else {
                return false;
            };
            let stops_at_end = match code.instructions.as_slice() {
                [.., previous, last] => {
                    !may_skip_next(previous.first_word) && !falls_through(last.first_word)
                }
                [last] => !falls_through(last.first_word),
                [] => true,
            };
            // A relative branch to another section might no longer reach it.
            let survives_move = |reference: &Relocation| {
                let short_reach_kinds = [elf::R_AVR_7_PCREL, elf::R_AVR_13_PCREL];
                !short_reach_kinds.contains(&reference.r_type)
                    || self.target_offset(section.id(), reference).is_some()
            };
            stops_at_end && code.references.iter().all(survives_move)
        };
        let is_code =
            |section: &&Section| *section.name == *b".text" || section.name.starts_with(b".text.");
        let code_sections = || self.0.sections.iter().filter(is_code);
        if !code_sections().all(may_move) {
            return 0;
        }
        // The pieces are all functions, then the routines with the sections that stay after them, then all other files.
        let [middle_piece, other_files_piece] = [functions.len(), functions.len() + 1];
        let piece_index =
            |section: SectionId| functions.iter().position(|function| *function == section);
        let mut pieces = Pieces::default();
        let is_call = |reference: &&Relocation| reference.r_type == elf::R_AVR_CALL;
        for section in &functions {
            // The size is estimated as if all calls in the function were short.
            let references = self.read_references(*section);
            let call_count = references.iter().filter(is_call).count() as u64;
            let size = self.0.sections.get(*section).sh_size - 2 * call_count;
            pieces.sizes.push(size as u32);
        }
        let staying_sections =
            code_sections().filter(|section| piece_index(section.id()).is_none());
        let staying_bytes: u64 = staying_sections.map(|section| section.sh_size).sum();
        pieces
            .sizes
            .extend([ROUTINES_SIZE + staying_bytes as u32, 0]);
        for section in code_sections() {
            let caller = piece_index(section.id()).unwrap_or(middle_piece);
            for reference in self.read_references(section.id()).iter().filter(is_call) {
                let Some(symbol) = reference.symbol else {
                    continue;
                };
                let symbol = self.0.symbols.get(symbol);
                let callee = match symbol.section {
                    Some(section) => piece_index(section).unwrap_or(middle_piece),
                    None if symbol.name.starts_with(b"__frame_") => middle_piece,
                    None => other_files_piece,
                };
                if caller != callee {
                    let offset = match caller == middle_piece {
                        true => 0,
                        false => reference.r_offset as u32,
                    };
                    pieces.calls.push(Call {
                        caller,
                        offset,
                        callee,
                    });
                }
            }
        }
        let order = pieces.find_order();
        let compiled_order: Vec<usize> = (0..=other_files_piece).collect();
        let saved_bytes = 2
            * (pieces.count_out_of_reach(&compiled_order) as i64
                - pieces.count_out_of_reach(&order) as i64);
        if saved_bytes <= 0 {
            return 0;
        }
        let mut is_before_routines = true;
        for piece in order {
            match functions.get(piece) {
                Some(section) => self.move_to_end(*section, is_before_routines),
                None => is_before_routines = false,
            }
        }
        saved_bytes
    }

    /// Moves a section of code and its table of relocations to the end of the file. Both must move, because the linker
    /// uses the position of whichever comes first.
    fn move_to_end(&mut self, section: SectionId, is_before_routines: bool) {
        let new_section = self.0.sections.copy(section);
        if let (true, Some(name)) = (is_before_routines, new_section.name.strip_prefix(b".text")) {
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
