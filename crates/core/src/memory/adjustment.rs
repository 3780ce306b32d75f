//! The settings of a servo that the user may change while the robot runs.
//!
//! A horn fits on its spline only every 14 degrees, servos of one type differ in their gain, and some servos are
//! mounted upside down. Therefore the user determines the four numbers of an adjustment on the assembled robot. The
//! robot stores them in its EEPROM.

use lizard_avr::mul_unsigned;

use crate::numbers::calibration::Calibration;
use crate::numbers::integer_math::saturating_div;
use crate::numbers::units::{ONE_Q14, PulseWidth, Sweep};

/// The numbers of a servo that the user may set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Adjustment {
    /// The angle by which the horn is mounted too far clockwise. In the neutral pose the servo turns counter-clockwise
    /// by this angle.
    pub trim: Sweep,
    /// The gain of the servo, see [`Calibration::gain`].
    pub gain: i16,
    /// The clockwise limit of the travel.
    pub travel_min: Sweep,
    /// The counter-clockwise limit of the travel.
    pub travel_max: Sweep,
}

impl Adjustment {
    /// Returns the adjustment that leaves the calibration in robot.toml unchanged.
    pub const fn from_calibration(factory: &Calibration) -> Self {
        Self {
            trim: Sweep(0),
            gain: factory.gain,
            travel_min: factory.travel_min,
            travel_max: factory.travel_max,
        }
    }

    /// Applies this adjustment to `factory`, the calibration in robot.toml. Limits the travel to the pulses that
    /// `factory` allows.
    pub fn apply(&self, factory: &Calibration) -> Calibration {
        let end_widths = [
            factory.clamped_width(factory.travel_min),
            factory.clamped_width(factory.travel_max),
        ];
        let width_limits = [
            end_widths[0].min(end_widths[1]),
            end_widths[0].max(end_widths[1]),
        ];
        let mut servo = Calibration {
            neutral_width: factory.neutral_width,
            gain: self.gain,
            // The travel is empty, and stays so if the trim moves even the neutral pulse outside the limits.
            travel_min: Sweep(1),
            travel_max: Sweep(-1),
        };
        let neutral_width = servo.clamped_width(self.trim);
        servo.neutral_width = PulseWidth(neutral_width);
        if width_limits[0] <= neutral_width && neutral_width <= width_limits[1] {
            servo.travel_min = limit_to_pulses(&servo, self.travel_min, width_limits);
            servo.travel_max = limit_to_pulses(&servo, self.travel_max, width_limits);
        }
        servo
    }

    /// The scale, in hundredths of a microsecond per degree.
    pub fn scale(&self) -> u16 {
        // 65536 / 14.4 is 4551; see `set_scale`.
        ((mul_unsigned(self.gain.unsigned_abs(), 4551) + 0x8000) >> 16) as u16
    }

