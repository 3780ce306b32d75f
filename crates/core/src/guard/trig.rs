//! Sine and cosine of an angle, from a quarter wave in flash.
//!
//! The guard requires the directions of four cranks in every frame. A table of 129 points with linear interpolation has
//! an error of at most 4.5e-5 (one step of Q15 is 3.1e-5). Only an error a hundred times as large would affect the
//! margins.

use lizard_avr::flash;

use crate::numbers::units::Angle;

/// A direction as sine and cosine, Q15; 1.0 is stored as 32767.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Direction {
    /// Sine of the angle.
    pub sin: i16,
    /// Cosine of the angle.
    pub cos: i16,
}

impl Direction {
    /// Returns the direction of an angle, read from the table.
    pub fn from_angle(angle: Angle) -> Self {
        let angle = angle.0;
        let angle_in_quadrant = angle & 0x3fff;
        let rising_sine = first_quadrant_sine(angle_in_quadrant);
        let falling_sine = first_quadrant_sine(0x4000 - angle_in_quadrant);
        let (sin, cos) = match angle >> 14 {
            0 => (rising_sine, falling_sine),
            1 => (falling_sine, -rising_sine),
            2 => (-rising_sine, -falling_sine),
            _ => (-falling_sine, rising_sine),
        };
        Self { sin, cos }
    }

    /// Returns the direction mirrored in the y axis of the chassis, which converts a crank of the right side to a crank
    /// of the left side.
    pub const fn mirrored(self) -> Self {
        Self {
            sin: self.sin,
            cos: -self.cos,
        }
    }

    /// Returns the direction mirrored in the x axis of the chassis: the direction of a tail crank in the tail's own
    /// frame, in which the tail has the head's geometry.
    pub const fn in_tail_frame(self) -> Self {
        Self {
            sin: -self.sin,
            cos: self.cos,
        }
    }
}

/// The number of steps in the table.
const STEP_COUNT: usize = 128;

/// Returns the sine of an angle in the first quadrant, 0..=0x4000.
fn first_quadrant_sine(angle_in_quadrant: u16) -> i16 {
    let index = usize::from(angle_in_quadrant >> 7);
    let entry = QUARTER_WAVE_SINES.at(index).load();
    // At 0x4000, `at` returns the last entry.
    let next_entry = QUARTER_WAVE_SINES.at(index + 1).load();
    // A step is at most 402, so its product with the fraction can exceed 16 bits; the step's two bytes are therefore
    // multiplied separately.
    let step = (next_entry - entry) as u16;
    let fraction = (angle_in_quadrant << 1) & 0xff;
    let rise = (step >> 8) * fraction + (((step & 0xff) * fraction + 0x80) >> 8);
    entry + rise as i16
}

flash! {
    const QUARTER_WAVE_SINES: [i16; STEP_COUNT + 1] = compute_quarter_wave();
}

/// Computes the table of a quarter wave at compile time, so that no float reaches the microcontroller.
const fn compute_quarter_wave() -> [i16; STEP_COUNT + 1] {
    let mut table = [0; STEP_COUNT + 1];
    let mut k = 0;
    while k < STEP_COUNT {
        let x = core::f64::consts::FRAC_PI_2 * k as f64 / STEP_COUNT as f64;
        // Taylor series; the first omitted term is below 1e-11 on this interval.
        let mut term = x;
        let mut sum = x;
        let mut n = 1.0;
        while n < 8.0 {
            term *= -x * x / ((2.0 * n) * (2.0 * n + 1.0));
            sum += term;
            n += 1.0;
        }
        table[k] = (sum * 32768.0 + 0.5) as i16;
        k += 1;
    }
    table[STEP_COUNT] = i16::MAX;
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::units::Sine;
    use crate::sample::{to_degrees, to_f64};

    #[test]
    fn sine_and_cosine_have_errors_of_at_most_4_5e_5_at_every_angle() {
        let (mut max_error, mut max_length_error) = (0.0f64, 0.0f64);
        for angle in (0..=u16::MAX).map(Angle) {
            let direction = Direction::from_angle(angle);
            let components = [direction.sin, direction.cos].map(|q15| to_f64(Sine(q15)));
            let (sin, cos) = to_degrees(angle).to_radians().sin_cos();
            max_error = max_error
                .max((components[0] - sin).abs())
                .max((components[1] - cos).abs());
            max_length_error =
                max_length_error.max((components[0].hypot(components[1]) - 1.0).abs());
        }
        assert!(max_error <= 4.5e-5, "{max_error}");
        assert!(max_length_error <= 6e-5, "{max_length_error}");
    }

    #[test]
    fn the_four_axis_directions_are_exact() {
        let unit = i16::MAX;
        for (angle, sin, cos) in [
            (0, 0, unit),
            (0x4000, unit, 0),
            (0x8000, 0, -unit),
            (0xc000, -unit, 0),
        ] {
            assert_eq!(Direction::from_angle(Angle(angle)), Direction { sin, cos });
        }
    }

    #[test]
    fn quadrants_and_mirror_images_agree_bit_for_bit() {
        for angle in 0..=u16::MAX {
            let direction = Direction::from_angle(Angle(angle));
            let rotated = Direction::from_angle(Angle(angle.wrapping_add(0x4000)));
            assert_eq!((rotated.cos, rotated.sin), (-direction.sin, direction.cos));
            let mirrored = Direction::from_angle(Angle(0x8000u16.wrapping_sub(angle)));
            assert_eq!(direction.mirrored(), mirrored);
            let tail_direction = Direction::from_angle(Angle(angle.wrapping_neg()));
            assert_eq!(direction.in_tail_frame(), tail_direction);
        }
    }
}
