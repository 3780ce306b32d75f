//! Tests of the console: each line gets one answer, and the pulses agree with the answer.

use std::collections::BTreeMap;

use fastrand::Rng;
use lizard_host_tests::{
    CYCLES_PER_US, FirmwareBench, Frame, assert_contains, gait_commands, robot,
};
use lizard_kinematics::Check;
use lizard_robot::Servo;
use simulated_uno::{FREQUENCY, Fidelity};

use crate::{
    FRAMES_PER_SECOND, Status, assert_near, boot_to_stand, boot_to_walk, expect_answer,
    first_moving_gait, frame_angles, frame_widths, is_within_travel, parse_angles, pose_command,
    run_in_both_simulations, start_in_both_simulations, stricter_limits,
};

/// Largest rounding error of a printed angle, deg: half a step each for the two printed decimals, the pulse width and
/// the neutral angle.
const MAX_PRINT_ERROR_DEG: f64 = 0.005 + 0.0032 + 0.0028;

#[test]
fn the_banner_and_an_answer_come_within_a_second_of_power_on() {
    start_in_both_simulations(FirmwareBench::boot, |mut bench| {
        let hash = robot().firmware().hash();
        let banner = bench.lines()[0].text.clone();
        assert!(banner.starts_with("# lizard "), "{banner}");
        assert_contains(&banner, &format!(" {hash:08x}, send help"));
        Status::read(&mut bench).assert_has("gait=stand");
        assert!(bench.uno.cycle() < FREQUENCY);
    });
}

/// Returns poses that violate a servo's travel, a margin and a slider's stroke, each with its error code. The pose for
/// the stroke is missing if every such pose of this robot also violates a limit that the guard checks earlier.
fn find_refused_poses() -> BTreeMap<u8, String> {
    let mut rng = Rng::with_seed(1);
    let mut poses = BTreeMap::new();
    for n in 0..400_000 {
        // Half of the poses are closer to neutral, where poses violate fewer limits at once.
        let max_sweep = [175.0, 90.0, 45.0, 25.0][n % 4];
        let sweeps: [f64; 4] = std::array::from_fn(|_| max_sweep * (2.0 * rng.f64() - 1.0));
        if let Some(code) = certain_refusal_code(sweeps) {
            poses.entry(code).or_insert_with(|| pose_command(sweeps));
        }
        if poses.len() == 3 {
            break;
        }
    }
    assert!(poses.contains_key(&3), "no pose violates a travel");
    assert!(poses.contains_key(&4), "no pose violates a margin");
    println!("a pose that violates only a stroke: {:?}", poses.get(&5));
    poses
}

/// Returns the error code of a pose at these angles from neutral, deg; `None` if the pose is allowed, or so close to a
/// limit that the code depends on rounding. The guard first checks the travel, then the margins of both five-bars,
/// where crossed crank tips count as a type-2 margin below 0, and checks the strokes last.
fn certain_refusal_code(sweeps: [f64; 4]) -> Option<u8> {
    let angles = std::array::from_fn(|i| robot().servos()[i].neutral + sweeps[i]);
    if !is_within_travel(angles, 0.1) {
        return (!is_within_travel(angles, -0.1)).then_some(3);
    }
    let solution = robot().lizard().solve(&angles.into()).ok()?;
    // The strokes' limits are in mm for a robot of the paper's size.
    let scale = robot().lizard().links.l10 / 135.0;
    let is_violated = |strictness: f64, is_stroke: bool| {
        let limits = stricter_limits(strictness, 10.0 * strictness * scale);
        let mut violations = limits.violations(&solution);
        violations.any(|violation| Check::STROKE.contains(&violation.check) == is_stroke)
    };
    let ends = [&solution.head, &solution.tail];
    let is_near_crossing = ends.iter().any(|end| end.gap.x.abs() < scale);
    match (is_violated(-0.05, false), is_violated(0.05, false)) {
        _ if is_near_crossing => None,
        (true, _) => Some(4),
        (false, false) if is_violated(-0.05, true) => Some(5),
        _ => None,
    }
}

