//! What happens to a register's value, and to the flags, on every path that may follow.

use crate::code::Code;
use crate::edit::Reference;
use crate::instruction::{
    RET, RETI, is_branch, is_near_jump, reads_flags, skips, writes_all_flags,
};

/// The registers that an instruction reads and those that it writes, a bit each. None where
/// that is not known: calls, returns, jumps out, and what compilers do not use.
pub fn registers(code: u16) -> Option<(u32, u32)> {
    let bit = |register: u16| 1 << register;
    let pair = |register: u16| 3 << register;
    let [x, y, z] = [26, 28, 30].map(pair);
    let first = code >> 4 & 0x1f;
    let second = code >> 5 & 0x10 | code & 0x0f;
    let upper = 16 + (code >> 4 & 0x0f);
    let product = pair(0);
    Some(match code >> 12 {
        _ if code == 0 => (0, 0),
        // movw, muls, mulsu and the fractional ones
        0 if code >> 8 == 1 => (pair(code << 1 & 0x1e), pair(code >> 3 & 0x1e)),
        0 if code >> 8 == 2 => (bit(upper) | bit(16 + (code & 0x0f)), product),
        0 if code >> 8 == 3 => (bit(16 + (code >> 4 & 7)) | bit(16 + (code & 7)), product),
        0..=2 => match code >> 10 {
            // cpc, cpse, cp
            1 | 4 | 5 => (bit(first) | bit(second), 0),
            // mov
            11 => (bit(second), bit(first)),
            // sub and eor of a register with itself: zero, whatever it was
            6 | 9 if first == second => (0, bit(first)),
            // sbc, add, sub, adc, and, eor, or
            2 | 3 | 6..=10 => (bit(first) | bit(second), bit(first)),
            _ => return None,
        },
        // cpi; sbci, subi, ori, andi; ldi
        3 => (bit(upper), 0),
        4..=7 => (bit(upper), bit(upper)),
        14 => (0, bit(upper)),
        // ldd and std by Y or Z
        8 | 10 => {
            let pointer = if code & 8 == 0 { z } else { y };
            if code & 0x0200 == 0 {
                (pointer, bit(first))
            } else {
                (pointer | bit(first), 0)
            }
        }
        9 if code < 0x9400 => {
            let (pointer, moved) = match code & 0x0f {
                // lds and sts; pop and push
                0 | 0x0f => (0, 0),
                1 | 2 => (z, z),
                9 | 0x0a => (y, y),
                0x0c => (x, 0),
                0x0d | 0x0e => (x, x),
                // lpm; at the same places stores have something else
                4 if code < 0x9200 => (z, 0),
                5 if code < 0x9200 => (z, z),
                _ => return None,
            };
            if code < 0x9200 {
                (pointer, moved | bit(first))
            } else {
                (pointer | bit(first), moved)
            }
        }
        9 => match code {
            // com, neg, swap, inc, asr, lsr, ror, dec
            _ if code < 0x9600 && matches!(code & 0x0f, 0..=3 | 5..=7 | 10) => {
                (bit(first), bit(first))
            }
            // Flags set and cleared; sleep, wdr
            _ if code & 0xff0f == 0x9408 => (0, 0),
            0x9588 | 0x95a8 => (0, 0),
            // adiw and sbiw
            0x9600..=0x97ff => {
                let both = pair(24 + (code >> 3 & 6));
                (both, both)
            }
            // cbi, sbic, sbi, sbis
            0x9800..=0x9bff => (0, 0),
            // mul
            0x9c00.. => (bit(first) | bit(second), product),
            _ => return None,
        },
        // in and out
        11 if code & 0x0800 == 0 => (0, bit(first)),
        11 => (bit(first), 0),
        // rjmp and branches
        12 => (0, 0),
        15 if is_branch(code) => (0, 0),
        // bld, bst, sbrc and sbrs
        15 if code & 0x0e08 == 0x0800 => (bit(first), bit(first)),
        15 if code & 8 == 0 => (bit(first), 0),
        _ => return None,
    })
}

/// What one instruction means for a value.
enum Use {
    /// It is used, or may be.
    Read,
    /// There is another from here on.
    Lost,
    /// It stays.
    Kept,
}

/// Whether nothing uses a register's value from an offset on.
pub fn is_register_dead(
    code: &Code,
    from: u64,
    register: u8,
    place: &dyn Fn(&Reference) -> Option<u64>,
) -> bool {
    is_dead(code, from, place, &|word| match registers(word) {
        None => Use::Read,
        Some((read, _)) if read >> register & 1 == 1 => Use::Read,
        Some((_, written)) if written >> register & 1 == 1 => Use::Lost,
        Some(_) => Use::Kept,
    })
}

/// Whether nothing uses the flags from an offset on, in a function that changes them: it
/// leaves its caller none. One that it calls may be known to leave them alone
/// (`-enable-ipra`).
pub fn are_flags_dead(code: &Code, from: u64, place: &dyn Fn(&Reference) -> Option<u64>) -> bool {
    is_dead(code, from, place, &|word| match word {
        RET | RETI => Use::Lost,
        _ if reads_flags(word) || registers(word).is_none() => Use::Read,
        _ if writes_all_flags(word) => Use::Lost,
        _ => Use::Kept,
    })
}

fn is_dead(
    code: &Code,
    from: u64,
    place: &dyn Fn(&Reference) -> Option<u64>,
    used: &dyn Fn(u16) -> Use,
) -> bool {
    let mut seen = Vec::new();
    let mut open = vec![from];
    while let Some(offset) = open.pop() {
        if seen.contains(&offset) {
            continue;
        }
        seen.push(offset);
        // What follows the code, or is between its instructions, is not known.
        let Some(index) = code.instructions.iter().position(|at| at.offset == offset) else {
            return false;
        };
        let word = code.instructions[index].code;
        match used(word) {
            Use::Read => return false,
            Use::Lost => continue,
            Use::Kept => {}
        }
        if is_branch(word) || is_near_jump(word) {
            let Some(target) = code.reference(offset).and_then(place) else {
                return false;
            };
            open.push(target);
        }
        if !is_near_jump(word) {
            open.push(code.offset(index + 1));
        }
        if skips(word) {
            open.push(code.offset(index + 2));
        }
    }
    true
}

/// Whether r1 is zero wherever a block begins, as compilers have it: what else writes it, a
/// product, is followed by `eor r1, r1` before anything leads elsewhere or here.
pub fn is_zero_kept(code: &Code, targets: &[u64]) -> bool {
    const CLEAR: u16 = 0x2411;
    let mut is_zero = true;
    for at in &code.instructions {
        let leads = is_branch(at.code) || is_near_jump(at.code) || skips(at.code);
        let (_, written) = registers(at.code).unwrap_or((0, 0));
        let is_edge = leads || registers(at.code).is_none() || targets.contains(&at.offset);
        if is_edge && !is_zero {
            return false;
        }
        if at.code == CLEAR {
            is_zero = true;
        } else if written & 2 != 0 {
            is_zero = false;
        }
    }
    is_zero
}
