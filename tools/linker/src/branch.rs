//! A branch over a jump becomes the opposite branch.
//!
//! ```text
//! breq 1f          brne 2f
//! rjmp 2f
//! 1:               1:
//! ```

use object::elf;

use crate::code::Code;
use crate::edit::{Edit, Reference};
use crate::instruction::{is_branch, is_near_jump, skips};

/// How far a branch reaches, bytes. Nothing gets farther apart afterwards.
const REACH: u64 = 2 * 60;

/// The first of them whose jump no other jump leads to. `place` tells where a reference
/// leads in this code, if it does; `targets` are the offsets that something leads to.
pub fn edit(
    code: &Code,
    targets: &[u64],
    place: &dyn Fn(&Reference) -> Option<u64>,
) -> Option<Edit> {
    code.instructions
        .windows(2)
        .enumerate()
        .find_map(|(index, pair)| {
            let [branch, jump] = pair else { return None };
            let skipped = index > 0 && skips(code.instructions[index - 1].code);
            if skipped || !is_branch(branch.code) || !is_near_jump(jump.code) {
                return None;
            }
            let behind = jump.offset + 2;
            let over = place(code.reference(branch.offset)?)?;
            let there = code.reference(jump.offset)?;
            let target = place(there)?;
            if over != behind
                || target.abs_diff(branch.offset) > REACH
                || targets.contains(&jump.offset)
            {
                return None;
            }
            Some(Edit {
                at: branch.offset,
                remove: 4,
                // brbs and brbc differ in one bit; the distance is the linker's.
                insert: vec![(branch.code ^ 0x0400) & 0xfc07],
                references: vec![Reference {
                    offset: 0,
                    kind: elf::R_AVR_7_PCREL,
                    ..*there
                }],
            })
        })
}
