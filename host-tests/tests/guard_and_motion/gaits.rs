//! Tests of the gaits of every robot in the core, compared with the gaits in floating
//! point and with their description in robot.toml.

use lizard_core::numbers::gaits::{Gait, GaitId};
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::units::{CYCLE, Sweep};
use lizard_host_tests::{Named, paper, robots};
use lizard_kinematics::End;
use lizard_robot::servo::{FORWARD_TURN_SIGN, LEG_NAMES, OPPOSITE_SERVO};
use lizard_robot::{CheckedGait, Robot, STEPS_PER_DEGREE, Waveform};

use crate::frames::gait_command;
use crate::truth::is_safe;

/// Number of phases in a cycle that the wave tables distinguish.
const PHASES: u32 = 65_536;
/// The pace of a gait at full speed, in 1/1024.
pub const FULL_PACE: u16 = 1024;
/// Largest error of the wave tables that the project promises, deg.
const TABLE_ERROR_DEG: f64 = 0.50;

/// Returns every gait of every robot, in floating point and as the core has it.
pub fn gaits() -> impl Iterator<Item = (&'static Named, &'static CheckedGait, Gait)> {
    robots().iter().flat_map(|named| {
        let ids = GaitId::all(named.robot.gaits().len());
        let gaits = named.robot.gaits().iter().zip(ids);
        gaits.map(move |(gait, id)| (named, gait, named.robot.firmware().gait(id)))
    })
}

/// Returns the gait of this name as the core has it; `None` if the robot has no such gait.
fn gait_named(robot: &Robot, name: &str) -> Option<Gait> {
    let index = robot.gait(name)?.index();
    let id = GaitId::all(robot.gaits().len()).nth(index)?;
    Some(robot.firmware().gait(id))
}

/// Returns one phase of the core for each of [`PHASES`].
fn phases() -> impl Iterator<Item = u32> {
    (0..PHASES).map(|phase| phase << 8)
}

/// Returns the mirrored pose: left and right exchanged, every sweep negated.
fn mirror(pose: Pose) -> Pose {
    Pose(OPPOSITE_SERVO.map(|servo| Sweep(-pose.0[servo].0)))
}

#[test]
fn the_core_has_the_gaits_of_the_file_in_its_order() {
    for Named { name, robot } in robots() {
        let firmware = robot.firmware();
        let names: Vec<String> = GaitId::all(firmware.gait_count())
            .map(|id| firmware.gait_name(id).map(char::from).collect())
            .collect();
        let expected: Vec<String> = robot.gaits().iter().map(gait_command).collect();
        assert_eq!(names, expected, "{name}");
    }
}

#[test]
fn tables_are_within_the_promised_error_of_every_gait_and_safe_at_every_phase() {
    let mut worst_error = 0.0f64;
    for (n, (Named { name, robot }, float_gait, gait)) in gaits().enumerate() {
        // Of random robots only every 13th phase is tested, with another first phase for each gait.
        let (first_phase, step) = if name.contains("random") {
            (n % 13, 13)
        } else {
            (0, 1)
        };
        for phase in phases().skip(first_phase).step_by(step) {
            let pose = gait.pose(robot.firmware().waves(), phase);
            let pose_between = gait.pose(robot.firmware().waves(), phase | 0xff);
            assert_eq!(
                pose, pose_between,
                "bits that the tables do not see make no difference"
            );
            let angles = float_gait.angles(f64::from(phase) / f64::from(CYCLE));
            for (servo, angle) in angles.into_iter().enumerate() {
                let sweep = f64::from(pose.0[servo].0) / STEPS_PER_DEGREE;
                let error = (robot.servos()[servo].neutral + sweep - angle).abs();
                worst_error = worst_error.max(error);
                assert!(
                    error <= TABLE_ERROR_DEG,
                    "{name}: {} at {phase}: {error} deg",
                    float_gait.name()
                );
            }
            assert!(
                is_safe(robot.firmware(), &pose),
                "{name}: {} at {phase}",
                float_gait.name()
            );
        }
    }
    println!("tables are off by at most {worst_error:.4} deg");
}

