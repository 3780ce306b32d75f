//! Tests of the guard on the chip: the guard refuses exactly the unsafe poses, and passes no unsafe frame.

use fastrand::Rng;
use lizard_core::guard::clearance::Clearance;
use lizard_core::numbers::part::{End, Side};
use lizard_core::numbers::pose::Pose as Sweeps;
use lizard_core::numbers::units::Sweep;
use lizard_host_tests::{FRAME_CYCLES, gait_commands, robot};
use lizard_kinematics::{self as kinematics, Limits, Pose, Solution, wrap};
use lizard_proof::{LENGTH_BAND_STEPS, margin_band};
use lizard_robot::round_to_hundredths;
use simulated_uno::Fidelity;

use crate::{
    FRAMES_PER_SECOND, Status, assert_near, boot_to_stand, expect_answer, for_each_in_parallel,
    format_pose, frame_angles, is_within_travel, neutral_widths, start_in_both_simulations,
    stricter_limits,
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
    let margin = max_margin_error(robot().limits().type2);
    stricter_limits(sign * margin, sign * max_stroke_error())
}

/// True if a pose (deg, chassis frame) is within these limits.
fn is_safe(angles: [f64; 4], limits: &Limits) -> bool {
    let result = robot().lizard().solve(&Pose::from(angles));
    result.is_ok_and(|solution| limits.is_safe(&solution))
}

/// True if a pose (deg, chassis frame) is safe and within the servos' travel by more than the rounding errors.
fn is_certainly_allowed(angles: [f64; 4]) -> bool {
    is_safe(angles, &limits_with_tolerance(1.0)) && is_within_travel(angles, 0.02)
}

/// Returns a random pose within `max_deg` degrees of neutral, rounded to the two decimals that the console accepts.
fn random_pose_within(rng: &mut Rng, max_deg: f64) -> [f64; 4] {
    std::array::from_fn(|i| {
        let angle = robot().servos()[i].neutral + max_deg * (2.0 * rng.f64() - 1.0);
        round_to_hundredths(angle.rem_euclid(360.0))
    })
}

/// Returns a random safe pose within 80 degrees of neutral. The path to this pose may be unsafe.
fn random_safe_pose(rng: &mut Rng) -> [f64; 4] {
    loop {
        let angles = random_pose_within(rng, 80.0);
        if is_certainly_allowed(angles) {
            return angles;
        }
    }
}

