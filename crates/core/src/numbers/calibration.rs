//! A servo's calibration: the relation of its pulses to its angles.
//!
//! Servos of one type differ, and a horn fits its spline only every 14 degrees. So the calibration is no constant of
//! the robot: it is a value in the motion, computed from robot.toml and from the adjustment that a user has made
//! ([`crate::memory::adjustment`]).

use lizard_avr::{mul, mul_unsigned};

use crate::numbers::units::{Sweep, Width};

lizard_avr::plain! {
    /// The pulse widths and the travel of one servo.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Calibration {
        /// The pulse width at the neutral angle.
        pub neutral: Width,
        /// CPU cycles for each 1/65536 turn, Q14; negative for a servo that a longer pulse turns clockwise.
        pub gain: i16,
        /// The clockwise limit of the travel.
        pub min: Sweep,
        /// The counter-clockwise limit of the travel.
        pub max: Sweep,
    }
}

impl Calibration {
    /// A servo without travel.
    pub const NONE: Self = Self {
        neutral: Width(0),
        gain: 0,
        min: Sweep(0),
        max: Sweep(0),
    };

    /// The pulse width that turns the servo to `sweep`.
    pub fn width(&self, sweep: Sweep) -> Width {
        Width(self.neutral.0.wrapping_add(self.pulse_change(sweep) as u16))
    }

    /// The pulse width for any sweep, even one beyond the travel, clamped to 0..=65535.
    #[inline(never)]
    pub fn pulse(&self, sweep: Sweep) -> u16 {
        let pulse = i32::from(self.neutral.0) + self.pulse_change(sweep);
        pulse.clamp(0, i32::from(u16::MAX)) as u16
    }

    /// The change of the pulse width for a sweep from neutral, CPU cycles.
    fn pulse_change(&self, sweep: Sweep) -> i32 {
        (mul(sweep.0, self.gain) + (1 << 13)) >> 14
    }

    /// The largest change of the pulse width in a frame, at least one CPU cycle, for a turn of `per_frame` (1/65536
    /// turn).
    pub fn slew(&self, per_frame: u16) -> u16 {
        let cycles = (mul_unsigned(per_frame, self.gain.unsigned_abs()) >> 14) as u16;
        cycles.max(1)
    }

    /// True if the servo's travel includes `sweep`.
    pub const fn reaches(&self, sweep: Sweep) -> bool {
        self.min.0 <= sweep.0 && sweep.0 <= self.max.0
    }
}

lizard_avr::plain! {
    /// The range of a servo's sweeps that a robot's gaits need; it includes the neutral angle, 0.
    #[derive(Debug, Default, PartialEq, Eq)]
    pub struct Reach {
        /// The clockwise limit of the range.
        pub min: Sweep,
        /// The counter-clockwise limit of the range.
        pub max: Sweep,
    }
}

impl Reach {
    /// True if a servo's travel covers this range.
    pub fn is_within(&self, servo: &Calibration) -> bool {
        servo.min <= self.min && self.max <= servo.max
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::sample::{STEPS_PER_DEGREE, Sample};

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn a_pulse_is_within_a_cycle_of_the_line_in_all_of_the_travel(robot in Sample::random()) {
            for (servo, exact_servo) in robot.calibration().iter().zip(robot.measures.servos) {
                for sweep in servo.min.0..=servo.max.0 {
                    let turn_deg = f64::from(sweep) / STEPS_PER_DEGREE;
                    let us = exact_servo.neutral_us + exact_servo.us_per_degree * turn_deg;
                    let width = f64::from(servo.width(Sweep(sweep)).0);
                    // Half a cycle for the rounding of the neutral width, half for that of this width, and the gain's
                    // rounding over half a turn.
                    prop_assert!((width - 16.0 * us).abs() <= 2.0, "{exact_servo:?} at {sweep}: {width}");
                }
                prop_assert_eq!(servo.width(Sweep(0)), servo.neutral);
            }
        }

        #[test]
        fn a_servo_reaches_both_ends_of_its_travel_and_not_a_step_more(robot in Sample::random()) {
            for servo in &robot.calibration() {
                for sweep in i16::MIN..=i16::MAX {
                    let is_within = (servo.min.0..=servo.max.0).contains(&sweep);
                    prop_assert_eq!(servo.reaches(Sweep(sweep)), is_within);
                }
            }
        }
    }

    #[test]
    fn half_a_cycle_rounds_up_for_either_sense_of_a_servo() {
        let servo_with = |gain| Calibration {
            neutral: Width(20_000),
            gain,
            min: Sweep(-9000),
            max: Sweep(9000),
        };
        // Gains of half a cycle and of one and a half cycles a step.
        assert_eq!(servo_with(8192).width(Sweep(3)), Width(20_002));
        assert_eq!(servo_with(8192).width(Sweep(-3)), Width(19_999));
        assert_eq!(servo_with(-24_576).width(Sweep(1)), Width(19_999));
        assert_eq!(servo_with(-24_576).width(Sweep(-1)), Width(20_002));
    }
}
