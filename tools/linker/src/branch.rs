//! Replacement of a branch over a jump with the opposite branch.
//!
//! ```text
//! breq 1f          brne 2f
//! rjmp 2f
//! 1:               1:
//! ```

use object::build::elf::Relocation;
use object::elf;

use crate::code::Code;
use crate::edit::Edit;
use crate::instruction::{is_branch, is_rjmp, may_skip_next};

/// Distance that every branch reaches, bytes. Later edits never increase a distance.
const REACH_BYTES: u64 = 2 * 60;

/// Returns the edit that replaces the first branch over a jump, if no other reference leads to the jump; `None` if
/// there is no such branch. `targets` are the offsets of all reference targets. `find_offset` returns the offset of a
/// reference's target, or `None` if the target is not in this code.
pub fn find_edit(
    code: &Code,
    targets: &[u64],
    find_offset: impl Fn(&Relocation) -> Option<u64>,
) -> Option<Edit> {
    let mut pairs = code.instructions.windows(2).enumerate();
    pairs.find_map(|(index, pair)| {
        let [branch, jump] = pair else { return None };
        let may_be_skipped = index > 0 && may_skip_next(code.instructions[index - 1].first_word);
        if may_be_skipped || !is_branch(branch.first_word) || !is_rjmp(jump.first_word) {
            return None;
        }
        let branch_target = find_offset(code.reference_at(branch.offset)?)?;
        let reference = code.reference_at(jump.offset)?;
        let jump_target = find_offset(reference)?;
        if branch_target != jump.offset + 2
            || jump_target.abs_diff(branch.offset) > REACH_BYTES
            || targets.contains(&jump.offset)
        {
            return None;
        }
        Some(Edit {
            offset: branch.offset,
            removed_size: 4,
            // brbs and brbc differ in one bit. The linker inserts the distance.
            new_words: vec![(branch.first_word ^ 0x0400) & 0xfc07],
            references: vec![Relocation {
                r_offset: 0,
                r_type: elf::R_AVR_7_PCREL,
                ..*reference
            }],
        })
    })
}
