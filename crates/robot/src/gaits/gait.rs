//! A gait in floating point: the reference for tables, pulses and predictions.

use crate::config::servo::{FORWARD_TURN_SIGN, OPPOSITE_SERVO};
use crate::gaits::waveform::Waveform;
use crate::units::STEPS_PER_DEGREE;

/// The movement of one leg over a cycle: `amplitude * waveform(phase - start)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Stride {
    /// The shape of the movement.
    pub waveform: Waveform,
    /// Phase at which the waveform starts, 0 to 1.
    pub start: f64,
    /// Sweep at which the waveform is 1, deg; negative if the leg moves opposite to the others.
    pub amplitude: f64,
}

impl Stride {
    /// A leg that holds its neutral angle.
    pub const STILL: Self = Self {
        waveform: Waveform::Still,
        start: 0.0,
        amplitude: 0.0,
    };

    /// The leg's sweep from neutral at a phase of 0 to 1, deg, positive if the foot is forward.
    pub fn sweep(&self, phase: f64) -> f64 {
        self.amplitude * self.waveform.value_at(phase - self.start)
    }
}

/// A gait of robot.toml with its references resolved.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Gait {
    /// Name of the gait; with spaces instead of hyphens, it is also the console command.
    pub name: String,
    /// Duration of one cycle at full speed, s.
    pub period: f64,
    /// True if the phase runs backwards, from 1 to 0.
    pub is_reversed: bool,
    /// The legs in servo order: LF, RF, RH, LH.
    pub strides: [Stride; 4],
    /// The neutral servo angles, deg, chassis frame.
    pub neutral: [f64; 4],
}

impl Gait {
    /// The phase (0 to 1) at a time in seconds after a start at phase 0, at full speed.
    pub fn phase_at(&self, seconds: f64) -> f64 {
        let cycles = seconds / self.period;
        (if self.is_reversed { -cycles } else { cycles }).rem_euclid(1.0)
    }

    /// The legs' sweeps from neutral at a phase, deg, positive if the foot is forward, servo order.
    pub fn sweeps(&self, phase: f64) -> [f64; 4] {
        self.strides.each_ref().map(|stride| stride.sweep(phase))
    }

    /// The servo angles at a phase, deg, chassis frame, servo order.
    pub fn angles(&self, phase: f64) -> [f64; 4] {
        let sweeps = self.sweeps(phase);
        std::array::from_fn(|i| self.neutral[i] + FORWARD_TURN_SIGN[i] * sweeps[i])
    }

    /// Converts the firmware's sweeps from neutral (angle steps, counter-clockwise positive) to servo angles: deg,
    /// chassis frame, servo order.
    pub fn angles_from_table(&self, sweeps: [i16; 4]) -> [f64; 4] {
        std::array::from_fn(|i| self.neutral[i] + f64::from(sweeps[i]) / STEPS_PER_DEGREE)
    }

    /// Returns the gait with the strides of the left and right legs swapped; the neutral angles stay.
    pub fn mirrored(mut self) -> Self {
        self.strides = OPPOSITE_SERVO.map(|i| self.strides[i].clone());
        self
    }

    /// Returns the gait with each leg's sweep multiplied by its gain.
    pub fn scaled(mut self, gains: [f64; 4]) -> Self {
        for (stride, gain) in self.strides.iter_mut().zip(gains) {
            stride.amplitude *= gain;
        }
        self
    }
}
