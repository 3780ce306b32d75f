//! The units of the core in floating point.

use lizard_core::numbers::units;

/// Steps of the core's angles in one degree.
pub const STEPS_PER_DEGREE: f64 = units::TURN as f64 / 360.0;

/// Frames of 20 ms in a second.
pub const FRAMES_PER_SECOND: f64 = units::FRAMES_PER_SECOND as f64;

/// Frames without a change of the pose in `status` after which a robot counts as standing. The
/// gait `stand` brakes for seven frames before another motion begins, and the first frames of
/// that are too slow to show in hundredths of a degree.
pub const STILL_FRAMES: u64 = 12;

/// Cycles of the processor in a microsecond.
pub(crate) const CYCLES_PER_US: f64 = units::CYCLES_PER_US as f64;

/// The value 1.0 of a sine.
pub(crate) const ONE_Q15: f64 = units::ONE_Q15 as f64;

/// The value 1.0 of a gain.
pub(crate) const ONE_Q14: f64 = units::ONE_Q14 as f64;

/// Number of phases in one cycle of a table.
pub(crate) const PHASES: f64 = units::CYCLE16 as f64;
