//! A comparison with zero of what was just computed is left out: the flags say it already.
//!
//! ```text
//! andi r24, 1       andi r24, 1
//! cpi r24, 0
//! brne 1f           brne 1f
//! ```

use crate::code::Code;
use crate::edit::{Edit, Reference};
use crate::instruction::{ends_block, is_branch, reads_flags, result, skips, writes_flags};

/// The flag Z, as a branch names it.
const ZERO: u16 = 1;

/// The first such comparison that nobody jumps to. `place` tells where a reference leads in
/// this code; `targets` are the offsets that something leads to.
pub fn edit(
    code: &Code,
    targets: &[u64],
    place: &dyn Fn(&Reference) -> Option<u64>,
) -> Option<Edit> {
    let all = &code.instructions;
    (1..all.len()).find_map(|index| {
        let [computed, compared, branch] = all.get(index - 1..index + 2)? else {
            return None;
        };
        let register = result(computed.code)?;
        let is_compared = register >= 16 && compared.code == 0x3000 | u16::from(register - 16) << 4;
        let skipped = index >= 2 && skips(all[index - 2].code);
        if !is_compared || skipped || targets.contains(&compared.offset) {
            return None;
        }
        // Only Z is the same: the branch must ask for it, and nobody for the others.
        if !is_branch(branch.code) || branch.code & 7 != ZERO {
            return None;
        }
        let there = place(code.reference(branch.offset)?)?;
        let there = all.iter().position(|at| at.offset == there)?;
        (is_dead(code, index + 2) && is_dead(code, there)).then(|| Edit {
            at: compared.offset,
            remove: 2,
            insert: Vec::new(),
            references: Vec::new(),
        })
    })
}

/// Whether nobody asks for the flags from an instruction on. They do not outlive a block,
/// which the compiler ends with all branches on one comparison.
fn is_dead(code: &Code, from: usize) -> bool {
    for at in &code.instructions[from.min(code.instructions.len())..] {
        if reads_flags(at.code) {
            return false;
        }
        if writes_flags(at.code) || ends_block(at.code) {
            return true;
        }
    }
    true
}
