//! Tests of the console: each line gets one answer, and the pulses agree with the answer.

use fastrand::Rng;
use lizard_host_tests::{
    CYCLES_PER_US, FirmwareBench, Frame, assert_contains, gait_commands, robot,
};
use lizard_kinematics::{Check, Limits, Solution};
use simulated_uno::{FREQUENCY, Fidelity};

use crate::{
    FRAMES_PER_SECOND, Status, boot_and_command, boot_to_stand, first_moving_gait, frame_angles,
    frame_widths, parse_angles, pose_command, run_in_both_simulations,
};

/// Largest rounding error of a printed angle, deg: half a step each for the two printed decimals, the pulse width and
/// the neutral angle.
const MAX_PRINT_ERROR_DEG: f64 = 0.005 + 0.0032 + 0.0028;

#[test]
fn the_banner_and_an_answer_come_within_a_second_of_power_on() {
    run_in_both_simulations(|fidelity| {
        let mut bench = FirmwareBench::boot_with(fidelity);
        let hash = robot().firmware().hash();
        let banner = bench.lines()[0].text.clone();
        assert!(banner.starts_with("# lizard "), "{banner}");
        assert_contains(&banner, &format!(" {hash:08x}, send help"));
        assert!(bench.say("status").starts_with("ok gait=stand "));
        assert!(bench.uno.cycle() < FREQUENCY);
    });
}

#[test]
fn cr_and_lf_and_crlf_each_end_one_line() {
    run_in_both_simulations(|fidelity| {
        for end in ["\r", "\n", "\r\n"] {
            let mut bench = boot_to_stand(fidelity);
            let line_count_before = bench.lines().len();
            let text = format!("{end}{end} \t{end}stand{end}{end}stop{end}status{end}");
            bench.uno.send(text.as_bytes());
            bench.run_ms(300);
            let lines = bench.texts_from(line_count_before);
            assert_eq!(lines.len(), 3, "{end:?}: {lines:?}");
            assert_eq!(lines[..2], ["ok stand", "ok stop"]);
            assert!(lines[2].starts_with("ok gait=stop "));
        }
    });
}

#[test]
fn letter_case_and_whitespace_do_not_matter() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    assert_eq!(bench.say("  StaNd\t "), "ok stand");
    // The test uses the gait with the most words in its name.
    let mut gaits = gait_commands();
    gaits.sort_by_key(|gait| gait.split(' ').count());
    let gait = gaits.pop().expect("every robot has `stand`");
    let typed_gait = gait.to_uppercase().replacen(' ', "   \t", 1);
    let answer = bench.say(&format!(" {typed_gait} "));
    assert!(answer.starts_with("ok "), "{typed_gait}");
    let status = Status::read(&mut bench);
    assert_eq!(status.text("gait"), gait.replace(' ', "-"));
    assert!(bench.say(" speed\t50 ").starts_with("ok speed"));
    assert_eq!(Status::read(&mut bench).text("speed"), "50");
}

#[test]
fn a_line_has_at_most_63_characters() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    let longest_line = format!("stand{}", " ".repeat(58));
    assert_eq!(bench.say(&longest_line), "ok stand");
    assert!(bench.say(&format!("{longest_line} ")).starts_with("err 6 "));
    assert!(bench.say(&"x".repeat(500)).starts_with("err 6 "));
    let answer = bench.say("stop");
    assert_eq!(
        answer, "ok stop",
        "the remainder of the overlong line was not discarded"
    );
}

/// Returns poses that violate a servo's travel, a margin and a slider's stroke, each with its error code. The pose for
/// the stroke is missing if every such pose of this robot also violates a limit that the guard checks earlier.
fn find_refused_poses() -> Vec<(String, u8)> {
    let mut rng = Rng::with_seed(1);
    let mut poses: [Option<String>; 3] = [None, None, None];
    let servos = robot().servos();
    for n in 0..400_000 {
        // Half of the poses are closer to neutral, where poses violate fewer limits at once.
        let max_sweep = [175.0, 90.0, 45.0, 25.0][n % 4];
        let sweeps: [f64; 4] = std::array::from_fn(|_| max_sweep * (2.0 * rng.f64() - 1.0));
        let is_within_travel = |margin_deg: f64| {
            servos.iter().zip(sweeps).all(|(servo, sweep)| {
                let (min, max) = servo.travel();
                min + margin_deg < sweep && sweep < max - margin_deg
            })
        };
        let index = if !is_within_travel(-0.1) {
            0
        } else if !is_within_travel(0.1) {
            continue;
        } else {
            let angles: [f64; 4] = std::array::from_fn(|i| servos[i].neutral + sweeps[i]);
            let Ok(solution) = robot().lizard().solve(&angles.into()) else {
                continue;
            };
            match certain_refusal_code(&solution) {
                Some(4) => 1,
                Some(5) => 2,
                _ => continue,
            }
        };
        poses[index].get_or_insert_with(|| pose_command(sweeps));
        if poses.iter().all(Option::is_some) {
            break;
        }
    }
    let [travel, margin, stroke] = poses;
    let travel = travel.expect("a pose violates a travel");
    let margin = margin.expect("a pose violates a margin");
    let stroke = stroke.map(|line| (line, 5));
    println!("a pose that violates only a stroke: {stroke:?}");
    let poses = [Some((travel, 3)), Some((margin, 4)), stroke];
    poses.into_iter().flatten().collect()
}

