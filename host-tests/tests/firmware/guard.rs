//! Tests of the guard on the chip: the guard refuses exactly the unsafe poses, and passes no unsafe frame.

use fastrand::Rng;
use lizard_core::guard::clearance::Clearance;
use lizard_core::numbers::part::{End, Side};
use lizard_core::numbers::pose::Pose as Sweeps;
use lizard_core::numbers::units::Sweep;
use lizard_host::sim::analysis::compute_servo_frames;
use lizard_host_tests::robot;
use lizard_kinematics::{self as kinematics, Limits, Pose, Solution, wrap};
use lizard_proof::{LENGTH_BAND_STEPS, margin_band};
use simulated_uno::Fidelity;

use crate::{
    FRAMES_PER_SECOND, Status, boot_to_stand, for_each_in_parallel, frame_angles, neutral_widths,
};

/// Returns the largest error of the guard's slider position relative to floating point, mm.
fn max_stroke_error() -> f64 {
    let scales = Side::ALL.map(|side| robot().firmware().slider(side).scale.bits);
    LENGTH_BAND_STEPS / f64::from(1 << scales[0].min(scales[1]))
}

/// Returns the largest error of the guard's margins if the type-2 margins are at least `type2`.
fn max_margin_error(type2: f64) -> f64 {
    let ends = [
        (End::Head, kinematics::End::Head),
        (End::Tail, kinematics::End::Tail),
    ];
    let bands = ends.map(|(end, kinematic_end)| {
        let step = 1.0 / f64::from(1 << robot().firmware().link_lengths(end).scale().bits);
        margin_band(&robot().lizard().end(kinematic_end), type2, step)
    });
    bands[0].max(bands[1])
}

/// Returns the robot's limits, tightened (`sign` = 1) or relaxed (`sign` = -1) by the guard's tolerance.
fn limits_with_tolerance(sign: f64) -> Limits {
    let limits = robot().limits();
    let (margin, stroke) = (max_margin_error(limits.type2), max_stroke_error());
    Limits {
        type2: limits.type2 + sign * margin,
        type1: limits.type1 + sign * margin,
        leg: limits.leg + sign * margin,
        stroke_min: limits.stroke_min + sign * stroke,
        stroke_max: limits.stroke_max - sign * stroke,
    }
}

/// True if a pose (deg, chassis frame) is within these limits.
fn is_safe(angles: [f64; 4], limits: &Limits) -> bool {
    let result = robot().lizard().solve(&Pose::from(angles));
    result.is_ok_and(|solution| limits.is_safe(&solution))
}

/// True if every servo's angle is within its travel by more than the rounding error.
fn is_within_travel(angles: [f64; 4]) -> bool {
    robot().servos().iter().zip(angles).all(|(servo, angle)| {
        let (min, max) = servo.travel();
        let sweep = wrap(angle - servo.neutral);
        min + 0.02 < sweep && sweep < max - 0.02
    })
}

/// Returns a random pose within `max_deg` degrees of neutral, rounded to the two decimals that the console accepts.
fn random_pose_within(rng: &mut Rng, max_deg: f64) -> [f64; 4] {
    std::array::from_fn(|i| {
        let angle = robot().servos()[i].neutral + max_deg * (2.0 * rng.f64() - 1.0);
        (angle.rem_euclid(360.0) * 100.0).round() / 100.0
    })
}

/// Returns a random safe pose within 80 degrees of neutral. The path to this pose may be unsafe.
fn random_safe_pose(rng: &mut Rng) -> [f64; 4] {
    loop {
        let angles = random_pose_within(rng, 80.0);
        if is_safe(angles, &limits_with_tolerance(1.0)) && is_within_travel(angles) {
            return angles;
        }
    }
}

/// Returns the command for a pose with angles in the chassis frame, deg.
fn pose_line(angles: [f64; 4]) -> String {
    let [a1, a2, a3, a4] = angles;
    format!("pose {a1} {a2} {a3} {a4}")
}