    /// Sets the scale, in hundredths of a microsecond per degree, at most 2000. Keeps the direction of rotation.
    pub fn set_scale(&mut self, scale: u16) {
        // The gain is 16 cycles * 360 deg / 65536 * 2^14 / 100 = 14.4 times the scale, and 14.4 * 2^12 is 58 982.
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

    /// Sets the direction of rotation: true if a longer pulse turns the servo counter-clockwise.
    pub fn set_direct(&mut self, is_direct: bool) {
        if self.is_direct() != is_direct {
            self.gain = self.gain.wrapping_neg();
        }
    }
}

/// Returns `sweep` if its pulse is allowed, otherwise the largest sweep in the same direction whose pulse is allowed.
/// The neutral pulse must be allowed.
#[inline(never)]
fn limit_to_pulses(servo: &Calibration, sweep: Sweep, [min_width, max_width]: [u16; 2]) -> Sweep {
    let neutral_width = servo.neutral_width.0;
    // The pulse width of a sweep of n steps is the neutral width plus n times the gain, rounded to a cycle. If n times
    // the gain is at most `max_gain_multiple`, the width is within both limits.
    let max_gain_multiple = if (servo.gain < 0) == (sweep.0 < 0) {
        mul_unsigned(max_width - neutral_width, ONE_Q14 as u16) + HALF_Q14 - 1
    } else {
        mul_unsigned(neutral_width - min_width, ONE_Q14 as u16) + HALF_Q14
    };
    let max_steps = saturating_div(max_gain_multiple, servo.gain.unsigned_abs());
    let magnitude = sweep.0.unsigned_abs().min(max_steps) as i16;
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

    /// Yields any adjustment that the console accepts.
    fn any_adjustment() -> impl Strategy<Value = Adjustment> {
        let trim = -3641i16..=3641;
        let travel = (-30_000i16..0, 0i16..30_000);
        let numbers = (trim, 500u16..=2000, any::<bool>(), travel);
        numbers.prop_map(|(trim, scale, is_direct, (min, max))| {
            let mut adjustment = Adjustment {
                trim: Sweep(trim),
                gain: 1,
                travel_min: Sweep(min),
                travel_max: Sweep(max),
            };
            adjustment.set_scale(scale);
            adjustment.set_direct(is_direct);
            adjustment
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]

        #[test]
        fn an_unadjusted_servo_has_the_calibration_of_robot_toml(robot in Sample::random()) {
            for servo in &robot.calibration() {
                prop_assert_eq!(&Adjustment::from_calibration(servo).apply(servo), servo);
            }
        }

        #[test]
        fn every_sweep_within_the_travel_has_a_pulse_that_robot_toml_allows(
            robot in Sample::random(),
            adjustment in any_adjustment(),
        ) {
            for (factory, exact_servo) in robot.calibration().iter().zip(robot.measurements.servos) {
                let servo = adjustment.apply(factory);
                for sweep in servo.travel_min.0..=servo.travel_max.0 {
                    let us = f64::from(servo.width(Sweep(sweep)).0) / 16.0;
                    // One cycle of rounding for the end of the travel, and one for this width.
                    let slack_us = 2.0 / 16.0;
                    prop_assert!(us >= exact_servo.min_us - slack_us && us <= exact_servo.max_us + slack_us);
                }
            }
        }

        #[test]
        fn a_travel_ends_at_its_limit_or_where_the_next_pulse_is_not_allowed(
            robot in Sample::random(),
            adjustment in any_adjustment(),
        ) {
            for factory in &robot.calibration() {
                let servo = adjustment.apply(factory);
                let end_widths = [factory.clamped_width(factory.travel_min), factory.clamped_width(factory.travel_max)];
                let width_limits = end_widths[0].min(end_widths[1])..=end_widths[0].max(end_widths[1]);
                if !width_limits.contains(&servo.clamped_width(Sweep(0))) {
                    prop_assert!(servo.travel_min > Sweep(0) && servo.travel_max < Sweep(0), "the travel is empty");
                    continue;
                }
                prop_assert!(adjustment.travel_min <= servo.travel_min && servo.travel_max <= adjustment.travel_max);
                if servo.travel_max < adjustment.travel_max {
                    prop_assert!(!width_limits.contains(&servo.clamped_width(Sweep(servo.travel_max.0 + 1))));
                }
                if servo.travel_min > adjustment.travel_min {
                    prop_assert!(!width_limits.contains(&servo.clamped_width(Sweep(servo.travel_min.0 - 1))));
                }
            }
        }

        #[test]
        fn a_pulse_matches_the_trim_and_the_scale(
            robot in Sample::random(),
            adjustment in any_adjustment(),
            scale in 500u16..=2000,
            sweep in -8000i16..8000,
        ) {
            let mut adjustment = adjustment;
            adjustment.set_scale(scale);
            for (factory, exact_servo) in robot.calibration().iter().zip(robot.measurements.servos) {
                let servo = adjustment.apply(factory);
                let degrees = (f64::from(adjustment.trim.0) + f64::from(sweep)) / STEPS_PER_DEGREE;
                let sign = if adjustment.is_direct() { 1.0 } else { -1.0 };
                let us = exact_servo.neutral_us + sign * f64::from(scale) / 100.0 * degrees;
                let error_cycles = f64::from(servo.clamped_width(Sweep(sweep))) - 16.0 * us;
                // Half a cycle of rounding for each of the neutral width, the trim and the sweep, and the rounding of
                // the gain over a sixth of a turn.
                prop_assert!(error_cycles.abs() <= 2.5, "{error_cycles}");
            }
        }
    }

    #[test]
    fn a_trim_of_one_degree_at_ten_microseconds_per_degree_is_160_cycles() {
        let mut adjustment = Adjustment::default();
        adjustment.set_scale(1000);
        adjustment.trim = Sweep(182);
        let factory = Calibration {
            neutral_width: PulseWidth(24_000),
            gain: adjustment.gain,
            travel_min: Sweep(-16_384),
            travel_max: Sweep(16_384),
        };
        assert_eq!(adjustment.apply(&factory).neutral_width, PulseWidth(24_160));
    }

    #[test]
    fn every_scale_reads_back_unchanged_and_keeps_the_direction() {
        for gain in [1, -1] {
            for scale in 500..=2000 {
                let mut adjustment = Adjustment {
                    gain,
                    ..Adjustment::default()
                };
                adjustment.set_scale(scale);
                assert_eq!(adjustment.scale(), scale);
                assert_eq!(adjustment.gain > 0, gain > 0);
                let exact_gain = f64::from(scale) / 100.0 * 16.0 * 360.0 / 65536.0 * 16384.0;
                let error = f64::from(adjustment.gain.abs()) - exact_gain;
                assert!(error.abs() < 0.71, "{scale}");
                adjustment.set_direct(false);
                assert!(adjustment.gain < 0);
                adjustment.set_direct(true);
                assert!(adjustment.gain > 0 && adjustment.is_direct());
            }
        }
    }
}
