//! The core's unit constants as floating-point numbers, and the number of frames after which a robot stands still.

use lizard_core::numbers::units;

/// The core's angle steps per degree.
pub const STEPS_PER_DEGREE: f64 = units::STEPS_PER_TURN as f64 / 360.0;

/// Frames per second; a frame lasts 20 ms.
pub const FRAMES_PER_SECOND: f64 = units::FRAMES_PER_SECOND as f64;

/// Number of frames with an unchanged pose in `status` after which a robot counts as standing still. It must exceed the
/// pause between two motions: `stand` brakes for seven frames, and the first frames of the next motion change the
/// angles by less than 0.01 degrees, the resolution of `status`.
pub const STILL_FRAMES: u64 = 12;

/// Processor cycles per microsecond.
pub(crate) const CYCLES_PER_US: f64 = units::CYCLES_PER_US as f64;

/// The value that represents 1.0 in one of the core's sines.
pub(crate) const ONE_Q15: f64 = units::ONE_Q15 as f64;

/// The value that represents 1.0 in one of the core's gains.
pub(crate) const ONE_Q14: f64 = units::ONE_Q14 as f64;

/// Steps of the 16-bit phase per gait cycle.
pub(crate) const PHASE_STEPS_PER_CYCLE: f64 = units::CYCLE16 as f64;
