//! Tests of the console: each line gets one answer, and the pulses agree with that answer.

use fastrand::Rng;
use lizard_host::sim::analysis::servo_frames_of;
use lizard_host_tests::{FirmwareBench, robot};
use lizard_kinematics::{Check, Limits, Solution};
use simulated_uno::{FREQUENCY, Fidelity};

use crate::{
    FRAMES_PER_SECOND, Status, boot_and_command, boot_standing, first_moving_gait, gait_commands,
    parse_angles, pose_command, run_in_both_simulations, widths,
};

/// Largest rounding error of a printed angle, deg: half a step each of the two printed decimals, of the pulse width
/// and of the neutral angle.
const MAX_PRINT_ERROR: f64 = 0.005 + 0.0032 + 0.0028;

#[test]
fn half_a_second_after_power_on_there_is_a_banner_and_after_one_an_answer() {
    run_in_both_simulations(|fidelity| {
        let mut bench = FirmwareBench::boot_with(fidelity);
        let hash = robot().firmware().hash();
        let banner = bench.lines()[0].text.clone();
        assert!(banner.starts_with("# lizard "), "{banner}");
        assert!(
            banner.contains(&format!(" {hash:08x}, send help")),
            "{banner}"
        );
        assert!(bench.say("status").starts_with("ok gait=stand "));
        assert!(bench.uno.cycle() < FREQUENCY);
    });
}

#[test]
fn cr_and_lf_and_crlf_each_end_one_line() {
    run_in_both_simulations(|fidelity| {
        for end in ["\r", "\n", "\r\n"] {
            let mut bench = boot_standing(fidelity);
            let before = bench.lines().len();
            let text = format!("{end}{end} \t{end}stand{end}{end}stop{end}status{end}");
            bench.uno.send(text.as_bytes());
            bench.run_ms(300);
            let lines: Vec<&str> = bench.lines()[before..]
                .iter()
                .map(|line| line.text.as_str())
                .collect();
            assert_eq!(lines.len(), 3, "{end:?}: {lines:?}");
            assert_eq!(lines[..2], ["ok stand", "ok stop"]);
            assert!(lines[2].starts_with("ok gait=stop "));
        }
    });
}

#[test]
fn case_and_blanks_do_not_matter() {
    let mut bench = boot_standing(Fidelity::DataSheet);
    assert_eq!(bench.say("  StaNd\t "), "ok stand");
    // Tries the gait with the most words in its name.
    let mut gaits = gait_commands();
    gaits.sort_by_key(|gait| gait.split(' ').count());
    let gait = gaits.pop().expect("stand at least");
    let typed = gait.to_uppercase().replacen(' ', "   \t", 1);
    assert!(
        bench.say(&format!(" {typed} ")).starts_with("ok "),
        "{typed}"
    );
    assert_eq!(Status::of(&mut bench).text("gait"), gait.replace(' ', "-"));
    assert!(bench.say(" speed\t50 ").starts_with("ok speed"));
    assert_eq!(Status::of(&mut bench).text("speed"), "50");
}

#[test]
fn a_line_may_have_63_characters_and_no_more() {
    let mut bench = boot_standing(Fidelity::DataSheet);
    let fits = format!("stand{}", " ".repeat(58));
    assert_eq!(bench.say(&fits), "ok stand");
    assert!(bench.say(&format!("{fits} ")).starts_with("err 6 "));
    assert!(bench.say(&"x".repeat(500)).starts_with("err 6 "));
    assert_eq!(bench.say("stop"), "ok stop", "the next line is a new one");
}

