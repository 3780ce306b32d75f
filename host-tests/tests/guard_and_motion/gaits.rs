//! Tests that the core's gaits match the gaits in floating point and robot.toml, for every robot.

use lizard_core::numbers::gaits::{Gait, GaitId};
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::units::{CYCLE, Sweep};
use lizard_host_tests::{NamedRobot, paper_robot, robots};
use lizard_kinematics::End;
use lizard_robot::servo::{FORWARD_TURN_SIGN, LEG_NAMES, OPPOSITE_SERVO};
use lizard_robot::{CheckedGait, Robot, STEPS_PER_DEGREE, Waveform};

use crate::reference::is_safe;

/// Number of phases per cycle that the wave tables distinguish.
const PHASE_COUNT: u32 = 65_536;
/// A gait's pace at full speed, in units of 1/1024.
pub const FULL_PACE: u16 = 1024;
/// Documented maximum error of the wave tables, deg.
const TABLE_ERROR_DEG: f64 = 0.50;

/// Returns every gait of every robot, in floating point and in fixed point.
pub fn all_gaits() -> impl Iterator<Item = (&'static NamedRobot, &'static CheckedGait, Gait)> {
    robots().iter().flat_map(|named| {
        let ids = GaitId::all(named.robot.gaits().len());
        let gaits = named.robot.gaits().iter().zip(ids);
        gaits.map(move |(gait, id)| (named, gait, named.robot.firmware().gait(id)))
    })
}

/// Returns the gait with this name in fixed point; `None` if the robot has no such gait.
fn core_gait(robot: &Robot, name: &str) -> Option<Gait> {
    let index = robot.gait(name)?.index();
    let id = GaitId::all(robot.gaits().len()).nth(index)?;
    Some(robot.firmware().gait(id))
}

/// Returns all phases that the wave tables distinguish, in the core's units.
fn all_phases() -> impl Iterator<Item = u32> {
    (0..PHASE_COUNT).map(|phase| phase << 8)
}

/// Mirrors a pose: swaps left and right, and negates every sweep.
fn mirror(pose: Pose) -> Pose {
    Pose(OPPOSITE_SERVO.map(|servo| Sweep(-pose.0[servo].0)))
}

#[test]
fn the_core_has_the_files_gaits_in_the_same_order() {
    for NamedRobot { name, robot } in robots() {
        let firmware = robot.firmware();
        let names: Vec<String> = GaitId::all(firmware.gait_count())
            .map(|id| firmware.gait_name(id).map(char::from).collect())
            .collect();
        let expected: Vec<String> = robot.gaits().iter().map(CheckedGait::command).collect();
        assert_eq!(names, expected, "{name}");
    }
}

#[test]
fn the_tables_of_every_gait_are_accurate_and_safe_at_every_phase() {
    let mut max_error_deg = 0.0f64;
    for (gait_index, (NamedRobot { name, robot }, float_gait, gait)) in all_gaits().enumerate() {
        // Random robots are tested only at every 13th phase. The first phase depends on the gait.
        let (first_phase, step) = match name.contains("random") {
            true => (gait_index % 13, 13),
            false => (0, 1),
        };
        let gait_name = float_gait.name();
        for phase in all_phases().skip(first_phase).step_by(step) {
            let pose = gait.pose(robot.firmware().waves(), phase);
            let pose_with_low_bits = gait.pose(robot.firmware().waves(), phase | 0xff);
            assert_eq!(
                pose, pose_with_low_bits,
                "the low bits of the phase change the pose"
            );
            let angles = float_gait.angles(f64::from(phase) / f64::from(CYCLE));
            for (servo, angle) in angles.into_iter().enumerate() {
                let sweep_deg = f64::from(pose.0[servo].0) / STEPS_PER_DEGREE;
                let error_deg = (robot.servos()[servo].neutral + sweep_deg - angle).abs();
                max_error_deg = max_error_deg.max(error_deg);
                assert!(
                    error_deg <= TABLE_ERROR_DEG,
                    "{name}: {gait_name} at {phase}: {error_deg} deg"
                );
            }
            let is_safe = is_safe(robot.firmware(), &pose);
            assert!(is_safe, "{name}: {gait_name} at {phase}");
        }
    }
    println!("the largest table error is {max_error_deg:.4} deg");
}

