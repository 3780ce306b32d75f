//! The stack's guard: a word at the end of the data that the stack must not reach.
//!
//! The stack grows down from the end of RAM towards the data, and nothing in the
//! chip stops it there. `make bench` computes how deep it can get; the word between
//! the two is there for what nobody has thought of. It is looked at every frame.

use core::mem::MaybeUninit;

use super::shared::Byte;

/// What nobody would push by chance.
const GUARD: [u8; 4] = [0xde, 0x5a, 0xc3, 0x17];

/// The last of the data: the section comes after all others, and the start-up code
/// does not clear it.
#[unsafe(link_section = ".noinit.zz_guard")]
static WORD: MaybeUninit<[Byte; 4]> = MaybeUninit::uninit();

fn word() -> &'static [Byte; 4] {
    // SAFETY: every byte of RAM has some value, and each is one that a `Byte` may
    // have.
    unsafe { WORD.assume_init_ref() }
}

/// Sets the guard. Once.
pub fn start() {
    for (byte, value) in word().iter().zip(GUARD) {
        byte.set(value);
    }
}

/// Whether the stack has kept off the data.
pub fn is_intact() -> bool {
    word()
        .iter()
        .zip(GUARD)
        .all(|(byte, value)| byte.get() == value)
}
