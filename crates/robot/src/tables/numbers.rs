//! The robot's numbers as integers, in the types of the core.
//!
//! Sixteen bits can hold any robot's lengths if the step suits the robot's size, so each five-bar and each slider
//! has its own scale. Limits are rounded to the safe side: those of margins up, strokes and travels inward, the slew
//! limit down. All other numbers are rounded to the nearest integer.

use lizard_avr::Flash;
use lizard_core::numbers::calibration::Calibration;
use lizard_core::numbers::calibration::Reach;
use lizard_core::numbers::couplers::Couplers;
use lizard_core::numbers::gaits::SAMPLES;
use lizard_core::numbers::limits::Limits;
use lizard_core::numbers::section::{Content, Loop, Map};
use lizard_core::numbers::slew::Slew;
use lizard_core::numbers::slider::Slider;
use lizard_core::numbers::units::{Angle, Scale, Sine, Sweep, Width};
use lizard_kinematics as kinematics;

use crate::gaits::Routine;
use crate::measures::servo::Servo;
use crate::measures::{Measures, scale};
use crate::tables::table::Tables;
use crate::units::{CYCLES_PER_US, FRAMES_PER_SECOND, ONE_Q14, ONE_Q15, STEPS_PER_DEGREE};

/// Largest floating-point error of a number that would be an integer if computed exactly.
const SLACK: f64 = 1e-6;

/// Computes the numbers of a robot, without its maps of certified cells.
pub(crate) fn content(
    name: &str,
    measures: &Measures,
    tables: &Tables,
    routines: &[Routine],
) -> Content {
    let Measures {
        lizard,
        servos,
        limits,
        pace,
        supplies,
        ..
    } = measures;
    let pins = servos.map(|servo| servo.pin);
    let neutral =
        servos.map(|servo| Angle((servo.neutral * STEPS_PER_DEGREE).round() as u32 as u16));
    let calibrations = servos.map(|servo| calibration_of(&servo));
    let reach = reach_of(tables, &calibrations);
    let (mut gaits, mut names) = (tables.gaits.clone(), tables.names.clone());
    let mut steps = Vec::new();
    for routine in routines {
        gaits.push(routine.record(steps.len(), names.len()));
        steps.extend_from_slice(routine.steps());
        names.extend(routine.name().replace('-', " ").bytes());
    }
    Content {
        name: name.to_string(),
        servo_hash: servo_hash(&pins, &neutral, &calibrations),
        pins,
        rail: supplies.rail.map(|rail| rail.pin),
        slow_pace: supplies.slow_pace,
        neutral,
        calibration: calibrations,
        reach,
        limits: Limits {
            type2: to_sine(limits.type2),
            type1: to_sine(limits.type1),
            leg: to_sine(limits.leg),
        },
        slew: Slew::new(floor(pace.slew * STEPS_PER_DEGREE / FRAMES_PER_SECOND) as u16),
        supplies: supplies.numbers(),
        ends: kinematics::End::ALL.map(|end| convert_five_bar(&lizard.end(end))),
        sides: kinematics::Side::ALL
            .map(|name_of_side| convert_side(&lizard.side(name_of_side), limits)),
        gaits,
        steps,
        names,
        waves: tables.waves.clone(),
        maps: std::array::from_fn(|_| Map::default()),
    }
}

/// Computes the hash of the servos' numbers. A saved calibration carries this hash, so it is used only with the
/// servos for which it was made. Gaits, bars and limits do not change the hash.
fn servo_hash(pins: &[u8; 4], neutral: &[Angle; 4], calibration: &[Calibration; 4]) -> u32 {
    crc32fast::hash(format!("{pins:?} {neutral:?} {calibration:?}").as_bytes())
}

fn convert_five_bar(bars: &kinematics::FiveBar) -> Loop {
    let scale = scale::five_bar_scale(bars);
    let length_of = |mm: f64| to_steps(mm, scale) as i16;
    // The crank tips are farthest apart if both cranks point outward.
    let [base, left, right] = [bars.base, bars.crank_left, bars.crank_right].map(length_of);
    let furthest = (base as u32 + left as u32 + right as u32) / 2 + 2;
    let [a, b] = [bars.coupler_left, bars.coupler_right].map(length_of);
    Loop {
        scale,
        base,
        cranks: [left, right],
        couplers: [a, b],
        is_near_stretched: Couplers::is_near_stretched(a, b, furthest * furthest),
    }
}

