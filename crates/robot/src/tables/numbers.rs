//! The robot's numbers as integers, in the core's types.
//!
//! Sixteen bits are enough for any robot's lengths if the step suits the robot's size, so each five-bar and each slider
//! has its own scale. Limits are rounded to the safe side: margin limits up, strokes and travels inward, and the slew
//! limit down. All other numbers are rounded to the nearest integer.

use lizard_avr::Flash;
use lizard_core::numbers::calibration::{Calibration, SweepRange};
use lizard_core::numbers::couplers::Couplers;
use lizard_core::numbers::gaits::SAMPLES_PER_WAVE;
use lizard_core::numbers::limits::Limits;
use lizard_core::numbers::section::{Content, FiveBarLengths, Map};
use lizard_core::numbers::slew::Slew;
use lizard_core::numbers::slider::Slider;
use lizard_core::numbers::units::{Angle, PulseWidth, Scale, Sine, Sweep};
use lizard_kinematics as kinematics;

use crate::config::servo::Servo;
use crate::config::{RobotConfig, scale};
use crate::gaits::Routine;
use crate::tables::table::Tables;
use crate::units::{CYCLES_PER_US, FRAMES_PER_SECOND, ONE_Q14, ONE_Q15, STEPS_PER_DEGREE};

/// Allowance for the floating-point error of a number that would be an integer if computed exactly.
const ROUNDING_ALLOWANCE: f64 = 1e-6;

/// Computes the content of a robot's section, without the maps of certified cells.
pub(crate) fn build_content(
    name: &str,
    config: &RobotConfig,
    tables: &Tables,
    routines: &[Routine],
) -> Content {
    let RobotConfig {
        lizard,
        servos,
        limits,
        speed_limits,
        supplies,
        ..
    } = config;
    let pins = servos.map(|servo| servo.pin);
    let neutral_angles =
        servos.map(|servo| Angle((servo.neutral * STEPS_PER_DEGREE).round() as u32 as u16));
    let calibrations = servos.map(|servo| convert_calibration(&servo));
    let needed_travels = find_needed_travels(tables, &calibrations);
    let (mut gaits, mut names) = (tables.gaits.clone(), tables.names.clone());
    let mut steps = Vec::new();
    for routine in routines {
        gaits.push(routine.to_record(steps.len(), names.len()));
        steps.extend_from_slice(routine.step_records());
        names.extend(routine.command().bytes());
    }
    Content {
        name: name.to_string(),
        servo_hash: compute_servo_hash(&pins, &neutral_angles, &calibrations),
        pins,
        rail_pin: supplies.rail.map(|rail| rail.pin),
        slow_pace: supplies.slow_pace_percent,
        neutral_angles,
        calibration: calibrations,
        needed_travel: needed_travels,
        limits: Limits {
            type2: to_sine(limits.type2),
            type1: to_sine(limits.type1),
            leg: to_sine(limits.leg),
        },
        slew: Slew::new(floor_with_allowance(
            speed_limits.slew * STEPS_PER_DEGREE / FRAMES_PER_SECOND,
        ) as u16),
        supplies: supplies.to_core(),
        ends: kinematics::End::ALL.map(|end| convert_five_bar(&lizard.end(end))),
        sliders: kinematics::Side::ALL.map(|side| convert_slider(&lizard.side(side), limits)),
        gaits,
        steps,
        names,
        waves: tables.waves.clone(),
        maps: std::array::from_fn(|_| Map::default()),
    }
}

