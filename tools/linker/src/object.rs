//! Shrinks the functions of an object file: reads the file, edits the code, and writes the new file.

use object::build::elf::{Builder, Relocation, Section, SectionData, SectionId, SymbolId};
use object::elf;

use crate::branch;
use crate::code::Code;
use crate::edit::{Edit, Edits};
use crate::frame::{Frame, LOWEST_REGISTERS, Routines};

mod layout;

/// The number of bytes that each kind of edit saves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Savings {
    /// The bytes saved by shared prologues and epilogues, before the linker shortens most of the new calls.
    pub frame_bytes: i64,
    /// The bytes saved by replacing a branch over a jump with the opposite branch, see [`branch`].
    pub branch_bytes: i64,
    /// The bytes saved by placing functions near their callers, so that calls are short; estimated before linking.
    pub call_bytes: i64,
}

/// Shrinks the functions of an object file and returns the new file and the savings; `None` if the file is not an ELF
/// file. The new file refers to the routines of [`ROUTINES`](crate::ROUTINES).
///
/// # Errors
/// Fails if the object cannot be read or written.
pub fn shrink(file: &[u8]) -> object::build::Result<Option<(Vec<u8>, Savings)>> {
    if !file.starts_with(&elf::ELFMAG) {
        return Ok(None);
    }
    let mut object = Object(Builder::read(file)?);
    object.add_section_name_table();
    let routines = object.add_routine_symbols();
    let mut savings = Savings::default();
    for (section, edits) in object.find_frame_edits(&routines) {
        savings.frame_bytes += edits.saved_bytes();
        object.apply_edits(section, &edits);
    }
    for section in object.find_function_sections() {
        while let Some(edits) = object.find_branch_edit(section) {
            savings.branch_bytes += edits.saved_bytes();
            object.apply_edits(section, &edits);
        }
    }
    savings.call_bytes = object.order_functions();
    let mut new_file = Vec::new();
    object.0.write(&mut new_file)?;
    Ok(Some((new_file, savings)))
}

struct Object<'a>(Builder<'a>);

