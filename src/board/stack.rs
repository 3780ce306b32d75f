//! The guard word at the end of the data, which the stack must not reach.
//!
//! The stack grows from the end of RAM down towards the data, and the chip does not detect an overflow. `make bench`
//! computes the largest depth of the stack. The guard word between stack and data reveals an overflow that this
//! computation did not foresee; main checks the word in every frame.

use core::arch::global_asm;

use servo_pulses::cells::SharedByte;

/// The pattern of the guard word, which the stack rarely contains by chance.
const GUARD: [u8; 4] = [0xde, 0x5a, 0xc3, 0x17];

// The linker places this section after all others, at the end of the data. The start-up code does not clear the
// section, and the image contains no bytes for it.
global_asm!(
    ".pushsection .noinit.zz_guard,\"aw\",@nobits",
    ".global lizard_stack_guard",
    "lizard_stack_guard: .skip 4",
    ".popsection",
);

unsafe extern "C" {
    #[link_name = "lizard_stack_guard"]
    #[allow(improper_ctypes, reason = "no other language uses it")]
    static GUARD_WORD: [SharedByte; 4];
}

fn guard_word() -> &'static [SharedByte; 4] {
    // SAFETY: a `SharedByte` may have any value, so any contents of the RAM are valid.
    unsafe { &GUARD_WORD }
}

/// Writes the guard word. Call this function once.
pub fn start() {
    // Written byte by byte, because a loop over both arrays takes four times as much flash.
    let [a, b, c, d] = guard_word();
    a.set(GUARD[0]);
    b.set(GUARD[1]);
    c.set(GUARD[2]);
    d.set(GUARD[3]);
}

/// True unless the stack has grown into the data.
pub fn is_intact() -> bool {
    let [a, b, c, d] = guard_word();
    a.get() == GUARD[0] && b.get() == GUARD[1] && c.get() == GUARD[2] && d.get() == GUARD[3]
}