/// Computes the hash of the servos' numbers. A saved calibration contains this hash, so that the firmware uses it only
/// with the servos for which it was made. Link lengths, gaits and the table `[limits]` do not change the hash.
fn compute_servo_hash(
    pins: &[u8; 4],
    neutral_angles: &[Angle; 4],
    calibrations: &[Calibration; 4],
) -> u32 {
    // Boards store this hash, so the text must not change, even if the fields are renamed.
    let angles = neutral_angles
        .map(|angle| format!("Angle({})", angle.0))
        .join(", ");
    let servos = calibrations.each_ref().map(|servo| {
        let neutral = servo.neutral_width.0;
        let [min, max] = [servo.travel_min.0, servo.travel_max.0];
        let gain = servo.gain;
        format!("Calibration {{ neutral: Width({neutral}), gain: {gain}, min: Sweep({min}), max: Sweep({max}) }}")
    });
    crc32fast::hash(format!("{pins:?} [{angles}] [{}]", servos.join(", ")).as_bytes())
}

/// Converts the lengths of a five-bar to integers.
fn convert_five_bar(five_bar: &kinematics::FiveBar) -> FiveBarLengths {
    let scale = scale::find_five_bar_scale(five_bar);
    let to_length = |mm: f64| to_steps(mm, scale) as i16;
    // The crank tips are farthest apart if both cranks point outward. The core expects the squared distance in units of
    // four squared steps, so half the distance is squared. Two steps cover the rounding.
    let [base, left, right] = [
        five_bar.base,
        five_bar.left_crank_length,
        five_bar.right_crank_length,
    ]
    .map(to_length);
    let max_half_tip_distance = (base as u32 + left as u32 + right as u32) / 2 + 2;
    let [left_coupler, right_coupler] =
        [five_bar.left_coupler_length, five_bar.right_coupler_length].map(to_length);
    FiveBarLengths {
        scale,
        base,
        cranks: [left, right],
        couplers: [left_coupler, right_coupler],
        can_nearly_stretch: Couplers::is_near_stretched(
            left_coupler,
            right_coupler,
            max_half_tip_distance * max_half_tip_distance,
        ),
    }
}

/// Converts a servo's pulse widths, gain and travel to integers; its travel is rounded inward.
fn convert_calibration(servo: &Servo) -> Calibration {
    let (min, max) = servo.travel();
    let gain = servo.us_per_degree * CYCLES_PER_US / STEPS_PER_DEGREE * ONE_Q14;
    Calibration {
        neutral_width: PulseWidth((servo.neutral_us * CYCLES_PER_US).round() as u16),
        gain: gain.round() as i16,
        travel_min: Sweep(ceil_with_allowance(min * STEPS_PER_DEGREE) as i16),
        travel_max: Sweep(floor_with_allowance(max * STEPS_PER_DEGREE) as i16),
    }
}

/// Finds the range of each servo's sweep over all gaits, neutral included. Gaits are interpolated linearly between
/// samples, so no phase exceeds the samples. The travel is rounded inward, so a gait that uses the whole travel may
/// exceed the rounded travel by a step; the range is therefore limited to the travel.
fn find_needed_travels(tables: &Tables, calibrations: &[Calibration; 4]) -> [SweepRange; 4] {
    let mut needed_travels = [SweepRange::default(); 4];
    for gait in &tables.gaits {
        for (needed, channel) in needed_travels.iter_mut().zip(&gait.channels) {
            let wave = Flash::from(&tables.waves[usize::from(channel.wave)]);
            for sample in 0..SAMPLES_PER_WAVE as u16 {
                // The phase at which the channel reads exactly this sample.
                let phase = (sample << 10).wrapping_sub(channel.offset);
                let sweep = channel.sweep(wave, phase);
                needed.min = needed.min.min(sweep);
                needed.max = needed.max.max(sweep);
            }
        }
    }
    for (needed, calibration) in needed_travels.iter_mut().zip(calibrations) {
        needed.min = needed.min.max(calibration.travel_min);
        needed.max = needed.max.min(calibration.travel_max);
    }
    needed_travels
}

