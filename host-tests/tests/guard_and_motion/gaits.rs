//! Tests that the core's gaits match the gaits in floating point and robot.toml, for every robot.

use lizard_core::numbers::gaits::Gait;
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::units::{CYCLE, Sweep};
use lizard_host_tests::{NamedRobot, paper_robot, robots};
use lizard_kinematics::End;
use lizard_robot::servo::{FORWARD_TURN_SIGN, LEG_NAMES, OPPOSITE_SERVO};
use lizard_robot::{CheckedGait, Robot, STEPS_PER_DEGREE, Waveform};

use crate::checked_robot::gait_id;
use crate::reference::is_safe;

/// Number of phases per cycle that the wave tables distinguish.
const PHASE_COUNT: u32 = 65_536;
/// A gait's pace at full speed, in units of 1/1024.
pub const FULL_PACE: u16 = 1024;
/// Documented maximum error of the wave tables, deg.
const TABLE_ERROR_DEG: f64 = 0.50;

/// Returns every gait of every robot, in floating point and in fixed point.
pub fn all_gaits() -> impl Iterator<Item = (&'static NamedRobot, &'static CheckedGait, Gait)> {
    robots().iter().flat_map(|named_robot| {
        let gaits = named_robot.robot.gaits().iter();
        gaits.map(move |gait| {
            (
                named_robot,
                gait,
                named_robot.robot.firmware().gait(gait_id(gait)),
            )
        })
    })
}

/// Returns the gait with this name in fixed point; `None` if the robot has no such gait.
fn core_gait(robot: &Robot, name: &str) -> Option<Gait> {
    let gait = robot.gait(name)?;
    Some(robot.firmware().gait(gait_id(gait)))
}

/// Returns all phases that the wave tables distinguish, in the core's units.
fn all_phases() -> impl Iterator<Item = u32> {
    (0..PHASE_COUNT).map(|n| n << 8)
}

/// Computes the servo angles at a phase of the core's gait, deg.
fn core_angles(robot: &Robot, gait: &Gait, phase: u32) -> [f64; 4] {
    let sweeps = gait.pose(robot.firmware().waves(), phase).0;
    let sweeps_deg = sweeps.map(|sweep| f64::from(sweep.0) / STEPS_PER_DEGREE);
    std::array::from_fn(|servo| robot.servos()[servo].neutral + sweeps_deg[servo])
}

/// Computes a leg's angle from neutral, deg, positive forward, at a fraction of a cycle of the core's gait.
fn leg_angle_deg(robot: &Robot, gait: &Gait, servo: usize, cycle_fraction: f64) -> f64 {
    let phase = (cycle_fraction * f64::from(CYCLE)) as u32;
    let pose = gait.pose(robot.firmware().waves(), phase);
    FORWARD_TURN_SIGN[servo] * f64::from(pose.0[servo].0) / STEPS_PER_DEGREE
}