fn calibration_of(servo: &Servo) -> Calibration {
    let (min, max) = servo.travel();
    let gain = servo.us_per_degree * CYCLES_PER_US / STEPS_PER_DEGREE * ONE_Q14;
    Calibration {
        neutral: Width((servo.neutral_us * CYCLES_PER_US).round() as u16),
        gain: gain.round() as i16,
        min: Sweep(ceil(min * STEPS_PER_DEGREE) as i16),
        max: Sweep(floor(max * STEPS_PER_DEGREE) as i16),
    }
}

/// Computes the range of each servo's sweep over all gaits, neutral included. Between two samples a gait is
/// interpolated linearly, so no phase exceeds the samples. The travel is rounded inward, so the rounded sweep of a
/// gait that uses the whole travel may exceed the travel by a step; so the range is limited to the travel.
fn reach_of(tables: &Tables, travel: &[Calibration; 4]) -> [Reach; 4] {
    let mut reach = [Reach::default(); 4];
    for gait in &tables.gaits {
        for (reach, channel) in reach.iter_mut().zip(&gait.channels) {
            let wave = Flash::from(&tables.waves[usize::from(channel.wave)]);
            for sample in 0..SAMPLES as u16 {
                // The phase at which the channel reads exactly this sample.
                let phase = (sample << 10).wrapping_sub(channel.offset);
                let sweep = channel.sweep(wave, phase);
                reach.min = reach.min.min(sweep);
                reach.max = reach.max.max(sweep);
            }
        }
    }
    for (reach, travel) in reach.iter_mut().zip(travel) {
        reach.min = reach.min.max(travel.min);
        reach.max = reach.max.min(travel.max);
    }
    reach
}

/// Converts the slider of a side to integers; its stroke is rounded inward.
fn convert_side(slider: &kinematics::Slider, limits: &kinematics::Limits) -> Slider {
    let scale = scale::side_scale(slider, limits.stroke_max);
    let length_of = |mm: f64| to_steps(mm, scale);
    let per_mm = scale::steps_per_mm(scale);
    Slider {
        scale,
        offset: length_of(slider.offset) as i16,
        base: length_of(slider.base) as u16,
        front: length_of(slider.front) as i16,
        rear: length_of(slider.rear) as i16,
        nominal: length_of(slider.nominal) as u16,
        min: ceil((slider.nominal + limits.stroke_min) * per_mm) as u16,
        max: floor((slider.nominal + limits.stroke_max) * per_mm) as u16,
    }
}

fn to_steps(mm: f64, scale: Scale) -> i32 {
    (mm * scale::steps_per_mm(scale)).round() as i32
}

/// Converts the limit of a margin to an integer, rounded up.
fn to_sine(margin: f64) -> Sine {
    Sine(ceil(margin * ONE_Q15) as i16)
}

fn ceil(value: f64) -> i64 {
    (value - SLACK).ceil() as i64
}