/// Converts the slider of a side to integers; its stroke is rounded inward.
fn convert_slider(slider: &kinematics::Slider, limits: &kinematics::Limits) -> Slider {
    let scale = scale::find_slider_scale(slider, limits.stroke_max);
    let to_length = |mm: f64| to_steps(mm, scale);
    let steps_per_mm = scale::steps_per_mm(scale);
    Slider {
        scale,
        offset: to_length(slider.front_offset) as i16,
        base: to_length(slider.base) as u16,
        front_arm: to_length(slider.front_arm) as i16,
        rear_arm: to_length(slider.rear_arm) as i16,
        nominal_length: to_length(slider.nominal_length) as u16,
        stroke_min: ceil_with_allowance((slider.nominal_length + limits.stroke_min) * steps_per_mm)
            as u16,
        stroke_max: floor_with_allowance((slider.nominal_length + limits.stroke_max) * steps_per_mm)
            as u16,
    }
}

/// Converts a length to steps, rounded to the nearest step.
fn to_steps(mm: f64, scale: Scale) -> i32 {
    (mm * scale::steps_per_mm(scale)).round() as i32
}

/// Converts a margin's limit to an integer, rounded up.
fn to_sine(limit: f64) -> Sine {
    Sine(ceil_with_allowance(limit * ONE_Q15) as i16)
}

/// Rounds up, except for a value that exceeds an integer only by a rounding error.
fn ceil_with_allowance(value: f64) -> i64 {
    (value - ROUNDING_ALLOWANCE).ceil() as i64
}