/// Returns poses that break a servo's travel, a margin and a slider's stroke, each with its error code. The pose for
/// the stroke is missing if, on this robot, each such pose also breaks a limit that the guard checks earlier.
fn refused_poses() -> Vec<(String, u8)> {
    let mut rng = Rng::with_seed(1);
    let mut found: [Option<String>; 3] = [None, None, None];
    let servos = robot().servos();
    for n in 0..400_000 {
        // Half of the poses are closer to neutral, where fewer limits are broken at once.
        let largest = [175.0, 90.0, 45.0, 25.0][n % 4];
        let sweeps: [f64; 4] = std::array::from_fn(|_| largest * (2.0 * rng.f64() - 1.0));
        let within = |by: f64| {
            servos.iter().zip(sweeps).all(|(servo, sweep)| {
                let (min, max) = servo.travel();
                min + by < sweep && sweep < max - by
            })
        };
        let index = if !within(-0.1) {
            0
        } else if !within(0.1) {
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
        found[index].get_or_insert_with(|| pose_command(sweeps));
        if found.iter().all(Option::is_some) {
            break;
        }
    }
    let [travel, margin, stroke] = found;
    let travel = travel.expect("some servo does not turn by 175 degrees either way");
    let margin = margin.expect("some pose breaks a margin");
    let stroke = stroke.map(|line| (line, 5));
    println!("a pose that breaks a stroke alone: {stroke:?}");
    [(travel, 3), (margin, 4)]
        .into_iter()
        .chain(stroke)
        .collect()
}

/// Returns the error code of a pose within the travel; `None` if the pose is allowed, or so close to a limit that
/// rounding decides its code. The guard first checks the margins of both five-bars; for the guard, crossed crank tips
/// are a type-2 margin below 0. It checks the strokes last.
fn certain_refusal_code(solution: &Solution) -> Option<u8> {
    let broken = |by: f64, stroke: bool| {
        let mut all = stricter_limits(by).violations(solution);
        all.any(|violation| Check::STROKE.contains(&violation.check) == stroke)
    };
    let size = robot().lizard().links.l10 / 135.0;
    let ends = [&solution.head, &solution.tail];
    let doubtful = ends.iter().any(|end| end.gap.x.abs() < size);
    match (broken(-0.05, false), broken(0.05, false)) {
        _ if doubtful => None,
        (true, _) => Some(4),
        (false, false) if broken(-0.05, true) => Some(5),
        _ => None,
    }
}

/// Returns the robot's limits, made stricter by `by`: the sines by `by`, and the strokes by `10 * by` mm for a robot
/// of the paper's size.
fn stricter_limits(by: f64) -> Limits {
    let limits = robot().limits();
    let size = robot().lizard().links.l10 / 135.0;
    Limits {
        type2: limits.type2 + by,
        type1: limits.type1 + by,
        leg: limits.leg + by,
        stroke_min: limits.stroke_min + 10.0 * by * size,
        stroke_max: limits.stroke_max - 10.0 * by * size,
    }
}

#[test]
fn every_refusal_has_its_code_and_changes_nothing() {
    let refused = [
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
    let poses = refused_poses();
    let poses = poses.iter().map(|(line, code)| (line.as_str(), *code));
    let refused: Vec<(&str, u8)> = refused.into_iter().chain(poses).collect();
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_and_command(&first_moving_gait(), fidelity);
        let mut quiet = boot_and_command(&first_moving_gait(), fidelity);
        for &(line, code) in &refused {
            let answer = bench.say(line);
            let expected = format!("err {code} ");
            assert!(
                answer.starts_with(&expected) && answer.len() > expected.len(),
                "{line}: {answer}"
            );
        }
        // Both boards must have walked for the same time before they are compared.
        for board in [&mut bench, &mut quiet] {
            let left = 4 * FREQUENCY - board.uno.cycle();
            board.uno.run_cycles(left);
        }
        assert_eq!(
            bench.run_for_frames(2 * FRAMES_PER_SECOND),
            quiet.run_for_frames(2 * FRAMES_PER_SECOND)
        );
        let (printed, untold) = (Status::of(&mut bench), Status::of(&mut quiet));
        assert_eq!(printed.0, untold.0);
    });
}

#[test]
fn while_the_servos_rest_only_stand_moves_them() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_standing(fidelity);
        assert_eq!(bench.say("rest"), "ok rest");
        let others = gait_commands().into_iter().skip(1);
        for line in others.chain(["stop".into(), pose_command([0.0; 4])]) {
            assert!(bench.say(&line).starts_with("err 7 "), "{line}");
        }
        for line in ["rest", "speed 80", "watch 0", "help", "status"] {
            assert!(bench.say(line).starts_with("ok "), "{line}");
        }
        bench.run_ms(100);
        assert!(
            bench
                .run_for_frames(10)
                .iter()
                .all(|frame| frame.is_silent())
        );
        assert_eq!(bench.say("stand"), "ok stand");
        bench.run_ms(1000);
        assert_eq!(
            bench.say(&first_moving_gait()),
            format!("ok {}", first_moving_gait())
        );
    });
}

#[test]
fn help_names_every_gait_and_every_command() {
    let mut bench = boot_standing(Fidelity::DataSheet);
    for line in ["help", "?"] {
        let (notes, answer) = bench.ask(line);
        assert_eq!(answer, "ok help");
        let text = notes.join("\n");
        for gait in robot().gaits() {
            assert!(
                text.contains(&gait.name().replace('-', " ")),
                "{}",
                gait.name()
            );
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
        let status = Status::of(&mut bench);
        let sent = servo_frames_of(robot(), &bench.run_for_frames(1))[0]
            .angles
            .expect("four pulses");
        for (servo, (printed, sent)) in status.pose().into_iter().zip(sent).enumerate() {
            assert!(
                (printed - sent).abs() <= MAX_PRINT_ERROR,
                "{servo}: {printed} and {sent}"
            );
        }
        let solution = robot().lizard().solve(&sent.into()).expect("a safe pose");
        let margin = solution.margins.min().1;
        assert!((status.number("margin") - margin).abs() <= 0.0025);
        assert_eq!(status.text("gait"), "stop");
        assert_eq!(status.number("late"), 0.0);
        assert_eq!(status.number("rx_lost"), 0.0);
        assert!((0.0..1.0).contains(&status.number("phase")));
    });
}