#[test]
fn a_pose_is_accepted_exactly_if_it_is_safe_in_floating_point() {
    for_each_in_parallel(&[20.0, 40.0, 80.0], |&max_deg| {
        let mut rng = Rng::with_seed(max_deg as u64);
        let mut bench = boot_to_stand(Fidelity::DataSheet);
        let (mut accepted_count, mut refused_counts) = (0, [0; 2]);
        for _ in 0..400 {
            let angles = random_pose_within(&mut rng, max_deg);
            let answer = bench.say(&pose_line(angles));
            if is_safe(angles, &limits_with_tolerance(1.0)) && is_within_travel(angles) {
                assert!(answer.starts_with("ok pose"), "{angles:?}: {answer}");
                accepted_count += 1;
            } else if !is_safe(angles, &limits_with_tolerance(-1.0)) {
                let reason = answer.strip_prefix("err ");
                let code = reason.and_then(|reason| reason.chars().next());
                match code {
                    Some('3') if !is_within_travel(angles) => refused_counts[0] += 1,
                    Some('4') => refused_counts[0] += 1,
                    Some('5') => refused_counts[1] += 1,
                    _ => panic!("{angles:?}: {answer}"),
                }
            }
        }
        println!("within {max_deg} deg: {accepted_count} accepted, {refused_counts:?} refused");
        assert!(accepted_count + refused_counts[0] + refused_counts[1] > 350);
    });
}

/// Parses a refusal into the name of the violated condition, with its error code, and the value if the refusal gives
/// one. Examples are `err 4 leg margin of A1 is 0.259, ...`, `err 4 type-2 margin of the head is below 0.1, ...` and
/// `err 5 left slider is at 55.35 mm, ...`.
fn parse_refusal(answer: &str) -> (&str, Option<f64>) {
    let pieces = answer.split_once(" is ");
    let (name, rest) = pieces.expect("a refusal has a name and a value");
    if rest.starts_with("below 0.1, ") {
        return (&name[4..], None);
    }
    let value = rest.trim_start_matches("at ").split([',', ' ']).next();
    let value = value.and_then(|value| value.parse().ok());
    (&name[4..], Some(value.expect("the value is a number")))
}

/// Computes the value of the named condition in floating point, and the guard's largest error for this value; `None` if
/// no condition has this name. The name begins with the error code.
fn compute_value_and_tolerance(solution: &Solution, name: &str) -> Option<(f64, f64)> {
    let margins = &solution.margins;
    // The margin is negative if the crank tips are crossed.
    let type2 = [0, 1].map(|end: usize| {
        let gap = [&solution.head, &solution.tail][end].gap;
        match gap.x < 0.0 {
            true => -margins.type2[end],
            false => margins.type2[end],
        }
    });
    // If the couplers are nearly in line, an error of one length step turns them by a large angle.
    let end_tolerance = |end: usize| max_margin_error(margins.type2[end].max(0.05)) + 0.0005;
    let stroke_tolerance = max_stroke_error() + 0.005;
    let conditions = [
        ("4 type-2 margin of the head", type2[0], end_tolerance(0)),
        ("4 type-2 margin of the tail", type2[1], end_tolerance(1)),
        ("4 type-1 margin of A1", margins.type1[0], end_tolerance(0)),
        ("4 type-1 margin of A2", margins.type1[1], end_tolerance(0)),
        ("4 type-1 margin of A3", margins.type1[2], end_tolerance(1)),
        ("4 type-1 margin of A4", margins.type1[3], end_tolerance(1)),
        ("4 leg margin of A1", margins.leg[0], 0.001),
        ("4 leg margin of A2", margins.leg[1], 0.001),
        ("4 leg margin of A3", margins.leg[2], 0.001),
        ("4 leg margin of A4", margins.leg[3], 0.001),
        ("5 left slider", solution.left.s, stroke_tolerance),
        ("5 right slider", solution.right.s, stroke_tolerance),
    ];
    let condition = conditions.iter().find(|(known, ..)| *known == name);
    condition.map(|(_, value, tolerance)| (*value, *tolerance))
}

