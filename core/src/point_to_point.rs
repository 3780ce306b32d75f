//! A point-to-point move: straight from one pose to another.
//!
//! All four servos start together, follow one smoothstep and arrive together;
//! the longest way sets the time, so that no servo exceeds the slew limit. A
//! smoothstep is at most one and a half times as fast as a steady move.

use lizard_avr::{mul, mul_unsigned};

use crate::pose::Pose;

/// The shortest move, in frames: even a small correction is not a jerk. With
/// eight, no move changes a servo's speed faster than the gaits do.
const SHORTEST: u16 = 8;

/// All of a move's time, Q15.
const END: u16 = 1 << 15;

/// How fast the servos may turn in a move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slew {
    /// The most in a frame, 1/65536 turn.
    pub per_frame: u16,
    /// Frames for each 1/65536 turn of the longest way, Q16, rounded up.
    frames_per_way: u16,
}

impl Slew {
    /// The least that a limit may be, 1/65536 turn in a frame: slower, and a move
    /// takes more frames than sixteen bits count.
    pub const SLOWEST: u16 = 36;

    /// A limit in 1/65536 turn a frame.
    ///
    /// # Panics
    /// In the compiler, where it is below [`Slew::SLOWEST`].
    pub const fn new(per_frame: u16) -> Self {
        assert!(per_frame >= Self::SLOWEST);
        Self {
            per_frame,
            // 3/2 of the mean pace is the peak, and rounding in a frame may add up
            // to three steps to it.
            frames_per_way: (3u32 << 16).div_ceil(2 * (per_frame as u32 - 3)) as u16,
        }
    }
}

/// A move under way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointToPoint {
    from: Pose,
    to: Pose,
    /// Share of the time that goes by in each frame at full pace, Q15.
    step: u16,
    /// Share of the time gone by, Q15.
    gone: u16,
}

impl PointToPoint {
    /// A move between two poses.
    pub fn new(from: &Pose, to: &Pose, slew: Slew) -> Self {
        let way = from.farthest(to);
        let frames = (mul_unsigned(way, slew.frames_per_way) >> 16) as u16 + 1;
        Self {
            from: *from,
            to: *to,
            step: END / frames.max(SHORTEST),
            gone: 0,
        }
    }

    /// One frame on, at `pace` (1024 is full).
    pub fn advance(&mut self, pace: u16) {
        let step = (mul_unsigned(self.step, pace) >> 10) as u16;
        self.gone = (self.gone + step).min(END);
    }

    /// True where the move has arrived.
    pub const fn arrived(&self) -> bool {
        self.gone == END
    }

    /// Where the servos stand now.
    pub fn pose(&self) -> Pose {
        if self.arrived() {
            return self.to;
        }
        let share = smoothstep(self.gone) as i16;
        let mut pose = self.from;
        for (sweep, to) in pose.0.iter_mut().zip(&self.to.0) {
            // Twice half the way, because a way may be more than half a turn.
            let half = (to.0 >> 1) - (sweep.0 >> 1);
            let way = (mul(half, share) + (1 << 13)) >> 14;
            sweep.0 = sweep.0.wrapping_add(way as i16);
        }
        pose
    }
}

/// `3 u^2 - 2 u^3`, Q15; only for `u` below 1.
fn smoothstep(u: u16) -> u16 {
    let squared = (mul_unsigned(u, u) >> 15) as u16;
    (mul_unsigned(squared, 3 * (END / 2) - u) >> 14) as u16
}
