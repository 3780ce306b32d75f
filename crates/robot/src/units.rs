//! The core's units as floating point has them.

use lizard_core::numbers::units;

/// Steps of an angle in one degree.
pub const STEPS_PER_DEGREE: f64 = units::TURN as f64 / 360.0;

/// Frames of 20 ms in a second.
pub const FRAMES_PER_SECOND: f64 = units::FRAMES_PER_SECOND as f64;

/// Frames without a change of the pose that `status` says, after which a robot stands still: the gait
/// `stand` brakes for seven before another motion begins, which begins so slowly that its
/// first frames do not show in hundredths of a degree.
pub const STILL_FRAMES: u64 = 12;

/// Cycles of the processor in a microsecond.
pub(crate) const CYCLES_PER_US: f64 = units::CYCLES_PER_US as f64;

/// 1.0 as a sine.
pub(crate) const ONE_Q15: f64 = units::ONE_Q15 as f64;

/// 1.0 as a gain.
pub(crate) const ONE_Q14: f64 = units::ONE_Q14 as f64;

/// Phases that tables tell apart in one cycle.
pub(crate) const PHASES: f64 = units::CYCLE16 as f64;
