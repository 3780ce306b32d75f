//! How one servo turns a pulse into an angle.
//!
//! Servos of one type differ, and a horn goes on its spline only every 14
//! degrees. So this is no constant of the robot but a value that the motion
//! holds, and that may be changed while the robot runs.

use lizard_avr::mul;

use crate::units::{Sweep, Width};

/// One servo's pulses and travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Calibration {
    /// The pulse width at the neutral angle.
    pub neutral: Width,
    /// CPU cycles for each 1/65536 turn, Q14; negative for a servo whose
    /// longer pulse turns it clockwise.
    pub gain: i16,
    /// The travel's clockwise end.
    pub min: Sweep,
    /// The travel's counter-clockwise end.
    pub max: Sweep,
}

impl Calibration {
    /// The pulse width that turns the servo to `sweep`.
    pub fn width(&self, sweep: Sweep) -> Width {
        let turned = (mul(sweep.0, self.gain) + (1 << 13)) >> 14;
        Width(self.neutral.0.wrapping_add(turned as u16))
    }

    /// True where the travel of the servo reaches `sweep`.
    pub const fn reaches(&self, sweep: Sweep) -> bool {
        self.min.0 <= sweep.0 && sweep.0 <= self.max.0
    }
}