#[test]
fn a_wave_leg_pushes_back_for_its_duty_factor_and_returns_in_the_remaining_cycle() {
    let mut leg_count = 0;
    for (NamedRobot { name, robot }, float_gait, gait) in all_gaits() {
        for (servo, stride) in float_gait.strides().iter().enumerate() {
            let Waveform::Wave { duty } = stride.waveform else {
                continue;
            };
            if stride.amplitude.abs() < 1.0 {
                continue;
            }
            leg_count += 1;
            // The leg's angle, positive forward, at a fraction of the cycle after the stroke starts.
            let leg_angle_deg = |cycle_fraction: f64| {
                let phase = (stride.start + cycle_fraction).rem_euclid(1.0) * f64::from(CYCLE);
                let pose = gait.pose(robot.firmware().waves(), phase as u32);
                FORWARD_TURN_SIGN[servo] * f64::from(pose.0[servo].0) / STEPS_PER_DEGREE
            };
            let leg_name = format!("{name}: {} {}", float_gait.name(), LEG_NAMES[servo]);
            // In a stroke, the leg moves back at constant speed, from an angle in front to the same angle behind. The
            // leg then returns.
            let front_angle_deg = leg_angle_deg(0.0);
            let fraction = front_angle_deg / stride.amplitude;
            assert!(
                (0.5..1.01).contains(&fraction),
                "{leg_name} begins at {front_angle_deg} deg"
            );
            let stroke_points = [(0.25, 0.5), (0.5, 0.0), (0.75, -0.5), (1.0, -1.0)];
            let stroke_points =
                stroke_points.map(|(duty_fraction, fraction)| (duty_fraction * duty, fraction));
            let return_point = (0.5 * (1.0 + duty), 0.0);
            for (cycle_fraction, fraction) in stroke_points.into_iter().chain([return_point]) {
                let error_deg = leg_angle_deg(cycle_fraction) - fraction * front_angle_deg;
                assert!(
                    error_deg.abs() <= 2.0 * TABLE_ERROR_DEG,
                    "{leg_name}: {error_deg} deg at {cycle_fraction}"
                );
            }
        }
    }
    assert!(leg_count > 40, "{leg_count} wave legs");
}

#[test]
fn the_legs_of_a_held_gait_return_in_the_gaits_order() {
    let mut gait_count = 0;
    for (NamedRobot { name, robot }, float_gait, gait) in all_gaits() {
        let swing_indices = float_gait
            .strides()
            .each_ref()
            .map(|stride| match stride.waveform {
                Waveform::Held { swing_index } => Some(swing_index),
                _ => None,
            });
        let [Some(a), Some(b), Some(c), Some(d)] = swing_indices else {
            continue;
        };
        gait_count += 1;
        for (servo, swing_index) in [a, b, c, d].into_iter().enumerate() {
            let amplitude = float_gait.strides()[servo].amplitude;
            let leg_angle_deg = |phase: f64| {
                let pose = gait.pose(robot.firmware().waves(), (phase * f64::from(CYCLE)) as u32);
                FORWARD_TURN_SIGN[servo] * f64::from(pose.0[servo].0) / STEPS_PER_DEGREE
            };
            // The common stroke takes the first fifth of the cycle. Then the legs return, each in a fifth of the cycle.
            let return_start = 0.2 * (1.0 + swing_index as f64);
            for (phase, fraction) in [
                (0.2, -1.0),
                (return_start, -1.0),
                (return_start + 0.2, 1.0),
                (1.0 - 1e-6, 1.0),
            ] {
                let error_deg = leg_angle_deg(phase.min(1.0 - 1e-6)) - fraction * amplitude;
                assert!(
                    error_deg.abs() <= TABLE_ERROR_DEG,
                    "{name}: {} at {phase}: {error_deg} deg",
                    float_gait.name()
                );
            }
        }
    }
    assert!(gait_count > 10, "only {gait_count} held gaits");
}

#[test]
fn a_path_moves_only_its_own_end_and_averages_to_its_centre() {
    // In the gaits `look` and `wag` of random robots, the path's centre is the end point's position in the neutral
    // pose.
    let mut path_count = 0;
    let is_random = |named: &&NamedRobot| named.name.contains("random");
    for NamedRobot { name, robot } in robots().iter().filter(is_random) {
        for (gait_name, end, other_end) in [
            ("look", End::Head, End::Tail),
            ("wag", End::Tail, End::Head),
        ] {
            let Some(float_gait) = robot.gait(gait_name) else {
                continue;
            };
            let gait = core_gait(robot, gait_name).expect("the core has the gait");
            path_count += 1;
            let end_point_at = |phase: u32, end: End| {
                let sweeps = gait.pose(robot.firmware().waves(), phase << 16).0;
                let angles: [f64; 4] = std::array::from_fn(|servo| {
                    float_gait.neutral()[servo] + f64::from(sweeps[servo].0) / STEPS_PER_DEGREE
                });
                let solution = robot.lizard().solve(&angles.into());
                solution.expect("the loops close").end(end).end_point
            };
            let neutral = robot.lizard().solve(&robot.neutral_pose());
            let neutral = neutral.expect("the loops close");
            let mut mean = [0.0; 2];
            for phase in 0..256 {
                let end_point = end_point_at(phase, end);
                mean[0] += end_point.x / 256.0;
                mean[1] += end_point.y / 256.0;
                let displacement =
                    end_point_at(phase, other_end) - neutral.end(other_end).end_point;
                assert!(
                    displacement.length() < 1e-9,
                    "{name}: {gait_name} moves the {other_end}"
                );
            }
            let centre = neutral.end(end).end_point;
            let length_mm = robot.lizard().links.l10;
            let error_mm = (mean[0] - centre.x).hypot(mean[1] - centre.y);
            assert!(
                error_mm < 1e-3 * length_mm,
                "{name}: {gait_name} is {error_mm} mm off its centre"
            );
        }
    }
    assert!(path_count > 10, "only {path_count} paths");
}

