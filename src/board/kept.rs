//! What a reset of the processor cannot take away: a few bytes of RAM that the
//! start of the program leaves alone.
//!
//! The boot loader of the UNO clears the register that says why the chip was reset,
//! and passes it on nowhere. But RAM keeps its contents as long as there is power. So
//! these bytes say, by a mark and a check sum that chance makes once in 32 768 times,
//! that power was not lost; and they hold what the program did until then. Where no
//! boot loader is in the way, the register itself tells.

use core::arch::global_asm;

use avr_device::atmega328p::CPU;
use lizard_core::pose::Pose;
use lizard_core::restart::{Cause, Restart};
use lizard_core::units::Sweep;

use super::shared::{Byte, Word};

/// Marks, for the first byte of what is kept.
const RUNNING: u8 = 0x5c;
const HUNG: u8 = 0xa3;

/// Whether there is a pose.
const HELD: u8 = 0x96;
const NONE: u8 = 0x69;

/// Bits of MCUSR, of which a boot loader may have cleared all.
const POWER_ON: u8 = 1;
const BROWN_OUT: u8 = 4;
const WATCHDOG: u8 = 8;

/// The bytes that are kept.
struct Kept {
    mark: Byte,
    /// How many times the program has begun since power came on, less one.
    count: Byte,
    /// The mark's and the count's complement.
    count_check: Byte,
    held: Byte,
    pose: [Word; 4],
    pose_check: Byte,
}

// The start-up code does not clear the section, and the image holds nothing for it;
// the compiler's own statics would be written into the image.
global_asm!(
    ".pushsection .noinit,\"aw\",@nobits",
    ".global lizard_kept",
    "lizard_kept: .skip {size}",
    ".popsection",
    size = const size_of::<Kept>(),
);

unsafe extern "C" {
    #[link_name = "lizard_kept"]
    #[allow(improper_ctypes, reason = "no other language sees it")]
    static KEPT: Kept;
}

fn kept() -> &'static Kept {
    // SAFETY: every byte of RAM has some value, and each is one that a `Byte` may
    // have; nothing is believed of them before the checks.
    unsafe { &KEPT }
}

/// Why the program begins, and what it did until then; from now on it runs. Once,
/// with interrupts off, before the watchdog starts.
#[inline(never)]
pub fn restart(cpu: &CPU) -> Restart {
    let kept = kept();
    let mark = kept.mark.get();
    let survived =
        matches!(mark, RUNNING | HUNG) && kept.count_check.get() == check(mark, kept.count.get());
    let flags = cpu.mcusr().read().bits();
    let cause = if flags & POWER_ON != 0 || (flags == 0 && !survived) {
        Cause::Power
    } else if flags & WATCHDOG != 0 || (flags == 0 && mark == HUNG) {
        Cause::Watchdog
    } else if flags & BROWN_OUT != 0 {
        Cause::BrownOut
    } else {
        Cause::External
    };
    // The watchdog cannot be changed while WDRF is set.
    cpu.mcusr().reset();
    let known = survived && cause != Cause::Power;
    let count = if known {
        kept.count.get().saturating_add(1)
    } else {
        0
    };
    let restart = Restart {
        cause,
        count,
        pose: if known { pose() } else { None },
    };
    set_mark(RUNNING, count);
    keep(None);
    restart
}

/// Keeps the pose that the servos are held in, if they are.
#[inline(never)]
pub fn keep(pose: Option<&Pose>) {
    let kept = kept();
    // Not believed while it is being written.
    kept.held.set(NONE);
    let Some(pose) = pose else {
        return;
    };
    let mut sum = 0;
    for (word, sweep) in kept.pose.iter().zip(&pose.0) {
        let value = sweep.0 as u16;
        word.set(value);
        sum = fold(sum, value);
    }
    kept.pose_check.set(!sum);
    kept.held.set(HELD);
}

/// A check sum of words, one more of them.
fn fold(sum: u8, value: u16) -> u8 {
    let [low, high] = value.to_le_bytes();
    sum.wrapping_add(low).wrapping_add(high)
}

/// From the watchdog's interrupt: the program has hung.
pub fn mark_hung() {
    set_mark(HUNG, kept().count.get());
}

fn set_mark(mark: u8, count: u8) {
    let kept = kept();
    kept.mark.set(mark);
    kept.count.set(count);
    kept.count_check.set(check(mark, count));
}

const fn check(mark: u8, count: u8) -> u8 {
    // Neither all zeros nor all ones pass.
    !(mark.rotate_left(3) ^ count)
}

fn pose() -> Option<Pose> {
    let kept = kept();
    if kept.held.get() != HELD {
        return None;
    }
    let mut pose = Pose::NEUTRAL;
    let mut sum = 0;
    for (word, sweep) in kept.pose.iter().zip(&mut pose.0) {
        let value = word.get();
        sum = fold(sum, value);
        *sweep = Sweep(value as i16);
    }
    (kept.pose_check.get() == !sum).then_some(pose)
}