/// Returns the error code of a pose within the travel; `None` if the pose is allowed, or so close to a limit that the
/// code depends on rounding. The guard first checks the margins of both five-bars, where crossed crank tips count as a
/// type-2 margin below 0, and checks the strokes last.
fn certain_refusal_code(solution: &Solution) -> Option<u8> {
    let is_violated = |strictness: f64, is_stroke: bool| {
        let mut violations = stricter_limits(strictness).violations(solution);
        violations.any(|violation| Check::STROKE.contains(&violation.check) == is_stroke)
    };
    let scale = robot().lizard().links.l10 / 135.0;
    let ends = [&solution.head, &solution.tail];
    let is_near_crossing = ends.iter().any(|end| end.gap.x.abs() < scale);
    match (is_violated(-0.05, false), is_violated(0.05, false)) {
        _ if is_near_crossing => None,
        (true, _) => Some(4),
        (false, false) if is_violated(-0.05, true) => Some(5),
        _ => None,
    }
}

/// Returns stricter limits for the robot: the sines by `strictness`, and the strokes by `10 * strictness` mm for a
/// robot of the paper's size.
fn stricter_limits(strictness: f64) -> Limits {
    let limits = robot().limits();
    let scale = robot().lizard().links.l10 / 135.0;
    Limits {
        type2: limits.type2 + strictness,
        type1: limits.type1 + strictness,
        leg: limits.leg + strictness,
        stroke_min: limits.stroke_min + 10.0 * strictness * scale,
        stroke_max: limits.stroke_max - 10.0 * strictness * scale,
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
    let poses = poses.iter().map(|(line, code)| (line.as_str(), *code));
    let refused_lines: Vec<(&str, u8)> = refused_lines.into_iter().chain(poses).collect();
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_and_command(&first_moving_gait(), fidelity);
        let mut reference_bench = boot_and_command(&first_moving_gait(), fidelity);
        for &(line, code) in &refused_lines {
            let answer = bench.say(line);
            let text = answer.strip_prefix(&format!("err {code} "));
            let has_text = text.is_some_and(|text| !text.is_empty());
            assert!(has_text, "{line}: {answer}");
        }
        // Both boards must have walked for the same time before they are compared.
        for board in [&mut bench, &mut reference_bench] {
            board.uno.run_until_cycle(4 * FREQUENCY);
        }
        let [(frames, status), (reference_frames, reference_status)] = [bench, reference_bench]
            .map(|mut bench| {
                let frames = bench.run_for_frames(2 * FRAMES_PER_SECOND);
                (frames, Status::read(&mut bench).0)
            });
        assert_eq!(frames, reference_frames);
        assert_eq!(status, reference_status);
    });
}

#[test]
fn while_the_servos_rest_only_stand_moves_them() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_to_stand(fidelity);
        assert_eq!(bench.say("rest"), "ok rest");
        let other_gaits = gait_commands().into_iter().skip(1);
        for line in other_gaits.chain(["stop".into(), pose_command([0.0; 4])]) {
            assert!(bench.say(&line).starts_with("err 7 "), "{line}");
        }
        for line in ["rest", "speed 80", "watch 0", "help", "status"] {
            assert!(bench.say(line).starts_with("ok "), "{line}");
        }
        bench.run_ms(100);
        assert!(bench.run_for_frames(10).iter().all(Frame::is_silent));
        assert_eq!(bench.say("stand"), "ok stand");
        bench.run_ms(1000);
        bench.expect_ok(&first_moving_gait());
    });
}

#[test]
fn help_names_every_gait_and_the_main_commands() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    for line in ["help", "?"] {
        let (notes, answer) = bench.ask(line);
        assert_eq!(answer, "ok help");
        let text = notes.join("\n");
        for gait in robot().gaits() {
            assert!(text.contains(&gait.command()), "{}", gait.name());
        }
        for word in ["stop", "rest", "trim", "save", "deadman", "watch"] {
            assert!(text.contains(word), "{word}");
        }
    }
}