#[test]
fn a_reversed_gait_runs_backward_and_a_gait_reversed_twice_forward() {
    let mut pair_count = 0;
    for NamedRobot { name, robot } in robots() {
        for (original_name, reversed_name, sign) in [
            ("wander", "retreat", -1),
            ("wander", "advance", 1),
            ("walk", "back", -1),
        ] {
            let gaits = [original_name, reversed_name].map(|gait| core_gait(robot, gait));
            let [Some(original), Some(reversed)] = gaits else {
                continue;
            };
            pair_count += 1;
            assert!(original.increment > 0, "{name}");
            assert_eq!(reversed.increment, sign * original.increment, "{name}");
            for phase in all_phases().step_by(64) {
                let poses =
                    [&original, &reversed].map(|gait| gait.pose(robot.firmware().waves(), phase));
                assert_eq!(poses[0], poses[1], "{name}");
            }
        }
    }
    assert!(pair_count >= 16);
}

#[test]
fn a_mirrored_gait_matches_its_original_with_left_and_right_swapped() {
    let mut pair_count = 0;
    for NamedRobot { name, robot } in robots() {
        for (original_name, mirrored_name) in [
            ("creep-along", "other-hand"),
            ("left", "right"),
            ("arc-left", "arc-right"),
        ] {
            let gaits = [original_name, mirrored_name].map(|gait| core_gait(robot, gait));
            let [Some(original), Some(mirrored)] = gaits else {
                continue;
            };
            pair_count += 1;
            assert_eq!(original.increment, mirrored.increment, "{name}");
            for phase in all_phases() {
                let pose = mirror(original.pose(robot.firmware().waves(), phase));
                // Halves round up for either sign, and gains are rounded, so a mirrored sweep may differ by a step.
                let deviation = pose.max_turn_to(&mirrored.pose(robot.firmware().waves(), phase));
                assert!(deviation <= 1, "{name}: {deviation} steps");
            }
        }
    }
    assert!(pair_count >= 5);
}

#[test]
fn phase_wraparound_is_as_smooth_as_the_rest_of_the_cycle() {
    for (NamedRobot { name, robot }, float_gait, gait) in all_gaits() {
        let pose_at = |phase: u32| gait.pose(robot.firmware().waves(), phase % CYCLE);
        // The largest turn of a servo from one phase to the next. After the last phase, the next phase is 0.
        let turn_from = |phase: u32| pose_at(phase).max_turn_to(&pose_at(phase + (1 << 8)));
        let largest_turn = all_phases().step_by(7).map(turn_from).max();
        let last_phases = all_phases().skip(PHASE_COUNT as usize - 4);
        let largest_turn_at_wrap = last_phases.map(turn_from).max();
        let is_smooth = largest_turn_at_wrap <= largest_turn.map(|turn| turn + 1);
        assert!(is_smooth, "{name}: {}", float_gait.name());
    }
}

#[test]
fn the_papers_symmetric_gaits_equal_their_mirror_half_a_cycle_later() {
    for name in ["walk", "trot"] {
        let gait = core_gait(paper_robot(), name).expect("the paper's robot has this gait");
        let pose_at = |phase: u32| gait.pose(paper_robot().firmware().waves(), phase);
        for phase in all_phases() {
            let opposite_pose = pose_at((phase + CYCLE / 2) % CYCLE);
            assert_eq!(mirror(pose_at(phase)), opposite_pose, "{name}");
        }
    }
}

#[test]
fn the_head_of_the_papers_look_follows_its_figure_of_eight() {
    let gait = core_gait(paper_robot(), "look").expect("the paper's robot has this gait");
    let neutral_angles = paper_robot().servos().map(|servo| servo.neutral);
    for phase in (0..PHASE_COUNT).step_by(16) {
        let sweeps = gait.pose(paper_robot().firmware().waves(), phase << 8).0;
        let angles: [f64; 4] =
            std::array::from_fn(|n| neutral_angles[n] + f64::from(sweeps[n].0) / STEPS_PER_DEGREE);
        let solution = paper_robot().lizard().solve(&angles.into());
        let end_point = solution.expect("the loops close").head.end_point;
        let cycle_angle = std::f64::consts::TAU * f64::from(phase) / f64::from(PHASE_COUNT);
        let error_mm = (end_point.x - 10.0 * cycle_angle.sin())
            .hypot(end_point.y - 54.0 - 5.0 * (2.0 * cycle_angle).sin());
        assert!(error_mm < 0.1, "{error_mm} mm at {phase}");
    }
}
