//! The units of the core, and every conversion between them.
//!
//! An 8-bit processor has no use for floating point, so each quantity gets an
//! integer whose step is finer than the robot can show:
//!
//! | quantity | type | step |
//! |---|---|---|
//! | angle, chassis frame | `u16`, wraps with the turn | 1/65536 turn = 0.0055 deg |
//! | sweep, an angle from a servo's neutral | `i16` | the same |
//! | angle at the console | `i32` | 0.01 deg |
//! | length | `i16`, `u16` | 1/256 mm |
//! | margin, sine, cosine | `i16` Q15 | 1/32768 |
//! | pulse width | `u16` | one CPU cycle, 62.5 ns |
//! | phase of a gait | `u32` | 1/2^24 cycle |
//! | share of a stroke | `u16` Q15 | 1/32768 |
//! | pace | `u16` Q10 | 1/1024 |

use lizard_avr::{mul, mul_unsigned};

/// Hundredths of a degree in a turn.
pub const TURN_CENTIDEG: i32 = 36_000;

/// Frames a second; every servo gets one pulse in each.
pub const FRAMES_PER_SECOND: u16 = 50;

/// 1.0 in Q15, one past the largest sine.
pub const ONE_Q15: i32 = 1 << 15;

/// One gait cycle, as a phase.
pub const CYCLE: u32 = 1 << 24;

/// The angle at `centideg`, less than two turns either way, within 0.004 deg.
pub fn angle_from_centideg(centideg: i32) -> u16 {
    // No remainder, no quotient and no loop that the compiler takes for one:
    // each of them is a kilobyte of library.
    let mut within = centideg;
    if within < 0 {
        within += 2 * TURN_CENTIDEG;
    }
    if within >= TURN_CENTIDEG {
        within -= TURN_CENTIDEG;
    }
    // 65536/36000 is 1 + 53769/65536 to within a fifth of a step over the turn.
    let within = within as u16;
    within.wrapping_add(((mul_unsigned(within, 53_769) + 0x8000) >> 16) as u16)
}

/// `angle` in hundredths of a degree, 0..36000. Exact inverse of
/// [`angle_from_centideg`], whose step is the finer one.
pub fn centideg_from_angle(angle: u16) -> u16 {
    // The last step of a turn is 359.9945 deg, which does not round to 360.
    ((mul_unsigned(angle, TURN_CENTIDEG as u16) + 0x8000) >> 16) as u16
}

/// A length of 1/256 mm in hundredths of a millimetre, rounded to nearest.
pub fn hundredths_from_length(length: i16) -> i16 {
    ((mul(length, 100) + 128) >> 8) as i16
}

/// A Q15 margin in thousandths, rounded to nearest.
pub fn thousandths_from_q15(margin: i16) -> i16 {
    ((mul(margin, 1000) + (1 << 14)) >> 15) as i16
}

/// The phase's first sixteen bits, what tables are read by.
pub const fn phase16(phase: u32) -> u16 {
    (phase >> 8) as u16
}

/// The phase in thousandths of a cycle, 0..=999.
pub fn thousandths_from_phase(phase: u32) -> u16 {
    (mul_unsigned(phase16(phase), 1000) >> 16) as u16
}
