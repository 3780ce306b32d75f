//! Unit constants of the core, as floating-point numbers.

use lizard_core::numbers::units;

/// Steps of the core's angles in one degree.
pub const STEPS_PER_DEGREE: f64 = units::TURN as f64 / 360.0;

/// Frames of 20 ms in a second.
pub const FRAMES_PER_SECOND: f64 = units::FRAMES_PER_SECOND as f64;

/// Frames with an unchanged pose in `status` after which a robot counts as standing. The gait `stand` brakes for
/// seven frames before another motion begins, and the first frames of that motion change the angles by less than
/// the hundredth of a degree that `status` shows.
pub const STILL_FRAMES: u64 = 12;

/// Cycles of the processor in a microsecond.
pub(crate) const CYCLES_PER_US: f64 = units::CYCLES_PER_US as f64;

/// The value that represents 1.0 in a sine table.
pub(crate) const ONE_Q15: f64 = units::ONE_Q15 as f64;

/// The value that represents 1.0 in a gain.
pub(crate) const ONE_Q14: f64 = units::ONE_Q14 as f64;

/// Number of phases in one cycle of a table.
pub(crate) const PHASES: f64 = units::CYCLE16 as f64;
