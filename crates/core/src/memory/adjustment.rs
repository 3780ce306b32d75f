//! The settings of a servo that a person may change while the robot runs.
//!
//! A horn fits on its spline only every 14 degrees, servos of one type differ in their gain, and some are
//! mounted upside down. So a person finds the four numbers here by looking at the robot, and the robot keeps
//! them in its EEPROM.

use lizard_avr::mul_unsigned;

use crate::numbers::calibration::Calibration;
use crate::numbers::root::quotient;
use crate::numbers::units::{ONE_Q14, Sweep, Width};

/// The numbers of one servo that a person may set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Adjustment {
    /// The angle by which the horn sits too far clockwise. The servo turns counter-clockwise by as much to
    /// reach its neutral angle.
    pub trim: Sweep,
    /// The servo's gain, as [`Calibration::gain`].
    pub gain: i16,
    /// The clockwise limit of the travel.
    pub min: Sweep,
    /// The counter-clockwise limit of the travel.
    pub max: Sweep,
}

impl Adjustment {
    /// The adjustment that leaves a servo as robot.toml defines it.
    pub const fn of(factory: &Calibration) -> Self {
        Self {
            trim: Sweep(0),
            gain: factory.gain,
            min: factory.min,
            max: factory.max,
        }
    }

    /// The servo of robot.toml, `factory`, with this adjustment. Its travel is limited to the pulses that
    /// `factory` allows.
    pub fn apply(&self, factory: &Calibration) -> Calibration {
        let end_pulses = [factory.pulse(factory.min), factory.pulse(factory.max)];
        let pulse_limits = [
            end_pulses[0].min(end_pulses[1]),
            end_pulses[0].max(end_pulses[1]),
        ];
        let mut servo = Calibration {
            neutral: factory.neutral,
            gain: self.gain,
            // An empty travel, for a trim that puts even the neutral angle outside of the allowed pulses.
            min: Sweep(1),
            max: Sweep(-1),
        };
        let neutral = servo.pulse(self.trim);
        servo.neutral = Width(neutral);
        if pulse_limits[0] <= neutral && neutral <= pulse_limits[1] {
            servo.min = limit_to_pulses(&servo, self.min, pulse_limits);
            servo.max = limit_to_pulses(&servo, self.max, pulse_limits);
        }
        servo
    }

    /// The scale, in hundredths of a microsecond per degree.
    pub fn scale(&self) -> u16 {
        ((mul_unsigned(self.gain.unsigned_abs(), 4551) + 0x8000) >> 16) as u16
    }

    /// Sets the scale, in hundredths of a microsecond per degree, at most 2000. The
    /// sense of turning stays.
    pub fn set_scale(&mut self, scale: u16) {
        // 16 cycles * 360 deg / 65536 * 2^14 / 100 is 14.4.
        let gain = ((mul_unsigned(scale, 58_982) + 0x800) >> 12) as i16;
        self.gain = if self.gain < 0 {
            gain.wrapping_neg()
        } else {
            gain
        };
    }

    /// True if a longer pulse turns the servo counter-clockwise.
    pub const fn is_direct(&self) -> bool {
        self.gain > 0
    }

    /// Sets the sense of turning.
    pub fn set_direct(&mut self, is_direct: bool) {
        if self.is_direct() != is_direct {
            self.gain = self.gain.wrapping_neg();
        }
    }
}

/// Limits a sweep to the pulses between the shortest and the longest: returns the sweep itself, or the last one on
/// the path to it from neutral whose pulse is allowed. The neutral pulse must be allowed.
#[inline(never)]
fn limit_to_pulses(servo: &Calibration, sweep: Sweep, [min_pulse, max_pulse]: [u16; 2]) -> Sweep {
    let neutral = servo.neutral.0;
    // A pulse is the neutral one plus n times the gain, rounded to a cycle. As long as n times the gain is at
    // most this number, the pulse is within both limits.
    let max_pulse_steps = if (servo.gain < 0) == (sweep.0 < 0) {
        mul_unsigned(max_pulse - neutral, ONE_Q14 as u16) + HALF_Q14 - 1
    } else {
        mul_unsigned(neutral - min_pulse, ONE_Q14 as u16) + HALF_Q14
    };
    let steps = quotient(max_pulse_steps, servo.gain.unsigned_abs());
    let magnitude = sweep.0.unsigned_abs().min(steps) as i16;
    Sweep(if sweep.0 < 0 {
        magnitude.wrapping_neg()
    } else {
        magnitude
    })
}