#[test]
fn a_leg_of_a_wave_pushes_back_for_its_duty_and_returns_in_the_rest() {
    let mut leg_count = 0;
    for (Named { name, robot }, float_gait, gait) in gaits() {
        for (servo, stride) in float_gait.strides().iter().enumerate() {
            let Waveform::Wave { duty } = stride.waveform else {
                continue;
            };
            if stride.amplitude.abs() < 1.0 {
                continue;
            }
            leg_count += 1;
            // Returns the leg's angle, forward positive, at a share of the cycle after the stroke's start.
            let foot_angle = |cycle_share: f64| {
                let phase = (stride.start + cycle_share).rem_euclid(1.0) * f64::from(CYCLE);
                let pose = gait.pose(robot.firmware().waves(), phase as u32);
                FORWARD_TURN_SIGN[servo] * f64::from(pose.0[servo].0) / STEPS_PER_DEGREE
            };
            let leg_name = format!("{name}: {} {}", float_gait.name(), LEG_NAMES[servo]);
            // A stroke starts in front, moves at constant speed to the same angle behind, and returns.
            let front_angle = foot_angle(0.0);
            let share = front_angle / stride.amplitude;
            assert!(
                (0.5..1.01).contains(&share),
                "{leg_name} begins at {front_angle} deg"
            );
            let course = [(0.25, 0.5), (0.5, 0.0), (0.75, -0.5), (1.0, -1.0)];
            let course = course.map(|(duty_share, share)| (duty_share * duty, share));
            for (cycle_share, share) in course.into_iter().chain([(0.5 * (1.0 + duty), 0.0)]) {
                let error = foot_angle(cycle_share) - share * front_angle;
                assert!(
                    error.abs() <= 2.0 * TABLE_ERROR_DEG,
                    "{leg_name}: {error} deg at {cycle_share}"
                );
            }
        }
    }
    assert!(leg_count > 40, "{leg_count} legs of waves");
}

#[test]
fn the_legs_of_a_held_gait_return_one_after_another_in_its_order() {
    let mut gaits_seen = 0;
    for (Named { name, robot }, float_gait, gait) in gaits() {
        let turns = float_gait
            .strides()
            .each_ref()
            .map(|stride| match stride.waveform {
                Waveform::Held { swing_index: turn } => Some(turn),
                _ => None,
            });
        let [Some(a), Some(b), Some(c), Some(d)] = turns else {
            continue;
        };
        gaits_seen += 1;
        for (servo, turn) in [a, b, c, d].into_iter().enumerate() {
            let amplitude = float_gait.strides()[servo].amplitude;
            let foot_angle = |phase: f64| {
                let pose = gait.pose(robot.firmware().waves(), (phase * f64::from(CYCLE)) as u32);
                FORWARD_TURN_SIGN[servo] * f64::from(pose.0[servo].0) / STEPS_PER_DEGREE
            };
            // The common stroke takes a fifth of the cycle, then the return of each leg takes a fifth.
            let start = 0.2 * (1.0 + turn as f64);
            for (phase, share) in [
                (0.2, -1.0),
                (start, -1.0),
                (start + 0.2, 1.0),
                (1.0 - 1e-6, 1.0),
            ] {
                let error = foot_angle(phase.min(1.0 - 1e-6)) - share * amplitude;
                assert!(
                    error.abs() <= TABLE_ERROR_DEG,
                    "{name}: {} at {phase}: {error} deg",
                    float_gait.name()
                );
            }
        }
    }
    assert!(gaits_seen > 10, "{gaits_seen}");
}

#[test]
fn a_path_moves_only_its_own_end_around_its_centre() {
    // In the gaits of random robots, the paths of `look` and `wag` are centred on the end point's neutral position.
    let mut path_count = 0;
    for Named { name, robot } in robots()
        .iter()
        .filter(|named| named.name.contains("random"))
    {
        for (gait_name, end, other_end) in [
            ("look", End::Head, End::Tail),
            ("wag", End::Tail, End::Head),
        ] {
            let Some(float_gait) = robot.gait(gait_name) else {
                continue;
            };
            let core_gait = gait_named(robot, gait_name).expect("it is there");
            path_count += 1;
            let end_point_of = |phase: u32, end: End| {
                let sweeps = core_gait.pose(robot.firmware().waves(), phase << 16).0;
                let angles: [f64; 4] = std::array::from_fn(|servo| {
                    float_gait.neutral()[servo] + f64::from(sweeps[servo].0) / STEPS_PER_DEGREE
                });
                robot
                    .lizard()
                    .solve(&angles.into())
                    .expect("it closes")
                    .end(end)
                    .end_point
            };
            let neutral = robot
                .lizard()
                .solve(&robot.neutral_pose())
                .expect("it stands");
            let mut mean = [0.0; 2];
            for phase in 0..256 {
                let point_here = end_point_of(phase, end);
                mean[0] += point_here.x / 256.0;
                mean[1] += point_here.y / 256.0;
                let displacement =
                    end_point_of(phase, other_end) - neutral.end(other_end).end_point;
                assert!(
                    displacement.length() < 1e-9,
                    "{name}: {gait_name} moves the {other_end}"
                );
            }
            let centre = neutral.end(end).end_point;
            let length_mm = robot.lizard().links.l10;
            let error = (mean[0] - centre.x).hypot(mean[1] - centre.y);
            assert!(
                error < 1e-3 * length_mm,
                "{name}: {gait_name} is {error} mm off its centre"
            );
        }
    }
    assert!(path_count > 10, "{path_count}");
}