#[test]
fn a_refusal_names_the_violated_condition_and_any_computed_value() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    let mut rng = Rng::with_seed(3);
    let (mut printed_count, mut unknown_count) = (0, 0);
    for _ in 0..400 {
        let angles = random_pose_within(&mut rng, 70.0);
        let answer = bench.say(&pose_line(angles));
        if answer.starts_with("ok") || answer.starts_with("err 3") {
            continue;
        }
        let (name, printed_value) = parse_refusal(&answer);
        let solution = match robot().lizard().solve(&Pose::from(angles)) {
            Ok(solution) => solution,
            Err(loop_error) => {
                // A five-bar that does not close has no margins. The guard checks the head first, so it may print the
                // head's value even if the tail does not close.
                let head = robot().lizard().end(kinematics::End::Head);
                let head = head.forward(angles[0], angles[1]);
                match head {
                    Ok(pose) if name.ends_with("head") && printed_value.is_some() => {
                        let max_error = max_margin_error(pose.type2.max(0.05)) + 0.0005;
                        let error =
                            printed_value.expect("the value is a number").abs() - pose.type2;
                        assert!(
                            error.abs() <= max_error,
                            "{angles:?}: {answer}, {loop_error}"
                        );
                    }
                    _ => {
                        assert!(name.starts_with("4 type-2"), "{angles:?}: {answer}");
                        let is_near_singularity =
                            printed_value.is_none_or(|printed_value| printed_value.abs() < 0.1);
                        assert!(is_near_singularity, "{angles:?}: {answer}, {loop_error}");
                    }
                }
                unknown_count += 1;
                continue;
            }
        };
        let (float_value, max_error) =
            compute_value_and_tolerance(&solution, name).unwrap_or_else(|| panic!("{answer}"));
        match printed_value {
            Some(printed_value) => {
                let error = (printed_value - float_value).abs();
                assert!(
                    error <= max_error,
                    "{angles:?}: expected {float_value}, got {answer}"
                );
                printed_count += 1;
            }
            None => {
                assert!(name.starts_with("4 type-2"), "{answer}");
                assert!(
                    float_value.abs() < 0.1,
                    "{angles:?}: expected {float_value}, got {answer}"
                );
                unknown_count += 1;
            }
        }
    }
    println!("{printed_count} values printed, {unknown_count} unknown");
    assert!(printed_count > 20, "{printed_count}");
}

#[test]
fn no_frame_violates_a_limit_under_random_commands() {
    let cases = [
        (Fidelity::Stock, 21),
        (Fidelity::DataSheet, 22),
        (Fidelity::DataSheet, 23),
    ];
    for_each_in_parallel(&cases, |&(fidelity, seed)| {
        let mut rng = Rng::with_seed(seed);
        let mut bench = boot_to_stand(fidelity);
        let lines: Vec<String> = robot().gaits().iter().map(|gait| gait.command()).collect();
        let mut frames = Vec::new();
        for _ in 0..150 {
            let line = if rng.u64(..3) == 0 {
                rng.choice(&lines).expect("every robot has a gait").clone()
            } else {
                pose_line(random_safe_pose(&mut rng))
            };
            assert!(bench.say(&line).starts_with("ok "), "{line}");
            frames.extend(bench.run_for_frames(rng.u64(..2 * FRAMES_PER_SECOND)));
        }
        let relaxed_limits = limits_with_tolerance(-1.0);
        let sent_frames = compute_servo_frames(robot(), &frames);
        for frame in &sent_frames {
            let angles = frame.angles.expect("each servo has a pulse");
            assert!(is_safe(angles, &relaxed_limits), "{frame:?}");
        }
        // No servo moves by more in one frame than the slew limits allow.
        let speed_limits = robot().speed_limits();
        let max_step_deg = speed_limits.gait_slew.max(speed_limits.slew) / 50.0;
        for (pair, frame_pair) in sent_frames.windows(2).zip(frames.windows(2)) {
            if frame_pair[1].start - frame_pair[0].start > lizard_host_tests::FRAME_CYCLES {
                continue;
            }
            let [angles_before, angles_after] =
                [&pair[0], &pair[1]].map(|frame| frame.angles.expect("each servo has a pulse"));
            for servo in 0..4 {
                let step = (angles_after[servo] - angles_before[servo]).abs();
                assert!(
                    step <= max_step_deg + 0.02,
                    "{step} deg in a frame: {pair:?}"
                );
            }
        }
        assert!(frames.len() > 5000);
    });
}

