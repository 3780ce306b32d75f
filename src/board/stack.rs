//! The stack's guard: a word at the end of the data, which the stack must not reach.
//!
//! The stack grows down from the end of RAM towards the data, and nothing in the chip
//! stops it there. `make bench` computes how deep it can get. The guard word between stack and
//! data is for unforeseen cases; main checks it in every frame.

use core::arch::global_asm;

use servo_pulses::cells::Byte;

/// The pattern in the guard word, which the stack rarely contains by accident.
const GUARD: [u8; 4] = [0xde, 0x5a, 0xc3, 0x17];

// This section is placed after all others, at the end of the data. The start-up code
// does not clear it, and the image has no bytes for it.
global_asm!(
    ".pushsection .noinit.zz_guard,\"aw\",@nobits",
    ".global lizard_stack_guard",
    "lizard_stack_guard: .skip 4",
    ".popsection",
);

unsafe extern "C" {
    #[link_name = "lizard_stack_guard"]
    #[allow(improper_ctypes, reason = "no other language sees it")]
    static GUARD_WORD: [Byte; 4];
}

fn guard_word() -> &'static [Byte; 4] {
    // SAFETY: a byte of RAM may have any value, and so may a `Byte`.
    unsafe { &GUARD_WORD }
}

/// Writes the guard word. Call it once.
pub fn start() {
    // Written byte by byte, since a loop over both arrays takes four times as much flash.
    let [a, b, c, d] = guard_word();
    a.set(GUARD[0]);
    b.set(GUARD[1]);
    c.set(GUARD[2]);
    d.set(GUARD[3]);
}

/// True while the stack has not grown into the data.
pub fn is_intact() -> bool {
    let [a, b, c, d] = guard_word();
    a.get() == GUARD[0] && b.get() == GUARD[1] && c.get() == GUARD[2] && d.get() == GUARD[3]
}