#[test]
fn status_counts_fifty_frames_a_second_and_follows_the_phase() {
    let mut bench = boot_and_command(&first_moving_gait(), Fidelity::DataSheet);
    bench.run_ms(3000); // the move to the gait's first pose
    let moving = first_moving_gait();
    let gait = robot().gait(&moving).expect("a gait");
    let mut last: Option<(u64, Status)> = None;
    for _ in 0..20 {
        bench.run_for_frames(0); // up to the start of the next frame
        let now = (bench.uno.cycle(), Status::of(&mut bench));
        if let Some((cycle, before)) = last {
            let frames = (now.0 - cycle) as f64 * 50.0 / FREQUENCY as f64;
            let counted = now.1.number("frames") - before.number("frames");
            assert_eq!(counted, frames.round());
            let turned = now.1.number("phase") - before.number("phase");
            let expected = frames.round() / 50.0 / gait.period();
            let expected = if gait.is_reversed() {
                -expected
            } else {
                expected
            };
            let error = (turned - expected).rem_euclid(1.0);
            // A phase is printed to a thousandth.
            assert!(
                error.min(1.0 - error) <= 0.0021,
                "{turned} in {frames} frames"
            );
        }
        last = Some(now);
        bench.run_ms(470);
    }
}

#[test]
fn watch_reports_the_pose_of_every_nth_frame_until_it_is_switched_off() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_and_command(&first_moving_gait(), fidelity);
        assert_eq!(bench.say("watch 7"), "ok watch 7");
        let received = bench.lines().len();
        let frames = bench.run_for_frames(75);
        let sent = servo_frames_of(robot(), &frames);
        // A report after the beginning of the last frame may belong to the next one.
        let end = frames[74].start;
        let lines: Vec<String> = bench.lines()[received..]
            .iter()
            .filter(|line| line.cycle < end)
            .map(|line| line.text.clone())
            .collect();
        assert!((10..=11).contains(&lines.len()), "{lines:?}");
        let mut last = None;
        for line in &lines {
            let rest = line.strip_prefix("# t=").expect("a report");
            let (time, pose) = rest.split_once(" pose=").expect("a pose");
            let time: u64 = time.parse().expect("a frame");
            assert!(last.is_none_or(|last| time == last + 7), "{lines:?}");
            last = Some(time);
            let printed = parse_angles(pose);
            let is_sent = sent.iter().any(|at| {
                let sent = at.angles.expect("four pulses");
                (0..4).all(|i| (printed[i] - sent[i]).abs() <= MAX_PRINT_ERROR)
            });
            assert!(is_sent, "{line} was never sent");
        }
        assert_eq!(bench.say("watch 0"), "ok watch 0");
        let received = bench.lines().len();
        bench.run_ms(500);
        assert_eq!(bench.lines().len(), received);
    });
}

#[test]
fn half_speed_takes_twice_the_time() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_and_command(&first_moving_gait(), fidelity);
        bench.run_ms(3000); // the move to the gait's first pose
        let moving = first_moving_gait();
        let gait = robot().gait(&moving).expect("a gait");
        // The pace is a multiple of 1/1024, so a pace of 10 % has an error of up to half a percent.
        let frames = (gait.period() * FRAMES_PER_SECOND as f64).ceil() as u64;
        let fastest = robot().pace().gait_slew / FRAMES_PER_SECOND as f64;
        let mut spans: Vec<u64> = Vec::new();
        for (percent, times) in [(100, 1), (50, 2), (10, 10)] {
            let line = format!("speed {percent}");
            assert_eq!(bench.say(&line), format!("ok {line}"));
            bench.run_ms(500);
            let cycle = times * frames;
            let sent = widths(&bench.run_for_frames(2 * cycle));
            let (once, again) = sent.split_at(cycle as usize);
            for (i, servo) in robot().servos().iter().enumerate() {
                // Allows half a percent of a cycle, and the part of a frame by which a cycle is no whole number of
                // frames.
                let frame = 16.0 * servo.us_per_degree.abs() * fastest;
                let max = 0.005 * gait.period() * FRAMES_PER_SECOND as f64 * frame + frame + 2.0;
                for (here, later) in once.iter().zip(again) {
                    let error = here[i].abs_diff(later[i]) as f64;
                    assert!(error <= max, "{percent} %: {error} cycles after a cycle");
                }
            }
            // In a cycle, each leg makes its whole sweep at any speed.
            let column = || once.iter().map(|widths| widths[0]);
            spans.push(column().max().unwrap_or(0) - column().min().unwrap_or(0));
        }
        let frame = 16.0 * robot().servos()[0].us_per_degree.abs() * fastest;
        let alike = |span: &u64| span.abs_diff(spans[0]) as f64 <= 2.0 * frame;
        assert!(spans.iter().all(alike), "{spans:?}");
    });
}
