//! One line in, one answer out, and what the answer means for the pulses.

use lizard_host::sim::analysis::instants;
use lizard_host_tests::{FirmwareBench, robot};
use simulated_uno::{FREQUENCY, Fidelity};

use crate::{SECOND, Status, angles, awake, doing, in_both, widths};

/// Half a step of the console's two decimals, of a pulse and of the firmware's
/// neutral angle, deg.
const PRINTED: f64 = 0.005 + 0.0032 + 0.0028;

#[test]
fn half_a_second_after_power_on_there_is_a_banner_and_after_one_an_answer() {
    in_both(|fidelity| {
        let mut bench = FirmwareBench::boot_with(fidelity);
        let hash = robot().firmware().hash();
        let banner = bench.lines()[0].text.clone();
        assert!(banner.starts_with("# lizard "), "{banner}");
        assert!(banner.contains(&format!(" tables {hash:08x}")), "{banner}");
        assert!(bench.say("status").starts_with("ok gait=stand "));
        assert!(bench.uno.cycle() < FREQUENCY);
    });
}

#[test]
fn cr_and_lf_and_crlf_each_end_one_line() {
    in_both(|fidelity| {
        for end in ["\r", "\n", "\r\n"] {
            let mut bench = awake(fidelity);
            let before = bench.lines().len();
            let text = format!("{end}{end} \t{end}walk{end}{end}stop{end}status{end}");
            bench.uno.send(text.as_bytes());
            bench.run_ms(300);
            let said: Vec<&str> = bench.lines()[before..]
                .iter()
                .map(|line| line.text.as_str())
                .collect();
            assert_eq!(said.len(), 3, "{end:?}: {said:?}");
            assert_eq!(said[..2], ["ok walk", "ok stop"]);
            assert!(said[2].starts_with("ok gait=stop "));
        }
    });
}

#[test]
fn case_and_blanks_do_not_matter() {
    let mut bench = awake(Fidelity::DataSheet);
    assert_eq!(bench.say("  WaLk\t "), "ok walk");
    assert!(bench.say("ARC    Left").starts_with("ok arc"));
    assert_eq!(Status::of(&mut bench).text("gait"), "arc-left");
    assert!(bench.say(" speed\t50 ").starts_with("ok speed"));
    assert_eq!(Status::of(&mut bench).text("speed"), "50");
}

#[test]
fn a_line_may_have_63_characters_and_no_more() {
    let mut bench = awake(Fidelity::DataSheet);
    let fits = format!("walk{}", " ".repeat(59));
    assert_eq!(bench.say(&fits), "ok walk");
    assert!(bench.say(&format!("{fits} ")).starts_with("err 6 "));
    assert!(bench.say(&"x".repeat(500)).starts_with("err 6 "));
    assert_eq!(bench.say("stop"), "ok stop", "the next line is a new one");
}

#[test]
fn every_refusal_has_its_code_and_changes_nothing() {
    let refused = [
        ("gallop", 1),
        ("walkies", 1),
        ("s\u{7}op", 1),
        ("speed", 2),
        ("speed fast", 2),
        ("speed 50 60", 2),
        ("watch", 2),
        ("watch -1", 2),
        ("arc", 2),
        ("walk on", 2),
        ("stop now", 2),
        ("pose 138.59 41.41 318.59", 2),
        ("pose 138.59 41.41 318.59 221.41 0", 2),
        ("pose 138.591 41.41 318.59 221.41", 2),
        ("pose a b c d", 2),
        ("speed 9", 3),
        ("speed 101", 3),
        ("speed 65546", 3),
        ("watch 10001", 3),
        ("pose 48 41.41 318.59 221.41", 3),
        ("pose 138.59 41.41 318.59 720", 3),
        ("pose 90 90 318.59 221.41", 4),
        ("pose 138.59 41.41 270 270", 4),
        ("pose 100 80 260 280", 4),
        ("pose 92 51.3 334.7 292.2", 5),
        ("pose 161 112.4 254.4 223.6", 5),
        (&"stop".repeat(16), 6),
    ];
    in_both(|fidelity| {
        let mut bench = doing("walk", fidelity);
        let mut quiet = doing("walk", fidelity);
        for (line, code) in refused {
            let answer = bench.say(line);
            let expected = format!("err {code} ");
            assert!(
                answer.starts_with(&expected) && answer.len() > expected.len(),
                "{line}: {answer}"
            );
        }
        // Both have been walking for the same time when they are compared.
        for board in [&mut bench, &mut quiet] {
            let left = 3 * FREQUENCY - board.uno.cycle();
            board.uno.run_cycles(left);
        }
        assert_eq!(
            bench.run_for_frames(2 * SECOND),
            quiet.run_for_frames(2 * SECOND)
        );
        let (told, untold) = (Status::of(&mut bench), Status::of(&mut quiet));
        assert_eq!(told.0, untold.0);
    });
}

