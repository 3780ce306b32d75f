//! A straight stroke from one pose to another.
//!
//! All four servos start together, follow one smoothstep and arrive together;
//! the longest way sets the time, so that no servo exceeds the slew limit. A
//! smoothstep is at most one and a half times as fast as a steady move.

use lizard_avr::{mul, mul_unsigned};

use crate::pose::Pose;
use crate::robot::SLEW;

/// The shortest stroke, in frames: even a small correction is not a jerk. With
/// eight, no stroke changes a servo's speed faster than the gaits do.
const SHORTEST: u16 = 8;

/// Frames for each 1/65536 turn, Q16, rounded up. 3/2 of the mean pace is the
/// peak, and rounding in a frame may add up to three steps to it.
const FRAMES_PER_WAY: u16 = (3u32 << 16).div_ceil(2 * (SLEW as u32 - 3)) as u16;

/// All of a stroke, Q15.
const END: u16 = 1 << 15;

/// A stroke under way.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stroke {
    from: Pose,
    /// Share of the time that goes by in each frame at full pace, Q15.
    step: u16,
    /// Share of the time gone by, Q15.
    gone: u16,
}

impl Stroke {
    /// A stroke between two poses.
    pub fn new(from: &Pose, to: &Pose) -> Self {
        let way = from.farthest(to);
        let frames = (mul_unsigned(way, FRAMES_PER_WAY) >> 16) as u16 + 1;
        Self {
            from: *from,
            step: END / frames.max(SHORTEST),
            gone: 0,
        }
    }

    /// One frame on, at `pace` (1024 is full).
    pub fn advance(&mut self, pace: u16) {
        let step = (mul_unsigned(self.step, pace) >> 10) as u16;
        self.gone = (self.gone + step).min(END);
    }

    /// True where the stroke has arrived.
    pub const fn arrived(&self) -> bool {
        self.gone == END
    }

    /// Where the servos stand now, on their way to `target`.
    pub fn pose(&self, target: &Pose) -> Pose {
        if self.arrived() {
            return *target;
        }
        let share = smoothstep(self.gone) as i16;
        let mut pose = self.from;
        for (sweep, to) in pose.0.iter_mut().zip(&target.0) {
            // Twice half the way, because a way may be more than half a turn.
            let half = (*to >> 1) - (*sweep >> 1);
            *sweep = sweep.wrapping_add(((mul(half, share) + (1 << 13)) >> 14) as i16);
        }
        pose
    }
}

/// `3 u^2 - 2 u^3`, Q15; only for `u` below 1.
fn smoothstep(u: u16) -> u16 {
    let squared = (mul_unsigned(u, u) >> 15) as u16;
    (mul_unsigned(squared, 3 * (END / 2) - u) >> 14) as u16
}