/// Half of 1.0 in Q14.
const HALF_Q14: u32 = (ONE_Q14 / 2) as u32;

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::sample::{STEPS_PER_DEGREE, Sample};

    /// Any adjustment that the console accepts.
    fn any_adjustment() -> impl Strategy<Value = Adjustment> {
        let sweep = -3641i16..=3641;
        (
            sweep,
            500u16..=2000,
            any::<bool>(),
            -30_000i16..0,
            0i16..30_000,
        )
            .prop_map(|(trim, scale, is_direct, min, max)| {
                let mut adjustment = Adjustment {
                    trim: Sweep(trim),
                    gain: 1,
                    min: Sweep(min),
                    max: Sweep(max),
                };
                adjustment.set_scale(scale);
                adjustment.set_direct(is_direct);
                adjustment
            })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]

        #[test]
        fn an_untouched_servo_is_that_of_robot_toml(robot in Sample::random()) {
            for servo in &robot.calibration() {
                prop_assert_eq!(&Adjustment::of(servo).apply(servo), servo);
            }
        }

        #[test]
        fn no_sweep_within_the_travel_leaves_the_pulses_of_robot_toml(
            robot in Sample::random(),
            adjustment in any_adjustment(),
        ) {
            for (factory, exact_servo) in robot.calibration().iter().zip(robot.measures.servos) {
                let servo = adjustment.apply(factory);
                for sweep in servo.min.0..=servo.max.0 {
                    let us = f64::from(servo.width(Sweep(sweep)).0) / 16.0;
                    // Two cycles of rounding: the ends of the travel, and this width.
                    let slack_us = 2.0 / 16.0;
                    prop_assert!(us >= exact_servo.min_us - slack_us && us <= exact_servo.max_us + slack_us);
                }
            }
        }

        #[test]
        fn a_travel_ends_at_its_limit_or_where_the_next_step_would_leave_the_pulses(
            robot in Sample::random(),
            adjustment in any_adjustment(),
        ) {
            for factory in &robot.calibration() {
                let servo = adjustment.apply(factory);
                let end_pulses = [factory.pulse(factory.min), factory.pulse(factory.max)];
                let pulse_limits = end_pulses[0].min(end_pulses[1])..=end_pulses[0].max(end_pulses[1]);
                if !pulse_limits.contains(&servo.pulse(Sweep(0))) {
                    prop_assert!(servo.min > Sweep(0) && servo.max < Sweep(0), "empty");
                    continue;
                }
                prop_assert!(adjustment.min <= servo.min && servo.max <= adjustment.max);
                if servo.max < adjustment.max {
                    prop_assert!(!pulse_limits.contains(&servo.pulse(Sweep(servo.max.0 + 1))));
                }
                if servo.min > adjustment.min {
                    prop_assert!(!pulse_limits.contains(&servo.pulse(Sweep(servo.min.0 - 1))));
                }
            }
        }

        #[test]
        fn a_servo_turns_by_its_trim_and_its_scale(
            robot in Sample::random(),
            adjustment in any_adjustment(),
            scale in 500u16..=2000,
            sweep in -8000i16..8000,
        ) {
            let mut adjustment = adjustment;
            adjustment.set_scale(scale);
            for (factory, exact_servo) in robot.calibration().iter().zip(robot.measures.servos) {
                let servo = adjustment.apply(factory);
                let degrees = (f64::from(adjustment.trim.0) + f64::from(sweep)) / STEPS_PER_DEGREE;
                let sense = if adjustment.is_direct() { 1.0 } else { -1.0 };
                let us = exact_servo.neutral_us + sense * f64::from(scale) / 100.0 * degrees;
                let error = f64::from(servo.pulse(Sweep(sweep))) - 16.0 * us;
                // Half a cycle each of the neutral width, the trim, the sweep; and the
                // gain's rounding over a sixth of a turn.
                prop_assert!(error.abs() <= 2.5, "{error}");
            }
        }
    }

    #[test]
    fn a_trim_of_one_degree_at_ten_microseconds_is_160_cycles() {
        let mut adjustment = Adjustment::default();
        adjustment.set_scale(1000);
        adjustment.trim = Sweep(182);
        let factory = Calibration {
            neutral: Width(24_000),
            gain: adjustment.gain,
            min: Sweep(-16_384),
            max: Sweep(16_384),
        };
        assert_eq!(adjustment.apply(&factory).neutral, Width(24_160));
    }

    #[test]
    fn every_scale_comes_back_as_it_was_set_and_keeps_the_sense() {
        for gain in [1, -1] {
            for scale in 500..=2000 {
                let mut adjustment = Adjustment {
                    gain,
                    ..Adjustment::default()
                };
                adjustment.set_scale(scale);
                assert_eq!(adjustment.scale(), scale);
                assert_eq!(adjustment.gain > 0, gain > 0);
                let exact = f64::from(scale) / 100.0 * 16.0 * 360.0 / 65536.0 * 16384.0;
                assert!(
                    (f64::from(adjustment.gain.abs()) - exact).abs() < 0.71,
                    "{scale}"
                );
                adjustment.set_direct(false);
                assert!(adjustment.gain < 0);
                adjustment.set_direct(true);
                assert!(adjustment.gain > 0 && adjustment.is_direct());
            }
        }
    }
}
