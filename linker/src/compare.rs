//! A comparison with zero of a value that was just computed is left out, because the
//! flags already have the result.
//!
//! ```text
//! andi r24, 1       andi r24, 1
//! cpi r24, 0
//! brne 1f           brne 1f
//! ```

use crate::code::Code;
use crate::edit::{Edit, Reference};
use crate::flow::are_flags_dead;
use crate::instruction::{is_branch, result, skips};

/// The flag Z, as a branch names it.
const ZERO: u16 = 1;

/// The first such comparison to which no jump leads. `place` tells where a reference leads in
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
        // Only Z is the same: the branch must use it, and nothing may use the others.
        if !is_branch(branch.code) || branch.code & 7 != ZERO {
            return None;
        }
        let there = place(code.reference(branch.offset)?)?;
        let is_dead = |next| are_flags_dead(code, next, place);
        (is_dead(code.offset(index + 2)) && is_dead(there)).then(|| Edit {
            at: compared.offset,
            remove: 2,
            insert: Vec::new(),
            references: Vec::new(),
        })
    })
}