/// Finds two safe poses, each with a safe path from and to neutral, whose straight connecting path is unsafe for longer
/// than a frame; `None` if no such poses are found.
fn find_poses_with_unsafe_path() -> Option<[[f64; 4]; 2]> {
    let mut rng = Rng::with_seed(4);
    let firmware = robot().firmware();
    let to_steps = |angles: [f64; 4]| -> [f64; 4] {
        let servos = robot().servos();
        std::array::from_fn(|i| wrap(angles[i] - servos[i].neutral) * 65536.0 / 360.0)
    };
    let unsafe_count_between = |from: [f64; 4], to: [f64; 4]| {
        let (from, to) = (to_steps(from), to_steps(to));
        let is_unsafe_at = |percent: &u32| {
            let fraction = f64::from(*percent) / 100.0;
            let sweep = |i: usize| Sweep((from[i] + fraction * (to[i] - from[i])) as i16);
            let pose = Sweeps(std::array::from_fn(sweep));
            let clearance = Clearance::measure(firmware, &pose);
            clearance.first_hazard(firmware).is_some()
        };
        (0..=100).filter(is_unsafe_at).count()
    };
    let neutral = robot().servos().map(|servo| servo.neutral);
    let mut kept_poses: Vec<[f64; 4]> = Vec::new();
    for _ in 0..2000 {
        let pose = random_safe_pose(&mut rng);
        if unsafe_count_between(neutral, pose) == 0 && unsafe_count_between(pose, neutral) == 0 {
            let is_partner = |kept_pose: &&[f64; 4]| unsafe_count_between(**kept_pose, pose) > 20;
            if let Some(kept_pose) = kept_poses.iter().find(is_partner) {
                return Some([*kept_pose, pose]);
            }
            // Keeps few poses, so that all pairs can be tried, because some robots have no unsafe path.
            if kept_poses.len() < 40 {
                kept_poses.push(pose);
            }
        }
    }
    None
}

/// Checks that a robot without an unsafe path between two safe poses reaches every safe pose, and that the guard never
/// holds the robot.
fn assert_every_safe_pose_is_reached() {
    let mut rng = Rng::with_seed(4);
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    for _ in 0..20 {
        let pose = random_safe_pose(&mut rng);
        assert!(bench.say(&pose_line(pose)).starts_with("ok pose"));
        bench.run_ms(5000);
        let status = Status::read(&mut bench);
        assert_eq!(
            status.text("guard"),
            "clear",
            "the guard holds the robot on its path to {pose:?}"
        );
        for (actual, expected) in status.pose().into_iter().zip(pose) {
            let error = wrap(actual - expected).abs();
            assert!(error <= 0.02, "expected {expected} deg, got {actual}");
        }
    }
}

#[test]
fn the_robot_stops_on_an_unsafe_path_before_it_violates_a_limit() {
    let Some([from, to]) = find_poses_with_unsafe_path() else {
        assert_every_safe_pose_is_reached();
        return;
    };
    for_each_in_parallel(&[Fidelity::Stock, Fidelity::DataSheet], |fidelity| {
        let mut bench = boot_to_stand(*fidelity);
        assert!(bench.say(&pose_line(from)).starts_with("ok pose"));
        bench.run_ms(5000);
        assert!(bench.say(&pose_line(to)).starts_with("ok pose"));
        let note = bench.next_line(5000).expect("the robot prints a note");
        assert!(note.starts_with("# held in the last safe pose: "), "{note}");
        assert_eq!(Status::read(&mut bench).text("guard"), "held");
        let frames = bench.run_for_frames(FRAMES_PER_SECOND);
        assert!(frames.iter().all(|frame| frame.widths == frames[0].widths));
        let held_angles = frame_angles(&frames)[0];
        assert!(is_safe(held_angles, &limits_with_tolerance(-1.0)) && held_angles != from);
        // The robot can move again: the path back to neutral is safe.
        assert_eq!(bench.say("stand"), "ok stand");
        bench.run_ms(5000);
        let widths = bench.run_for_frames(1)[0].expect_all_widths();
        assert_eq!(widths, neutral_widths());
        assert_eq!(Status::read(&mut bench).text("guard"), "clear");
    });
}