/// Mirrors a pose: swaps left and right, and negates every sweep.
fn mirror(pose: Pose) -> Pose {
    Pose(OPPOSITE_SERVO.map(|servo| Sweep(-pose.0[servo].0)))
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
            let [pose, pose_with_low_bits] =
                [phase, phase | 0xff].map(|phase| gait.pose(robot.firmware().waves(), phase));
            assert_eq!(
                pose, pose_with_low_bits,
                "{name}: {gait_name} at {phase}: the low bits of the phase change the pose"
            );
            let angles = float_gait.angles(f64::from(phase) / f64::from(CYCLE));
            for (angle, core_angle) in angles.iter().zip(core_angles(robot, &gait, phase)) {
                let error_deg = (core_angle - angle).abs();
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
fn a_wave_leg_is_in_stance_for_its_duty_factor_and_swings_in_the_rest_of_the_cycle() {
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
            // The leg's angle at a fraction of the cycle after the stance starts.
            let angle_deg_after = |cycle_fraction: f64| {
                let cycle_fraction = (stride.start + cycle_fraction).rem_euclid(1.0);
                leg_angle_deg(robot, &gait, servo, cycle_fraction)
            };
            let leg_name = format!("{name}: {} {}", float_gait.name(), LEG_NAMES[servo]);
            // In stance, the leg moves back at constant speed, from an angle in front to the same angle behind. The
            // leg then swings forward.
            let front_angle_deg = angle_deg_after(0.0);
            let front_over_amplitude = front_angle_deg / stride.amplitude;
            assert!(
                (0.5..1.01).contains(&front_over_amplitude),
                "{leg_name} begins at {front_angle_deg} deg"
            );
            for (cycle_fraction, angle_fraction) in [
                (0.25 * duty, 0.5),
                (0.5 * duty, 0.0),
                (0.75 * duty, -0.5),
                (duty, -1.0),
                (0.5 * (1.0 + duty), 0.0),
            ] {
                let error_deg = angle_deg_after(cycle_fraction) - angle_fraction * front_angle_deg;
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
fn legs_with_a_held_waveform_swing_in_the_gaits_order() {
    let mut gait_count = 0;
    for (NamedRobot { name, robot }, float_gait, gait) in all_gaits() {
        let strides = float_gait.strides();
        let swing_indices = strides.iter().map(|stride| match stride.waveform {
            Waveform::Held { swing_index } => Some(swing_index),
            _ => None,
        });
        let Some(swing_indices) = swing_indices.collect::<Option<Vec<_>>>() else {
            continue;
        };
        gait_count += 1;
        for (servo, swing_index) in swing_indices.into_iter().enumerate() {
            let amplitude = strides[servo].amplitude;
            // The common stance takes the first fifth of the cycle. Then the legs swing, each in a fifth of the cycle.
            let swing_start = 0.2 * (1.0 + swing_index as f64);
            for (cycle_fraction, angle_fraction) in [
                (0.2, -1.0),
                (swing_start, -1.0),
                (swing_start + 0.2, 1.0),
                (1.0 - 1e-6, 1.0),
            ] {
                let cycle_fraction = cycle_fraction.min(1.0 - 1e-6);
                let angle_deg = leg_angle_deg(robot, &gait, servo, cycle_fraction);
                let error_deg = angle_deg - angle_fraction * amplitude;
                assert!(
                    error_deg.abs() <= TABLE_ERROR_DEG,
                    "{name}: {} at {cycle_fraction}: {error_deg} deg",
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
    let is_random = |named_robot: &&NamedRobot| named_robot.name.contains("random");
    for NamedRobot { name, robot } in robots().iter().filter(is_random) {
        for (gait_name, end, other_end) in [
            ("look", End::Head, End::Tail),
            ("wag", End::Tail, End::Head),
        ] {
            let Some(gait) = core_gait(robot, gait_name) else {
                continue;
            };
            path_count += 1;
            let solve = |pose| robot.lizard().solve(&pose).expect("the loops close");
            let neutral = solve(robot.neutral_pose());
            let displacement_at = |step: u32, end: End| {
                let solution = solve(core_angles(robot, &gait, step << 16).into());
                solution.end(end).end_point - neutral.end(end).end_point
            };
            let mut sum = [0.0; 2];
            for step in 0..256 {
                let displacement = displacement_at(step, end);
                sum[0] += displacement.x;
                sum[1] += displacement.y;
                assert!(
                    displacement_at(step, other_end).length() < 1e-9,
                    "{name}: {gait_name} moves the {other_end}"
                );
            }
            let shaft_distance_mm = robot.lizard().links.l10;
            let error_mm = sum[0].hypot(sum[1]) / 256.0;
            assert!(
                error_mm < 1e-3 * shaft_distance_mm,
                "{name}: {gait_name} is {error_mm} mm off its centre"
            );
        }
    }
    assert!(path_count > 10, "only {path_count} paths");
}

/// Returns two gaits in fixed point; `None` if the robot has only one of them or none.
fn core_gaits(robot: &Robot, names: [&str; 2]) -> Option<[Gait; 2]> {
    let [first, second] = names.map(|name| core_gait(robot, name));
    Some([first?, second?])
}

#[test]
fn a_reversed_gait_runs_backward_and_a_gait_reversed_twice_forward() {
    let mut pair_count = 0;
    for NamedRobot { name, robot } in robots() {
        for (names, sign) in [
            (["wander", "retreat"], -1),
            (["wander", "advance"], 1),
            (["walk", "back"], -1),
        ] {
            let Some([original, reversed]) = core_gaits(robot, names) else {
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
        for names in [
            ["creep-along", "other-hand"],
            ["left", "right"],
            ["arc-left", "arc-right"],
        ] {
            let Some([original, mirrored]) = core_gaits(robot, names) else {
                continue;
            };
            pair_count += 1;
            assert_eq!(original.increment, mirrored.increment, "{name}");
            for phase in all_phases() {
                let pose = mirror(original.pose(robot.firmware().waves(), phase));
                // Halves round up for either sign, and factors are rounded, so a mirrored sweep may differ by a step.
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
            let later_pose = pose_at((phase + CYCLE / 2) % CYCLE);
            assert_eq!(mirror(pose_at(phase)), later_pose, "{name}");
        }
    }
}

#[test]
fn the_head_of_the_papers_look_follows_its_figure_of_eight() {
    let gait = core_gait(paper_robot(), "look").expect("the paper's robot has this gait");
    for phase in all_phases().step_by(16) {
        let angles = core_angles(paper_robot(), &gait, phase);
        let solution = paper_robot().lizard().solve(&angles.into());
        let end_point = solution.expect("the loops close").head.end_point;
        let cycle_angle = std::f64::consts::TAU * f64::from(phase) / f64::from(CYCLE);
        let error_mm = (end_point.x - 10.0 * cycle_angle.sin())
            .hypot(end_point.y - 54.0 - 5.0 * (2.0 * cycle_angle).sin());
        assert!(error_mm < 0.1, "{error_mm} mm at {phase}");
    }
}