/// Rounds down, except for a value that is below an integer only by a rounding error.
fn floor_with_allowance(value: f64) -> i64 {
    (value + ROUNDING_ALLOWANCE).floor() as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Robot;
    use crate::testing::{all_robots, robot, valid_robot_with};
    use lizard_core::numbers::gaits::GaitId;
    use lizard_core::numbers::part::{End, Side};
    use lizard_core::numbers::section::{Header, Numbers};

    /// 256 steps per millimetre: the scale of every mechanism of the unequal robot.
    const STEPS_PER_MM: f64 = 256.0;

    #[test]
    fn every_length_is_converted_to_its_own_field() {
        let robot = robot("unequal");
        let links = robot.lizard().links;
        let content = robot.content();
        let five_bars = [
            [links.l0, links.l1, links.l4, links.l2, links.l3],
            [links.l5, links.l6, links.l9, links.l7, links.l8],
        ];
        for (lengths, mm) in content.ends.iter().zip(five_bars) {
            let ([left, right], [a, b]) = (lengths.cranks, lengths.couplers);
            let steps = [lengths.base, left, right, a, b];
            assert_eq!(steps.map(f64::from), mm.map(|mm| mm * STEPS_PER_MM));
            assert_eq!(lengths.scale.bits, 8);
        }
        let offset = (links.l5 - links.l0) / 2.0;
        let [left_length, right_length] = [links.l12 + links.l13, links.l17 + links.l18];
        let sides = [
            [offset, links.l10, links.l14, links.l11, left_length],
            [-offset, links.l15, links.l19, links.l16, right_length],
        ];
        for (side, mm) in content.sliders.iter().zip(sides) {
            let [base, nominal_length] = [side.base, side.nominal_length].map(i32::from);
            let [offset, front, rear] = [side.offset, side.front_arm, side.rear_arm].map(i32::from);
            let steps = [offset, base, front, rear, nominal_length];
            assert_eq!(steps.map(f64::from), mm.map(|mm| mm * STEPS_PER_MM));
            assert_eq!(side.scale.bits, 8);
        }
        assert_eq!(content.pins, [6, 14, 19, 12]);
    }

    #[test]
    fn each_margin_limit_is_rounded_up() {
        let limits = robot("unequal").firmware().limits();
        let numbers = [limits.type2, limits.type1, limits.leg];
        assert_eq!(numbers, [10_486, 8_848, 12_452].map(Sine));
        // An exact limit stays as it is.
        let exact_robot = valid_robot_with("unequal", &[("type2 = 0.32 ", "type2 = 0.25 ")]);
        assert_eq!(exact_robot.firmware().limits().type2, Sine(8192));
    }

    #[test]
    fn strokes_are_rounded_inward() {
        let changes = [
            ("stroke_min = -19.0", "stroke_min = -19.001"),
            ("stroke_max = 41.0", "stroke_max = 41.001"),
        ];
        let changed_robot = valid_robot_with("unequal", &changes);
        for side in [Side::Left, Side::Right] {
            let slider = changed_robot.firmware().slider(side);
            let nominal = slider.nominal_length;
            assert_eq!(slider.stroke_min, nominal - 19 * 256, "{side:?}");
            assert_eq!(slider.stroke_max, nominal + 41 * 256, "{side:?}");
        }
    }

    /// Computes the pulse width of a servo at a sweep in angle steps, us.
    fn pulse_at(servo: &Servo, sweep: i32) -> f64 {
        servo.neutral_us + servo.us_per_degree * f64::from(sweep) * 360.0 / 65536.0
    }

    #[test]
    fn a_travel_ends_at_the_last_step_within_the_servos_pulses() {
        for (name, robot) in all_robots() {
            let calibrations = robot.firmware().calibration();
            for (servo, calibration) in robot.servos().iter().zip(calibrations) {
                let allowed = servo.min_us - 1e-6..=servo.max_us + 1e-6;
                let is_within = |sweep: i32| allowed.contains(&pulse_at(servo, sweep));
                let [min, max] = [calibration.travel_min, calibration.travel_max];
                for (end, outward_step) in [(min, -1), (max, 1)] {
                    let end = i32::from(end.0);
                    let is_last = is_within(end) && !is_within(end + outward_step);
                    assert!(is_last, "{name} {servo:?} {end}");
                }
            }
        }
    }

    #[test]
    fn a_travel_of_a_whole_number_of_steps_keeps_its_last_step() {
        // Only 8.5 is exact in binary; with the other values, the quotient may be slightly too small.
        for us_per_degree in [7.3, -7.3, 8.5, 9.2, -10.4, 11.1] {
            for k in 1..=13 {
                let half_width_us = f64::abs(us_per_degree) * 5.625 * f64::from(k);
                let servo = Servo {
                    pin: 9,
                    neutral: 135.0,
                    neutral_us: 1500.0,
                    us_per_degree,
                    min_us: 1500.0 - half_width_us,
                    max_us: 1500.0 + half_width_us,
                };
                let calibration = convert_calibration(&servo);
                let (min, max) = (calibration.travel_min, calibration.travel_max);
                let steps = 1024 * k as i16;
                assert_eq!([min.0, max.0], [-steps, steps]);
            }
        }
    }

    #[test]
    fn a_five_bar_can_nearly_stretch_beyond_three_quarters_of_its_squared_reach() {
        // The threshold is three quarters of the couplers' squared reach, so base plus cranks must exceed 0.866 of the
        // couplers' sum.
        for (base_and_cranks, expected) in [
            ([20.0, 30.0, 30.0], false),
            ([26.0, 30.0, 30.0], false),
            ([28.0, 30.0, 30.0], true),
            ([20.0, 38.0, 30.0], true),
            ([20.0, 30.0, 38.0], true),
        ] {
            let [base, left, right] = base_and_cranks;
            let five_bar = kinematics::FiveBar::new([base, left, 50.0, 50.0, right]);
            let can_nearly_stretch = convert_five_bar(&five_bar).can_nearly_stretch;
            assert_eq!(can_nearly_stretch, expected, "{five_bar:?}");
        }
    }

    #[test]
    fn every_servo_has_its_own_gain_and_neutral() {
        for (name, robot) in all_robots() {
            let firmware = robot.firmware();
            for (i, servo) in robot.servos().iter().enumerate() {
                let calibration = firmware.calibration()[i];
                let (min, max) = (calibration.travel_min, calibration.travel_max);
                for sweep in (i32::from(min.0)..i32::from(max.0)).step_by(97) {
                    let cycles = 16.0 * pulse_at(servo, sweep);
                    let width = calibration.width(Sweep(sweep as i16));
                    // Neutral, gain over the travel, and product: each has a rounding error of up to half a cycle.
                    let error = (f64::from(width.0) - cycles).abs();
                    assert!(error <= 1.5, "{name} A{}: {error} cycles at {sweep}", i + 1);
                }
                let neutral = f64::from(firmware.neutral_angles()[i].0) * 360.0 / 65536.0;
                assert!((neutral - servo.neutral).abs() <= 0.5 * 360.0 / 65536.0);
            }
        }
    }

    #[test]
    fn the_needed_travel_spans_the_sweeps_of_all_gaits() {
        for (name, robot) in all_robots() {
            let firmware = robot.firmware();
            let mut sweep_ranges = [(0, 0); 4];
            for gait in GaitId::all(firmware.gait_count()) {
                let gait = firmware.gait(gait);
                for phase in (0..1 << 24).step_by(1 << 8) {
                    let pose = gait.pose(firmware.waves(), phase);
                    for ((min, max), sweep) in sweep_ranges.iter_mut().zip(pose.0) {
                        (*min, *max) = ((*min).min(sweep.0), (*max).max(sweep.0));
                    }
                }
            }
            let needed_travels = lizard_core::numbers::part::Servo::ALL.map(|servo| {
                let travel = firmware.needed_travel(servo);
                (travel.min.0, travel.max.0)
            });
            assert_eq!(needed_travels, sweep_ranges, "{name}");
        }
    }

    #[test]
    fn the_slew_limit_is_rounded_down() {
        // 260 deg/s are 946.6 steps per frame.
        assert_eq!(robot("unequal").firmware().slew(), Slew::new(946));
        assert_eq!(robot("paper").firmware().slew(), Slew::new(1092));
    }

    #[test]
    fn the_core_can_move_the_slowest_robot() {
        let slow_robot = valid_robot_with("paper", &[("\nslew = 300.0", "\nslew = 10.0")]);
        assert!(slow_robot.firmware().slew().per_frame >= Slew::MIN_PER_FRAME);
    }

    /// Reads the numbers of a robot's section.
    fn read_numbers(robot: &Robot) -> Numbers {
        let section = robot.section();
        Flash::from(section.as_slice()).read(size_of::<Header>())
    }

    #[test]
    fn only_unequal_couplers_and_wide_cranks_have_additional_curves() {
        for (name, robot) in all_robots() {
            // The offset of each curve in the section; 0 if the curve is missing. Head and tail share the curves that
            // depend only on the couplers, because their couplers are equal.
            let [head, tail] = read_numbers(&robot).curves;
            let [rise, stretched, folded, skew] = head;
            assert_ne!(rise, 0, "{name}");
            for curve in [folded, skew] {
                assert_eq!(curve != 0, name == "unequal", "{name}");
            }
            assert_eq!([rise, folded, skew], [tail[0], tail[2], tail[3]], "{name}");
            // Only the tail of the unequal robot has crank tips that can be so far apart.
            assert_eq!(stretched, 0, "{name}");
            assert_eq!(tail[1] != 0, name == "unequal", "{name}");
        }
    }

    #[test]
    fn a_larger_robot_has_a_coarser_step_only_where_needed() {
        let (paper, large) = (robot("paper"), robot("large"));
        for end in [End::Head, End::Tail] {
            assert_eq!(paper.firmware().link_lengths(end).scale().bits, 8);
            assert_eq!(large.firmware().link_lengths(end).scale().bits, 8);
        }
        for side in [Side::Left, Side::Right] {
            assert_eq!(large.firmware().slider(side).scale.bits, 7);
            let nominal_steps =
                |robot: &Robot| u32::from(robot.firmware().slider(side).nominal_length);
            assert_eq!(4 * nominal_steps(&large), 3 * nominal_steps(&paper));
        }
    }
}
