//! A servo's calibration: the relation between its pulses and its angles.
//!
//! Servos of one type differ, and a horn fits on its spline only every 14 degrees. Therefore the calibration is not a
//! constant of the robot but part of the motion's state. It is computed from robot.toml and the user's adjustment
//! ([`crate::memory::adjustment`]).

use lizard_avr::{mul, mul_unsigned};

use crate::numbers::units::{PulseWidth, Sweep};

lizard_avr::pod! {
    /// The pulse widths and the travel of a servo.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Calibration {
        /// The pulse width at the neutral angle.
        pub neutral_width: PulseWidth,
        /// The change of the pulse width for each 1/65536 turn, CPU cycles, Q14; negative if a longer pulse turns the
        /// servo clockwise.
        pub gain: i16,
        /// The clockwise limit of the travel.
        pub travel_min: Sweep,
        /// The counter-clockwise limit of the travel.
        pub travel_max: Sweep,
    }
}

impl Calibration {
    /// A servo without travel.
    pub const NONE: Self = Self {
        neutral_width: PulseWidth(0),
        gain: 0,
        travel_min: Sweep(0),
        travel_max: Sweep(0),
    };

    /// Computes the pulse width that turns the servo to `sweep`, which must be within the travel.
    pub fn width(&self, sweep: Sweep) -> PulseWidth {
        PulseWidth(
            self.neutral_width
                .0
                .wrapping_add(self.width_change(sweep) as u16),
        )
    }

    /// Computes the pulse width for any sweep, even beyond the travel, CPU cycles, clamped to 0..=65535.
    #[inline(never)]
    pub fn clamped_width(&self, sweep: Sweep) -> u16 {
        let pulse = i32::from(self.neutral_width.0) + self.width_change(sweep);
        pulse.clamp(0, i32::from(u16::MAX)) as u16
    }

    /// Computes the difference between the pulse width at `sweep` and the neutral width, CPU cycles.
    fn width_change(&self, sweep: Sweep) -> i32 {
        (mul(sweep.0, self.gain) + (1 << 13)) >> 14
    }

    /// Computes how much the pulse width may change in a frame in which the servo may turn by at most `max_turn`, in
    /// 1/65536 turn. The result is at least one CPU cycle.
    pub fn max_width_change(&self, max_turn: u16) -> u16 {
        let cycles = (mul_unsigned(max_turn, self.gain.unsigned_abs()) >> 14) as u16;
        cycles.max(1)
    }

    /// True if the servo's travel includes `sweep`.
    pub const fn reaches(&self, sweep: Sweep) -> bool {
        self.travel_min.0 <= sweep.0 && sweep.0 <= self.travel_max.0
    }
}

lizard_avr::pod! {
    /// A range of a servo's sweeps.
    #[derive(Debug, Default, PartialEq, Eq)]
    pub struct SweepRange {
        /// The clockwise limit of the range.
        pub min: Sweep,
        /// The counter-clockwise limit of the range.
        pub max: Sweep,
    }
}

impl SweepRange {
    /// True if the servo's travel covers this range.
    pub fn is_within(&self, servo: &Calibration) -> bool {
        servo.travel_min <= self.min && self.max <= servo.travel_max
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
        fn a_pulse_is_within_two_cycles_of_the_exact_width_over_the_whole_travel(robot in Sample::random()) {
            for (servo, exact_servo) in robot.calibration().iter().zip(robot.measurements.servos) {
                for sweep in servo.travel_min.0..=servo.travel_max.0 {
                    let turn_deg = f64::from(sweep) / STEPS_PER_DEGREE;
                    let us = exact_servo.neutral_us + exact_servo.us_per_degree * turn_deg;
                    let width = f64::from(servo.width(Sweep(sweep)).0);
                    // The rounding of the neutral width and that of this width take half a cycle each. The rest is the
                    // effect of the gain's rounding over half a turn.
                    prop_assert!((width - 16.0 * us).abs() <= 2.0, "{exact_servo:?} at {sweep}: {width}");
                }
                prop_assert_eq!(servo.width(Sweep(0)), servo.neutral_width);
            }
        }

        #[test]
        fn a_servo_reaches_exactly_the_sweeps_within_its_travel(robot in Sample::random()) {
            for servo in &robot.calibration() {
                for sweep in i16::MIN..=i16::MAX {
                    let is_within = (servo.travel_min.0..=servo.travel_max.0).contains(&sweep);
                    prop_assert_eq!(servo.reaches(Sweep(sweep)), is_within);
                }
            }
        }
    }

    #[test]
    fn half_a_cycle_rounds_up_for_a_gain_of_either_sign() {
        let servo_with = |gain| Calibration {
            neutral_width: PulseWidth(20_000),
            gain,
            travel_min: Sweep(-9000),
            travel_max: Sweep(9000),
        };
        // The gains are 0.5 cycles and -1.5 cycles per step of a sweep.
        assert_eq!(servo_with(8192).width(Sweep(3)), PulseWidth(20_002));
        assert_eq!(servo_with(8192).width(Sweep(-3)), PulseWidth(19_999));
        assert_eq!(servo_with(-24_576).width(Sweep(1)), PulseWidth(19_999));
        assert_eq!(servo_with(-24_576).width(Sweep(-1)), PulseWidth(20_002));
    }
}