#[test]
fn a_pose_is_accepted_exactly_if_it_is_safe_in_floating_point() {
    for_each_in_parallel(&[20.0, 40.0, 80.0], |&max_deg| {
        let mut rng = Rng::with_seed(max_deg as u64);
        let mut bench = boot_to_stand(Fidelity::DataSheet);
        let (mut accepted_count, mut refused_counts) = (0, [0; 2]);
        for _ in 0..400 {
            let angles = random_pose_within(&mut rng, max_deg);
            let answer = bench.say(&format_pose(angles));
            if is_certainly_allowed(angles) {
                assert!(answer.starts_with("ok pose"), "{angles:?}: {answer}");
                accepted_count += 1;
            } else if !is_safe(angles, &limits_with_tolerance(-1.0)) {
                match answer.get(..5) {
                    Some("err 3") if !is_within_travel(angles, 0.02) => refused_counts[0] += 1,
                    Some("err 4") => refused_counts[0] += 1,
                    Some("err 5") => refused_counts[1] += 1,
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
    let mut type2 = margins.type2;
    for (margin, end) in type2.iter_mut().zip([&solution.head, &solution.tail]) {
        if end.gap.x < 0.0 {
            *margin = -*margin;
        }
    }
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

/// Checks a refusal of a pose in which a five-bar does not close, so that it has no margins. `name` and
/// `printed_value` are from the refusal; `case` names the pose, the refusal and the error.
fn assert_unclosed_pose(angles: [f64; 4], name: &str, printed_value: Option<f64>, case: &str) {
    assert!(name.starts_with("4 type-2"), "{case}");
    // The guard checks the head first, so it may print the head's value even if the tail does not close.
    let head = robot().lizard().end(kinematics::End::Head);
    match (printed_value, head.forward(angles[0], angles[1])) {
        (Some(value), Ok(pose)) if name.ends_with("head") => {
            let max_error = max_margin_error(pose.type2.max(0.05)) + 0.0005;
            assert_near(value.abs(), pose.type2, max_error, case);
        }
        (value, _) => assert!(value.is_none_or(|value| value.abs() < 0.1), "{case}"),
    }
}

#[test]
fn a_refusal_names_the_violated_condition_and_any_computed_value() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    let mut rng = Rng::with_seed(3);
    let (mut printed_count, mut unknown_count) = (0, 0);
    for _ in 0..400 {
        let angles = random_pose_within(&mut rng, 70.0);
        let answer = bench.say(&format_pose(angles));
        if answer.starts_with("ok") || answer.starts_with("err 3") {
            continue;
        }
        let (name, printed_value) = parse_refusal(&answer);
        let case = format!("{angles:?}: {answer}");
        let solution = match robot().lizard().solve(&Pose::from(angles)) {
            Ok(solution) => solution,
            Err(loop_error) => {
                let case = format!("{case}, {loop_error}");
                assert_unclosed_pose(angles, name, printed_value, &case);
                unknown_count += 1;
                continue;
            }
        };
        let condition = compute_value_and_tolerance(&solution, name);
        let (float_value, max_error) = condition.expect(&case);
        if let Some(printed_value) = printed_value {
            assert_near(printed_value, float_value, max_error, &case);
            printed_count += 1;
        } else {
            assert!(name.starts_with("4 type-2"), "{case}");
            assert!(float_value.abs() < 0.1, "{case}: expected {float_value}");
            unknown_count += 1;
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
        let lines = gait_commands();
        let mut frames = Vec::new();
        for _ in 0..150 {
            let line = match rng.u64(..3) {
                0 => rng.choice(&lines).expect("every robot has a gait").clone(),
                _ => format_pose(random_safe_pose(&mut rng)),
            };
            expect_answer(&mut bench, &line, "ok ");
            frames.extend(bench.run_for_frames(rng.u64(..2 * FRAMES_PER_SECOND)));
        }
        let relaxed_limits = limits_with_tolerance(-1.0);
        let sent_angles = frame_angles(robot(), &frames);
        for (frame, angles) in frames.iter().zip(&sent_angles) {
            assert!(is_safe(*angles, &relaxed_limits), "{frame:?}: {angles:?}");
        }
        // No servo moves by more in one frame than the slew limits allow.
        let speed_limits = robot().speed_limits();
        let max_step_deg = speed_limits.gait_slew.max(speed_limits.slew) / 50.0;
        for (angles, pair) in sent_angles.windows(2).zip(frames.windows(2)) {
            if pair[1].start - pair[0].start > FRAME_CYCLES {
                continue;
            }
            for (before, after) in angles[0].into_iter().zip(angles[1]) {
                let is_slow = (after - before).abs() <= max_step_deg + 0.02;
                assert!(is_slow, "{before} to {after} deg in a frame: {pair:?}");
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
        expect_answer(&mut bench, &format_pose(pose), "ok pose");
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
    start_in_both_simulations(boot_to_stand, |mut bench| {
        expect_answer(&mut bench, &format_pose(from), "ok pose");
        bench.run_ms(5000);
        expect_answer(&mut bench, &format_pose(to), "ok pose");
        let note = bench.next_line(5000).expect("the robot prints a note");
        assert!(note.starts_with("# held in the last safe pose: "), "{note}");
        Status::read(&mut bench).assert_has("guard=held");
        let frames = bench.run_for_frames(FRAMES_PER_SECOND);
        assert!(frames.iter().all(|frame| frame.widths == frames[0].widths));
        let held_angles = frame_angles(robot(), &frames)[0];
        assert!(is_safe(held_angles, &limits_with_tolerance(-1.0)) && held_angles != from);
        // The robot can move again: the path back to neutral is safe.
        assert_eq!(bench.say("stand"), "ok stand");
        bench.run_ms(5000);
        let widths = bench.run_for_frames(1)[0].expect_all_widths();
        assert_eq!(widths, neutral_widths());
        Status::read(&mut bench).assert_has("guard=clear");
    });
}