#[test]
fn every_refused_line_gets_its_error_code_and_changes_nothing() {
    let refused_lines = [
        ("gallop", 1),
        ("standing", 1),
        ("s\u{7}op", 1),
        ("speed", 2),
        ("speed fast", 2),
        ("speed 50 60", 2),
        ("watch", 2),
        ("watch -1", 2),
        ("stand on", 2),
        ("stop now", 2),
        ("pose 138.59 41.41 318.59", 2),
        ("pose 138.59 41.41 318.59 221.41 0", 2),
        ("pose 138.591 41.41 318.59 221.41", 2),
        ("pose a b c d", 2),
        ("pose 0 0 0 720", 3),
        ("speed 9", 3),
        ("speed 101", 3),
        ("speed 65546", 3),
        ("watch 10001", 3),
        (&"stop".repeat(16), 6),
    ];
    let poses = find_refused_poses();
    let poses = poses.iter().map(|(code, line)| (line.as_str(), *code));
    let refused_lines: Vec<(&str, u8)> = refused_lines.into_iter().chain(poses).collect();
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_to_walk(fidelity);
        let reference_bench = boot_to_walk(fidelity);
        for &(line, code) in &refused_lines {
            let start = format!("err {code} ");
            let answer = expect_answer(&mut bench, line, &start);
            assert!(answer.len() > start.len(), "{line}: {answer}");
        }
        let [(frames, status), (reference_frames, reference_status)] = [bench, reference_bench]
            .map(|mut bench| {
                // Both boards must have walked for the same time before they are compared.
                bench.uno.run_until_cycle(4 * FREQUENCY);
                let frames = bench.run_for_frames(2 * FRAMES_PER_SECOND);
                (frames, Status::read(&mut bench))
            });
        assert_eq!(frames, reference_frames);
        assert_eq!(status, reference_status);
    });
}

#[test]
fn while_the_servos_rest_only_stand_moves_them() {
    start_in_both_simulations(boot_to_stand, |mut bench| {
        assert_eq!(bench.say("rest"), "ok rest");
        let other_gaits = gait_commands().into_iter().skip(1);
        for line in other_gaits.chain(["stop".into(), pose_command([0.0; 4])]) {
            expect_answer(&mut bench, &line, "err 7 ");
        }
        for line in ["rest", "speed 80", "watch 0", "help", "status"] {
            expect_answer(&mut bench, line, "ok ");
        }
        bench.run_ms(100);
        assert!(bench.run_for_frames(10).iter().all(Frame::is_silent));
        assert_eq!(bench.say("stand"), "ok stand");
        bench.run_ms(1000);
        bench.expect_ok(&first_moving_gait());
    });
}

#[test]
fn status_agrees_with_the_pulses() {
    start_in_both_simulations(boot_to_walk, |mut bench| {
        bench.say("stop");
        bench.run_ms(100);
        let status = Status::read(&mut bench);
        let sent_angles = frame_angles(robot(), &bench.run_for_frames(1))[0];
        for (servo, (printed, sent)) in status.pose().into_iter().zip(sent_angles).enumerate() {
            let name = format!("A{}", servo + 1);
            assert_near(printed, sent, MAX_PRINT_ERROR_DEG, &name);
        }
        let solution = robot().lizard().solve(&sent_angles.into());
        let margin = solution.expect("the pose is safe").margins.min().1;
        assert_near(status.number("margin"), margin, 0.0025, "margin");
        status.assert_has("gait=stop late=0 rx_lost=0");
        assert!((0.0..1.0).contains(&status.number("phase")));
    });
}

#[test]
fn status_counts_fifty_frames_a_second_and_follows_the_phase() {
    let mut bench = boot_to_walk(Fidelity::DataSheet);
    bench.run_ms(3000); // reaches the gait's first pose
    let gait = robot().gait(&first_moving_gait());
    let gait = gait.expect("the robot has this gait");
    let direction = if gait.is_reversed() { -1.0 } else { 1.0 };
    let mut samples = Vec::new();
    for _ in 0..20 {
        bench.run_for_frames(0); // runs to the start of the next frame
        samples.push((bench.uno.cycle(), Status::read(&mut bench)));
        bench.run_ms(470);
    }
    for ((previous_cycle, previous_status), (cycle, status)) in samples.iter().zip(&samples[1..]) {
        let frames = (cycle - previous_cycle) as f64 * 50.0 / FREQUENCY as f64;
        let counted_frames = status.number("frames") - previous_status.number("frames");
        assert_eq!(counted_frames, frames.round());
        let phase_change = status.number("phase") - previous_status.number("phase");
        let expected = direction * frames.round() / 50.0 / gait.period();
        let error = (phase_change - expected).rem_euclid(1.0);
        // A phase is printed with three decimals.
        let is_near = error.min(1.0 - error) <= 0.0021;
        assert!(is_near, "phase change {phase_change} in {frames} frames");
    }
}