#[test]
fn while_the_servos_rest_only_stand_moves_them() {
    in_both(|fidelity| {
        let mut bench = awake(fidelity);
        assert_eq!(bench.say("rest"), "ok rest");
        for line in ["walk", "look", "stop", "pose 138.59 41.41 318.59 221.41"] {
            assert!(bench.say(line).starts_with("err 7 "), "{line}");
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
        assert_eq!(bench.say("walk"), "ok walk");
    });
}

#[test]
fn help_names_every_gait_and_every_command() {
    let mut bench = awake(Fidelity::DataSheet);
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
        for word in ["stop", "rest", "speed", "pose", "status", "watch"] {
            assert!(text.contains(&format!("# {word}")), "{word}");
        }
    }
}

#[test]
fn status_tells_what_the_pulses_show() {
    in_both(|fidelity| {
        let mut bench = doing("walk", fidelity);
        bench.say("stop");
        bench.run_ms(100);
        let status = Status::of(&mut bench);
        let sent = instants(robot(), &bench.run_for_frames(1))[0]
            .angles
            .expect("four pulses");
        for (servo, (said, sent)) in status.pose().into_iter().zip(sent).enumerate() {
            assert!((said - sent).abs() <= PRINTED, "{servo}: {said} and {sent}");
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
    let mut bench = doing("walk", Fidelity::DataSheet);
    let mut last: Option<(u64, Status)> = None;
    for _ in 0..20 {
        bench.run_for_frames(0); // up to the start of the next frame
        let now = (bench.uno.cycle(), Status::of(&mut bench));
        if let Some((cycle, before)) = last {
            let frames = (now.0 - cycle) as f64 * 50.0 / FREQUENCY as f64;
            let counted = now.1.number("frames") - before.number("frames");
            assert_eq!(counted, frames.round());
            let turned = now.1.number("phase") - before.number("phase");
            let off = (turned - frames.round() / 50.0).rem_euclid(1.0);
            assert!(off.min(1.0 - off) <= 0.0011, "{turned} in {frames} frames");
        }
        last = Some(now);
        bench.run_ms(470);
    }
}

#[test]
fn watch_reports_the_pose_of_every_nth_frame_until_it_is_told_not_to() {
    in_both(|fidelity| {
        let mut bench = doing("walk", fidelity);
        assert_eq!(bench.say("watch 7"), "ok watch 7");
        let heard = bench.lines().len();
        let frames = bench.run_for_frames(75);
        let sent = instants(robot(), &frames);
        // What is told after the last frame has begun may be about the next.
        let end = frames[74].start;
        let lines: Vec<String> = bench.lines()[heard..]
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
            let said = angles(pose);
            let is_sent = sent.iter().any(|at| {
                let sent = at.angles.expect("four pulses");
                (0..4).all(|i| (said[i] - sent[i]).abs() <= PRINTED)
            });
            assert!(is_sent, "{line} was never sent");
        }
        assert_eq!(bench.say("watch 0"), "ok watch 0");
        let heard = bench.lines().len();
        bench.run_ms(500);
        assert_eq!(bench.lines().len(), heard);
    });
}

#[test]
fn half_speed_takes_twice_the_time() {
    in_both(|fidelity| {
        let mut bench = doing("walk", fidelity);
        // The pace is a whole number of 1/1024, so that 10 % is within half a
        // percent of itself: at 300 deg/s, 240 CPU cycles of pulse in a cycle.
        let cases = [
            (50, 2 * SECOND, 2),
            (10, 10 * SECOND, 240),
            (100, SECOND, 2),
        ];
        for (percent, cycle, most) in cases {
            let line = format!("speed {percent}");
            assert_eq!(bench.say(&line), format!("ok {line}"));
            bench.run_ms(500);
            let sent = widths(&bench.run_for_frames(2 * cycle));
            let (once, again) = sent.split_at(cycle as usize);
            for (here, later) in once.iter().zip(again) {
                let off = (0..4).map(|i| here[i].abs_diff(later[i])).max();
                assert!(off <= Some(most), "{percent} %: {off:?} after a cycle");
            }
            // In that time each leg goes all the way, 20 deg forth and back.
            let least = once.iter().map(|widths| widths[0]).min();
            let most = once.iter().map(|widths| widths[0]).max();
            assert!(least < Some(20_900) && most > Some(27_100), "{percent} %");
        }
    });
}