#[test]
fn status_agrees_with_the_pulses() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_and_command(&first_moving_gait(), fidelity);
        bench.say("stop");
        bench.run_ms(100);
        let status = Status::read(&mut bench);
        let sent_angles = frame_angles(&bench.run_for_frames(1))[0];
        for (servo, (printed, sent)) in status.pose().into_iter().zip(sent_angles).enumerate() {
            let error_deg = (printed - sent).abs();
            assert!(
                error_deg <= MAX_PRINT_ERROR_DEG,
                "A{}: printed {printed} deg, sent {sent} deg",
                servo + 1
            );
        }
        let solution = robot().lizard().solve(&sent_angles.into());
        let margin = solution.expect("the pose is safe").margins.min().1;
        assert!((status.number("margin") - margin).abs() <= 0.0025);
        assert_eq!(status.text("gait"), "stop");
        assert_eq!(status.numbers(["late", "rx_lost"]), [0.0; 2]);
        assert!((0.0..1.0).contains(&status.number("phase")));
    });
}

#[test]
fn status_counts_fifty_frames_a_second_and_follows_the_phase() {
    let mut bench = boot_and_command(&first_moving_gait(), Fidelity::DataSheet);
    bench.run_ms(3000); // reaches the gait's first pose
    let gait_name = first_moving_gait();
    let gait = robot().gait(&gait_name).expect("the robot has this gait");
    let mut previous_sample: Option<(u64, Status)> = None;
    for _ in 0..20 {
        bench.run_for_frames(0); // runs to the start of the next frame
        let (cycle, status) = (bench.uno.cycle(), Status::read(&mut bench));
        if let Some((previous_cycle, previous_status)) = previous_sample {
            let frames = (cycle - previous_cycle) as f64 * 50.0 / FREQUENCY as f64;
            let counted_frames = status.number("frames") - previous_status.number("frames");
            assert_eq!(counted_frames, frames.round());
            let phase_change = status.number("phase") - previous_status.number("phase");
            let gait_cycles = frames.round() / 50.0 / gait.period();
            let expected = match gait.is_reversed() {
                true => -gait_cycles,
                false => gait_cycles,
            };
            let error = (phase_change - expected).rem_euclid(1.0);
            // A phase is printed with three decimals.
            assert!(
                error.min(1.0 - error) <= 0.0021,
                "phase change {phase_change} in {frames} frames"
            );
        }
        previous_sample = Some((cycle, status));
        bench.run_ms(470);
    }
}

#[test]
fn watch_reports_the_pose_of_every_nth_frame_until_switched_off() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_and_command(&first_moving_gait(), fidelity);
        assert_eq!(bench.say("watch 7"), "ok watch 7");
        let line_count = bench.lines().len();
        let frames = bench.run_for_frames(75);
        let sent_angles = frame_angles(&frames);
        // A report after the beginning of the last frame may belong to the next one.
        let end_cycle = frames[74].start;
        let lines = bench.lines()[line_count..].iter();
        let lines = lines.filter(|line| line.cycle < end_cycle);
        let lines: Vec<String> = lines.map(|line| line.text.clone()).collect();
        assert!((10..=11).contains(&lines.len()), "{lines:?}");
        let mut previous_frame = None;
        for line in &lines {
            let report = line.strip_prefix("# t=").expect("the line is a report");
            let (frame_number, pose) = report.split_once(" pose=").expect("a report has a pose");
            let frame_number: u64 = frame_number.parse().expect("the frame is a number");
            let is_next = previous_frame.is_none_or(|previous| frame_number == previous + 7);
            assert!(is_next, "{lines:?}");
            previous_frame = Some(frame_number);
            let printed_angles = parse_angles(pose);
            let was_sent = sent_angles.iter().any(|angles| {
                (0..4).all(|i| (printed_angles[i] - angles[i]).abs() <= MAX_PRINT_ERROR_DEG)
            });
            assert!(was_sent, "{line} was never sent");
        }
        assert_eq!(bench.say("watch 0"), "ok watch 0");
        let line_count = bench.lines().len();
        bench.run_ms(500);
        assert_eq!(bench.lines().len(), line_count);
    });
}

#[test]
fn a_gait_cycle_takes_twice_as_long_at_half_speed_and_ten_times_at_a_tenth() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_and_command(&first_moving_gait(), fidelity);
        bench.run_ms(3000); // reaches the gait's first pose
        let gait_name = first_moving_gait();
        let gait = robot().gait(&gait_name).expect("the robot has this gait");
        // The pace is a multiple of 1/1024, so a pace of 10 % has an error of up to half a percent.
        let frame_count = (gait.period() * FRAMES_PER_SECOND as f64).ceil() as u64;
        let max_step_deg = robot().speed_limits().gait_slew / FRAMES_PER_SECOND as f64;
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
                let frame_step = CYCLES_PER_US * servo.us_per_degree.abs() * max_step_deg;
                let pace_error_frames = 0.005 * gait.period() * FRAMES_PER_SECOND as f64;
                let max_error = (pace_error_frames + 1.0) * frame_step + 2.0;
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
        let frame_step = CYCLES_PER_US * robot().servos()[0].us_per_degree.abs() * max_step_deg;
        let is_equal_span = |span: &u64| span.abs_diff(spans[0]) as f64 <= 2.0 * frame_step;
        assert!(spans.iter().all(is_equal_span), "{spans:?}");
    });
}