#[test]
fn a_reversed_gait_runs_backwards_and_reversed_again_forwards() {
    let mut pair_count = 0;
    for Named { name, robot } in robots() {
        for (original, reversed, sign) in [
            ("wander", "retreat", -1),
            ("wander", "advance", 1),
            ("walk", "back", -1),
        ] {
            let (Some(original), Some(reversed)) =
                (gait_named(robot, original), gait_named(robot, reversed))
            else {
                continue;
            };
            pair_count += 1;
            assert!(original.increment > 0, "{name}");
            assert_eq!(reversed.increment, sign * original.increment, "{name}");
            for phase in phases().step_by(64) {
                let poses =
                    [&original, &reversed].map(|gait| gait.pose(robot.firmware().waves(), phase));
                assert_eq!(poses[0], poses[1], "{name}");
            }
        }
    }
    assert!(pair_count >= 16);
}

#[test]
fn a_mirrored_gait_is_the_other_one_with_left_and_right_exchanged() {
    let mut pair_count = 0;
    for Named { name, robot } in robots() {
        for (original, mirrored) in [
            ("creep-along", "other-hand"),
            ("left", "right"),
            ("arc-left", "arc-right"),
        ] {
            let (Some(original), Some(mirrored)) =
                (gait_named(robot, original), gait_named(robot, mirrored))
            else {
                continue;
            };
            pair_count += 1;
            assert_eq!(original.increment, mirrored.increment, "{name}");
            for phase in phases() {
                let pose = mirror(original.pose(robot.firmware().waves(), phase));
                // Halves are rounded up for either sign, and gains are rounded.
                let deviation =
                    pose.largest_turn_to(&mirrored.pose(robot.firmware().waves(), phase));
                assert!(deviation <= 1, "{name}: {deviation} steps");
            }
        }
    }
    assert!(pair_count >= 5);
}

#[test]
fn the_wrap_of_the_phase_is_as_smooth_as_the_rest_of_the_cycle() {
    for (Named { name, robot }, float_gait, gait) in gaits() {
        let pose_at = |phase: u32| gait.pose(robot.firmware().waves(), phase % CYCLE);
        // Returns the largest turn of a servo from a phase to the next, also from the last phase to 0.
        let step_size = |phase: u32| pose_at(phase).largest_turn_to(&pose_at(phase + (1 << 8)));
        let longest_step = phases().step_by(7).map(step_size).max();
        let longest_step_at_wrap = phases().skip(PHASES as usize - 4).map(step_size).max();
        assert!(
            longest_step_at_wrap <= longest_step.map(|longest_step| longest_step + 1),
            "{name}: {}",
            float_gait.name()
        );
    }
}

#[test]
fn the_papers_symmetric_gaits_mirror_themselves_half_a_cycle_apart() {
    for name in ["walk", "trot"] {
        let gait = gait_named(paper(), name).expect("a gait of the paper's robot");
        for phase in phases() {
            let opposite_pose = gait.pose(paper().firmware().waves(), (phase + CYCLE / 2) % CYCLE);
            assert_eq!(
                mirror(gait.pose(paper().firmware().waves(), phase)),
                opposite_pose,
                "{name}"
            );
        }
    }
}

#[test]
fn the_head_of_the_papers_look_follows_its_figure_of_eight() {
    let gait = gait_named(paper(), "look").expect("a gait of the paper's robot");
    let neutral = paper().servos().map(|servo| servo.neutral);
    for phase in (0..PHASES).step_by(16) {
        let sweeps = gait.pose(paper().firmware().waves(), phase << 8).0;
        let angles: [f64; 4] =
            std::array::from_fn(|n| neutral[n] + f64::from(sweeps[n].0) / STEPS_PER_DEGREE);
        let point = paper()
            .lizard()
            .solve(&angles.into())
            .expect("it closes")
            .head
            .end_point;
        let turn = std::f64::consts::TAU * f64::from(phase) / f64::from(PHASES);
        let error = (point.x - 10.0 * turn.sin()).hypot(point.y - 54.0 - 5.0 * (2.0 * turn).sin());
        assert!(error < 0.1, "{error} mm at {phase}");
    }
}
