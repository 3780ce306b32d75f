//! Replacement of a branch over a jump by the opposite branch.
//!
//! ```text
//! breq 1f          brne 2f
//! rjmp 2f
//! 1:               1:
//! ```

use object::elf;

use crate::code::Code;
use crate::edit::{Edit, Reference};
use crate::instruction::{is_branch, is_rjmp, may_skip_next};

/// Distance that a branch certainly reaches, bytes. Later edits never increase a distance.
const REACH_BYTES: u64 = 2 * 60;

/// Returns the edit that replaces the first branch over a jump, where nothing else refers to that jump;
/// `None` if there is no such branch. `offset_of` gives the offset of a reference's target if the target is in
/// this code; `targets` are the offsets that something refers to.
pub fn edit(
    code: &Code,
    targets: &[u64],
    offset_of: &dyn Fn(&Reference) -> Option<u64>,
) -> Option<Edit> {
    code.instructions
        .windows(2)
        .enumerate()
        .find_map(|(index, pair)| {
            let [branch, jump] = pair else { return None };
            let may_be_skipped = index > 0 && may_skip_next(code.instructions[index - 1].code);
            if may_be_skipped || !is_branch(branch.code) || !is_rjmp(jump.code) {
                return None;
            }
            let next_offset = jump.offset + 2;
            let branch_target = offset_of(code.reference(branch.offset)?)?;
            let reference = code.reference(jump.offset)?;
            let target = offset_of(reference)?;
            if branch_target != next_offset
                || target.abs_diff(branch.offset) > REACH_BYTES
                || targets.contains(&jump.offset)
            {
                return None;
            }
            Some(Edit {
                offset: branch.offset,
                remove: 4,
                // brbs and brbc differ in one bit; the linker fills in the distance.
                insert: vec![(branch.code ^ 0x0400) & 0xfc07],
                references: vec![Reference {
                    offset: 0,
                    kind: elf::R_AVR_7_PCREL,
                    ..*reference
                }],
            })
        })
}