impl Object<'_> {
    /// Adds a table for section names. LLVM keeps the names of sections and symbols in one table, but the writer needs
    /// two tables.
    fn add_section_name_table(&mut self) {
        let is_table = |section: &Section| matches!(section.data, SectionData::SectionString);
        if !self.0.sections.iter().any(is_table) {
            let table = self.0.sections.add();
            table.name = ".shstrtab".into();
            table.sh_type = elf::SHT_STRTAB;
            table.sh_addralign = 1;
            table.data = SectionData::SectionString;
        }
    }

    /// Adds symbols for the routines of [`LOWEST_REGISTERS`], which are in another object, and returns them in
    /// the same order.
    fn add_routine_symbols(&mut self) -> Vec<Routines> {
        let mut add_undefined = |name: String| {
            let symbol = self.0.symbols.add();
            symbol.name = name.into_bytes().into();
            symbol.set_st_info(elf::STB_GLOBAL, elf::STT_NOTYPE);
            symbol.id()
        };
        let mut add_routines = |register: &u8| Routines {
            save: add_undefined(format!("__frame_save_{register}")),
            restore: add_undefined(format!("__frame_restore_{register}")),
        };
        LOWEST_REGISTERS.iter().map(&mut add_routines).collect()
    }

    /// Returns the sections that contain exactly one function, in the order of the file. Leaves out interrupt handlers
    /// and assembly code.
    fn find_function_sections(&self) -> Vec<SectionId> {
        let is_function = |section: &&Section| {
            let mut function_count = 0;
            for symbol in &self.0.symbols {
                if symbol.section != Some(section.id()) || symbol.st_type() == elf::STT_SECTION {
                    continue;
                }
                let covers_section = symbol.st_value == 0 && symbol.st_size == section.sh_size;
                let is_interrupt = symbol.name.starts_with(b"__vector");
                if symbol.st_type() != elf::STT_FUNC || !covers_section || is_interrupt {
                    return false;
                }
                function_count += 1;
            }
            function_count == 1 && section.name.starts_with(b".text.")
        };
        let functions = self.0.sections.iter().filter(is_function);
        functions.map(Section::id).collect()
    }

    /// Returns the references in a section's bytes.
    fn read_references(&self, section: SectionId) -> Vec<Relocation> {
        let tables = self.0.sections.iter();
        let tables = tables.filter(|table| table.sh_info_section == Some(section));
        let relocations = tables.flat_map(section_relocations);
        let references = relocations.filter(|relocation| relocation.symbol.is_some());
        references.copied().collect()
    }

    fn read_bytes(&self, section: SectionId) -> Vec<u8> {
        match &self.0.sections.get(section).data {
            SectionData::Data(bytes) => bytes.to_vec(),
            _ => Vec::new(),
        }
    }

    fn decode(&self, section: SectionId) -> Option<Code> {
        Code::decode(&self.read_bytes(section), self.read_references(section))
    }

    /// Returns the offset of a reference's target; `None` if the target is in another section.
    fn target_offset(&self, section: SectionId, reference: &Relocation) -> Option<u64> {
        let symbol = self.0.symbols.get(reference.symbol?);
        let is_own = symbol.section == Some(section);
        is_own.then(|| symbol.st_value.wrapping_add_signed(reference.r_addend))
    }

    /// Returns the offsets of all reference targets in a section. References in the code that `edit` replaces do not
    /// count.
    fn find_targets(&self, section: SectionId, edit: Option<&Edit>) -> Vec<u64> {
        let mut targets = Vec::new();
        for table in &self.0.sections {
            let own_edit = edit.filter(|_| table.sh_info_section == Some(section));
            let is_replaced = |offset| own_edit.is_some_and(|edit| edit.replaces(offset));
            let relocations = section_relocations(table).iter();
            let kept = relocations.filter(|relocation| !is_replaced(relocation.r_offset));
            targets.extend(kept.filter_map(|relocation| self.target_offset(section, relocation)));
        }
        targets
    }

    /// Returns the edits of each function that becomes shorter with shared prologues and epilogues.
    fn find_frame_edits(&self, routines: &[Routines]) -> Vec<(SectionId, Edits)> {
        let build_edits = |section| {
            let frame = Frame::recognise(&self.decode(section)?)?;
            let edits = frame.build_edits(routines[frame.routine_index]);
            let edits = Edits::new(edits, &self.find_targets(section, None))?;
            (edits.saved_bytes() > 0).then_some((section, edits))
        };
        let sections = self.find_function_sections().into_iter();
        sections.filter_map(build_edits).collect()
    }

    /// Returns the edit of the next branch over a jump in a section; `None` if there is no such branch.
    fn find_branch_edit(&self, section: SectionId) -> Option<Edits> {
        let code = self.decode(section)?;
        let targets = self.find_targets(section, None);
        let find_offset = |reference: &Relocation| self.target_offset(section, reference);
        let edit = branch::find_edit(&code, &targets, find_offset)?;
        let targets = self.find_targets(section, Some(&edit));
        Edits::new(vec![edit], &targets)
    }

    /// Edits a section, and updates all references to its offsets.
    fn apply_edits(&mut self, section: SectionId, edits: &Edits) {
        let bytes = edits.apply_to_bytes(&self.read_bytes(section));
        let references = edits.apply_to_references(self.read_references(section));
        let symbols = self.0.symbols.iter();
        let own_symbols = symbols.filter(|symbol| symbol.section == Some(section));
        let symbol_values = own_symbols.map(|symbol| (symbol.id(), symbol.st_value));
        let symbol_values: Vec<(SymbolId, u64)> = symbol_values.collect();
        // If the edits move the target by a bytes and the symbol by b bytes, the addend changes by a - b. The addend of
        // a symbol in another section does not change.
        let new_addend = |reference: &Relocation| {
            let mut values = symbol_values.iter();
            let (_, value) = values.find(|(id, _)| Some(*id) == reference.symbol)?;
            let new_target = edits.new_offset(value.wrapping_add_signed(reference.r_addend));
            Some(new_target.wrapping_sub(edits.new_offset(*value)) as i64)
        };
        for table in &mut self.0.sections {
            if let SectionData::Relocation(relocations) = &mut table.data {
                if table.sh_info_section == Some(section) {
                    relocations.clone_from(&references);
                }
                for relocation in relocations {
                    if let Some(addend) = new_addend(relocation) {
                        relocation.r_addend = addend;
                    }
                }
            }
        }
        for (id, value) in &symbol_values {
            let symbol = self.0.symbols.get_mut(*id);
            symbol.st_value = edits.new_offset(*value);
            symbol.st_size = edits.new_offset(value + symbol.st_size) - symbol.st_value;
        }
        let code_section = self.0.sections.get_mut(section);
        code_section.sh_size = bytes.len() as u64;
        code_section.data = SectionData::Data(bytes.into());
    }
}

/// Returns the relocations of a section, or none if the section is not a table of relocations.
fn section_relocations<'a>(section: &'a Section) -> &'a [Relocation] {
    match &section.data {
        SectionData::Relocation(relocations) => relocations,
        _ => &[],
    }
}