fn floor(value: f64) -> i64 {
    (value + SLACK).floor() as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{all, robot, with};
    use lizard_core::numbers::gaits::GaitId;
    use lizard_core::numbers::part::{End, Side};
    use lizard_core::numbers::section::{Header, Numbers};

    /// 256 steps per millimetre: the scale of every mechanism of the unequal robot.
    const PER_MM: f64 = 256.0;

    #[test]
    fn every_link_goes_where_it_belongs() {
        let robot = robot("unequal");
        let links = robot.lizard().links;
        let content = robot.content();
        let loops = [
            [links.l0, links.l1, links.l4, links.l2, links.l3],
            [links.l5, links.l6, links.l9, links.l7, links.l8],
        ];
        for (bars, mm) in content.ends.iter().zip(loops) {
            let ([left, right], [a, b]) = (bars.cranks, bars.couplers);
            let steps = [bars.base, left, right, a, b];
            assert_eq!(steps.map(f64::from), mm.map(|mm| mm * PER_MM));
            assert_eq!(bars.scale.bits, 8);
        }
        let offset = (links.l5 - links.l0) / 2.0;
        let sides = [
            [
                offset,
                links.l10,
                links.l14,
                links.l11,
                links.l12 + links.l13,
            ],
            [
                -offset,
                links.l15,
                links.l19,
                links.l16,
                links.l17 + links.l18,
            ],
        ];
        for (side, mm) in content.sides.iter().zip(sides) {
            let steps = [
                f64::from(side.offset),
                f64::from(side.base),
                f64::from(side.front),
                f64::from(side.rear),
                f64::from(side.nominal),
            ];
            assert_eq!(steps, mm.map(|mm| mm * PER_MM));
            assert_eq!(side.scale.bits, 8);
        }
        assert_eq!(content.pins, [6, 14, 19, 12]);
    }

    #[test]
    fn least_margins_are_rounded_up_each_its_own() {
        let limits = robot("unequal").firmware().limits();
        assert_eq!(
            [limits.type2, limits.type1, limits.leg],
            [10_486, 8_848, 12_452].map(Sine)
        );
        // An exact limit stays as it is.
        let exact_robot = with("unequal", &[("type2 = 0.32 ", "type2 = 0.25 ")]).expect("0.25");
        assert_eq!(exact_robot.firmware().limits().type2, Sine(8192));
    }

    #[test]
    fn strokes_are_rounded_inwards() {
        let changes = [
            ("stroke_min = -19.0", "stroke_min = -19.001"),
            ("stroke_max = 41.0", "stroke_max = 41.001"),
        ];
        let changed_robot = with("unequal", &changes).expect("a stroke");
        for side in [Side::Left, Side::Right] {
            let slider = changed_robot.firmware().side(side);
            let nominal = slider.nominal;
            assert_eq!(slider.min, nominal - 19 * 256, "{side:?}");
            assert_eq!(slider.max, nominal + 41 * 256, "{side:?}");
        }
    }

    #[test]
    fn a_travel_ends_at_the_last_step_within_the_servos_pulses() {
        for (name, robot) in all() {
            let calibrations = robot.firmware().calibration();
            for (servo, calibration) in robot.servos().iter().zip(calibrations) {
                let pulse_at = |sweep: i32| {
                    servo.neutral_us + servo.us_per_degree * f64::from(sweep) * 360.0 / 65536.0
                };
                let is_within = |sweep: i32| {
                    (servo.min_us - 1e-6..=servo.max_us + 1e-6).contains(&pulse_at(sweep))
                };
                let (min, max) = (i32::from(calibration.min.0), i32::from(calibration.max.0));
                assert!(
                    is_within(min) && !is_within(min - 1),
                    "{name} {servo:?} {min}"
                );
                assert!(
                    is_within(max) && !is_within(max + 1),
                    "{name} {servo:?} {max}"
                );
            }
        }
    }

    #[test]
    fn a_travel_of_whole_steps_keeps_its_last_one() {
        // 9.2 and 10.4 us are not exact in binary, so the quotient may be slightly too small.
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
                let calibration = calibration_of(&servo);
                let steps = 1024 * k as i16;
                assert_eq!([calibration.min.0, calibration.max.0], [-steps, steps]);
            }
        }
    }

    #[test]
    fn a_loop_is_near_stretched_beyond_three_quarters_of_its_reach() {
        // The threshold is three quarters of the squared reach of the couplers, so base plus cranks must exceed 0.866
        // of the sum of both couplers.
        for (bars, is_near) in [
            ([20.0, 30.0, 30.0], false),
            ([26.0, 30.0, 30.0], false),
            ([28.0, 30.0, 30.0], true),
            ([20.0, 38.0, 30.0], true),
            ([20.0, 30.0, 38.0], true),
        ] {
            let [base, crank_left, crank_right] = bars;
            let bars = kinematics::FiveBar {
                base,
                crank_left,
                coupler_left: 50.0,
                coupler_right: 50.0,
                crank_right,
            };
            assert_eq!(
                convert_five_bar(&bars).is_near_stretched,
                is_near,
                "{bars:?}"
            );
        }
    }

    #[test]
    fn every_servo_has_its_own_gain_and_neutral() {
        for (name, robot) in all() {
            let firmware = robot.firmware();
            for (i, servo) in robot.servos().iter().enumerate() {
                let calibration = firmware.calibration()[i];
                for sweep in
                    (i32::from(calibration.min.0)..i32::from(calibration.max.0)).step_by(97)
                {
                    let cycles = 16.0
                        * (servo.neutral_us
                            + servo.us_per_degree * f64::from(sweep) * 360.0 / 65536.0);
                    let width = calibration.width(Sweep(sweep as i16));
                    // Neutral, gain over the travel, and product: each has a rounding error of up to half a cycle.
                    let error = (f64::from(width.0) - cycles).abs();
                    assert!(error <= 1.5, "{name} A{}: {error} cycles at {sweep}", i + 1);
                }
                let neutral = f64::from(firmware.neutral()[i].0) * 360.0 / 65536.0;
                assert!((neutral - servo.neutral).abs() <= 0.5 * 360.0 / 65536.0);
            }
        }
    }

    #[test]
    fn the_reach_holds_every_phase_of_every_gait_and_is_reached() {
        for (name, robot) in all() {
            let firmware = robot.firmware();
            let mut widest_sweeps = [(0, 0); 4];
            for gait in GaitId::all(firmware.gait_count()) {
                let gait = firmware.gait(gait);
                for phase in (0..1 << 24).step_by(1 << 8) {
                    let pose = gait.pose(firmware.waves(), phase);
                    for (range, sweep) in widest_sweeps.iter_mut().zip(pose.0) {
                        *range = (range.0.min(sweep.0), range.1.max(sweep.0));
                    }
                }
            }
            let reach = lizard_core::numbers::part::Servo::ALL.map(|servo| {
                let reach = firmware.reach(servo);
                (reach.min.0, reach.max.0)
            });
            assert_eq!(reach, widest_sweeps, "{name}");
        }
    }

    #[test]
    fn the_slew_limit_is_rounded_down() {
        // 260 deg/s are 946.6 steps per frame.
        assert_eq!(robot("unequal").firmware().slew(), Slew::new(946));
        assert_eq!(robot("paper").firmware().slew(), Slew::new(1092));
    }

    #[test]
    fn the_slowest_robot_is_one_that_the_core_can_move() {
        let slow_robot = with("paper", &[("\nslew = 300.0", "\nslew = 10.0")]).expect("slow");
        assert!(slow_robot.firmware().slew().per_frame >= Slew::SLOWEST);
    }

    /// Reads the numbers of a robot's section.
    fn numbers_of(robot: &crate::Robot) -> Numbers {
        let section = robot.section();
        Flash::from(section.as_slice()).read(size_of::<Header>())
    }

    #[test]
    fn only_unequal_couplers_and_wide_cranks_have_further_tables() {
        for (name, robot) in all() {
            // The offset of each curve in the section; 0 if the section lacks the curve. Head and tail have equal
            // couplers and share their curves.
            let [head, tail] = numbers_of(&robot).curves;
            let [rise, stretched, folded, skew] = head;
            assert_ne!(rise, 0, "{name}");
            for curve in [folded, skew] {
                assert_eq!(curve != 0, name == "unequal", "{name}");
            }
            assert_eq!([rise, folded, skew], [tail[0], tail[2], tail[3]], "{name}");
            // Only the tail of the unequal robot has crank tips that can be so far apart.
            assert_eq!(
                [stretched != 0, tail[1] != 0],
                [false, name == "unequal"],
                "{name}"
            );
        }
    }

    #[test]
    fn a_larger_robot_has_a_coarser_step_where_its_lengths_need_one() {
        let (paper, large) = (robot("paper"), robot("large"));
        for end in [End::Head, End::Tail] {
            assert_eq!(paper.firmware().end(end).bars().scale().bits, 8);
            assert_eq!(large.firmware().end(end).bars().scale().bits, 8);
        }
        for side in [Side::Left, Side::Right] {
            let (paper_side, large_side) =
                (paper.firmware().side(side), large.firmware().side(side));
            assert_eq!(large_side.scale.bits, 7);
            assert_eq!(
                4 * u32::from(large_side.nominal),
                3 * u32::from(paper_side.nominal)
            );
        }
    }
}