#[test]
fn watch_reports_the_pose_of_every_nth_frame_until_switched_off() {
    start_in_both_simulations(boot_to_walk, |mut bench| {
        assert_eq!(bench.say("watch 7"), "ok watch 7");
        let line_count = bench.lines().len();
        let frames = bench.run_for_frames(75);
        let sent_angles = frame_angles(robot(), &frames);
        // A report after the beginning of the last frame may belong to the next one.
        let end_cycle = frames[74].start;
        let mut lines = bench.lines()[line_count..].to_vec();
        lines.retain(|line| line.cycle < end_cycle);
        assert!((10..=11).contains(&lines.len()), "{lines:?}");
        let mut frame_numbers: Vec<u64> = Vec::new();
        for line in &lines {
            let report = line.text.strip_prefix("# t=");
            let report = report.expect("the line is a report").split_once(" pose=");
            let (frame_number, pose) = report.expect("a report has a pose");
            frame_numbers.push(frame_number.parse().expect("the frame is a number"));
            let printed_angles = parse_angles(pose);
            let was_sent = sent_angles.iter().any(|angles| {
                (0..4).all(|i| (printed_angles[i] - angles[i]).abs() <= MAX_PRINT_ERROR_DEG)
            });
            assert!(was_sent, "{line:?} was never sent");
        }
        let mut intervals = frame_numbers.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(intervals.all(|interval| interval == 7), "{lines:?}");
        assert_eq!(bench.say("watch 0"), "ok watch 0");
        let line_count = bench.lines().len();
        bench.run_ms(500);
        assert_eq!(bench.lines().len(), line_count);
    });
}

#[test]
fn a_gait_cycle_takes_twice_as_long_at_half_speed_and_ten_times_at_a_tenth() {
    start_in_both_simulations(boot_to_walk, |mut bench| {
        bench.run_ms(3000); // reaches the gait's first pose
        let gait = robot().gait(&first_moving_gait());
        let gait = gait.expect("the robot has this gait");
        // The pace is a multiple of 1/1024, so a pace of 10 % has an error of up to half a percent.
        let frame_count = (gait.period() * FRAMES_PER_SECOND as f64).ceil() as u64;
        let max_step_deg = robot().speed_limits().gait_slew / FRAMES_PER_SECOND as f64;
        let frame_step = |servo: &Servo| CYCLES_PER_US * servo.us_per_degree.abs() * max_step_deg;
        let mut spans: Vec<u64> = Vec::new();
        for (percent, slowdown) in [(100, 1), (50, 2), (10, 10)] {
            bench.expect_ok(&format!("speed {percent}"));
            bench.run_ms(500);
            let cycle_frames = slowdown * frame_count;
            let sent_widths = frame_widths(&bench.run_for_frames(2 * cycle_frames));
            let (first_cycle, second_cycle) = sent_widths.split_at(cycle_frames as usize);
            for (i, servo) in robot().servos().iter().enumerate() {
                // Allows half a percent of a gait cycle, and one frame, since a gait cycle may not be a whole number
                // of frames.
                let pace_error_frames = 0.005 * gait.period() * FRAMES_PER_SECOND as f64;
                let max_error = (pace_error_frames + 1.0) * frame_step(servo) + 2.0;
                for (first_widths, second_widths) in first_cycle.iter().zip(second_cycle) {
                    let error = first_widths[i].abs_diff(second_widths[i]) as f64;
                    assert!(
                        error <= max_error,
                        "{percent} %: {error} cycles after a gait cycle"
                    );
                }
            }
            // In a gait cycle, each leg makes its full sweep at any pace.
            let a1_widths = first_cycle.iter().map(|widths| widths[0]);
            let (min, max) = (a1_widths.clone().min(), a1_widths.max());
            spans.push(max.unwrap_or(0) - min.unwrap_or(0));
        }
        let max_difference = 2.0 * frame_step(&robot().servos()[0]);
        let is_equal_span = |span: &u64| span.abs_diff(spans[0]) as f64 <= max_difference;
        assert!(spans.iter().all(is_equal_span), "{spans:?}");
    });
}
