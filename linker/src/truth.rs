//! A truth value that is computed and tested at once becomes a branch.
//!
//! ```text
//! ldi r24, 1        brcs 2f
//! brcs 1f
//! mov r24, r1
//! 1: andi r24, 1
//! brne 2f
//! ```

use object::elf;

use crate::code::Code;
use crate::edit::{Edit, Reference};
use crate::flow::{are_flags_dead, is_register_dead, is_zero_kept};
use crate::instruction::{is_branch, skips};

/// The flag Z, as a branch names it.
const ZERO: u16 = 1;

/// The first such value that is not used later. `place` tells where a reference leads in
/// this code; `targets` are the offsets that something leads to, each as often as it does.
pub fn edit(
    code: &Code,
    targets: &[u64],
    place: &dyn Fn(&Reference) -> Option<u64>,
) -> Option<Edit> {
    (0..code.instructions.len()).find_map(|index| at(code, index, targets, place))
}

fn at(
    code: &Code,
    index: usize,
    targets: &[u64],
    place: &dyn Fn(&Reference) -> Option<u64>,
) -> Option<Edit> {
    let all = &code.instructions[index..];
    let [one, made, zero, rest @ ..] = all else {
        return None;
    };
    // ldi register, 1
    if one.code & 0xff0f != 0xe001 || !is_branch(made.code) {
        return None;
    }
    let field = one.code & 0x00f0;
    let register = 16 + (field >> 4) as u8;
    // ldi register, 0; mov register, r1
    let by_zero = zero.code == 0x2d01 | field;
    if zero.code != 0xe000 | field && !(by_zero && is_zero_kept(code, targets)) {
        return None;
    }
    // andi register, 1; cpi register, 0
    let asked: Vec<u16> = rest.iter().map(|at| at.code).collect();
    let [mask, compare] = [0x7001 | field, 0x3000 | field];
    let count = match asked.as_slice() {
        [first, second, ..] if *first == mask && *second == compare => 2,
        [first, ..] if *first == mask || *first == compare => 1,
        _ => return None,
    };
    let (joined, branch) = (rest.first()?, rest.get(count)?);
    if !is_branch(branch.code) || branch.code & 7 != ZERO {
        return None;
    }
    if place(code.reference(made.offset)?)? != joined.offset {
        return None;
    }
    // Nobody else comes into its middle, and it is not skipped in part.
    let end = branch.offset + 2;
    let inside = |target: &&u64| one.offset < **target && **target < end;
    let skipped = index > 0 && skips(code.instructions[index - 1].code);
    if skipped || targets.iter().filter(inside).count() != 1 {
        return None;
    }
    let there = code.reference(branch.offset)?;
    for next in [end, place(there)?] {
        if !is_register_dead(code, next, register, place) || !are_flags_dead(code, next, place) {
            return None;
        }
    }
    // It is 1 where the first branch is taken; brne asks for that, breq for the opposite.
    // brbs and brbc differ in one bit.
    let is_opposite = branch.code & 0x0400 == 0;
    let condition = made.code ^ if is_opposite { 0x0400 } else { 0 };
    Some(Edit {
        at: one.offset,
        remove: end - one.offset,
        insert: vec![condition & 0xfc07],
        references: vec![Reference {
            offset: 0,
            kind: elf::R_AVR_7_PCREL,
            ..*there
        }],
    })
}
