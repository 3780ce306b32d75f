//! The console as seen from the other end of the line.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use proptest::prelude::*;

mod calibration;
mod dialogue;
mod faults;

use super::*;
use crate::guard::Clearance;
use crate::motion::Activity;
use crate::pose::{Pose, Pulses};
use crate::restart::{Cause, Restart, Stance};
use crate::sample::{GAITS, Sample};
use crate::settings::Settings;
use crate::step::Step;
use crate::units::Width;
use crate::virtual_board::{Eeprom, VirtualBoard, is_final, reading};
use dialogue::{Dialogue, awake, pairs, standing, widths};

/// The neutral pose of the odd robot, as a command.
const NEUTRAL: &str = "pose 132.37 47.91 309.64 226.18";

#[test]
fn the_banner_names_version_and_tables_once() {
    for hash in [0, 0x1f0a_9c3e, 0x0000_00f0, u32::MAX, 0x9999_9999] {
        let mut dialogue = Dialogue::power_on(Sample::odd().with_hash(hash));
        let version = env!("CARGO_PKG_VERSION");
        let banner =
            format!("# lizard {version} robot sample {hash:08x}, send help for the commands");
        let blank = "# calibration: none is saved, robot.toml's is in use".to_string();
        assert_eq!(dialogue.lines(), [banner, blank]);
        assert!(dialogue.run(50).is_empty());
    }
}

#[test]
fn what_is_obeyed_is_answered_by_ok_and_the_line_as_it_was_understood() {
    let commands = [
        "stop",
        "rest",
        "speed 10",
        "speed 100",
        "watch 3",
        "watch 0",
        NEUTRAL,
    ];
    for command in commands.into_iter().chain(GAITS) {
        assert_eq!(standing().say(command), format!("ok {command}"));
        let shouted = format!("  {}\t", command.to_uppercase());
        assert_eq!(standing().say(&shouted), format!("ok {command}"));
    }
}

#[test]
fn help_lists_every_gait_and_every_command_and_may_be_asked_twice() {
    let mut dialogue = standing();
    let said = dialogue.send(b"help\r");
    let gaits = format!("# gaits: {}", GAITS.join("|"));
    let expected = [
        gaits.as_str(),
        "# others: help|?|stop|rest|status|pose|speed|watch|trim|limit|dir|scale|cal|center|save|load|factory|boot|deadman",
        "# a word alone tells what it wants, the docs what it does",
        "ok help",
    ];
    assert_eq!(said, expected);
    assert_eq!(dialogue.send(b"?\r"), expected);
}

#[test]
fn many_or_long_gait_names_take_several_lines_of_help_each_full_and_none_too_long() {
    for (count, length) in [
        (4, 48),
        (40, 5),
        (8, 23),
        (6, 28),
        (90, 1),
        (36, 48),
        (6, 21),
    ] {
        let mut robot = Sample::paper();
        for number in 0..count {
            robot = robot.with_gait(&format!("{number:x>length$}")[..length]);
        }
        let names: Vec<String> = crate::gait::GaitId::all(robot.gait_count())
            .map(|id| robot.name(id).map(char::from).collect())
            .collect();
        let said = awake(robot).send(b"help\r");
        let lines: Vec<&str> = said
            .iter()
            .filter_map(|line| line.strip_prefix("# gaits: "))
            .collect();
        let told: Vec<&str> = lines.iter().flat_map(|line| line.split('|')).collect();
        assert_eq!(told, names);
        // A line ends only where the next name has no room: with the line end,
        // the prefix and the bar.
        for pair in lines.windows(2) {
            let next = pair[1].split('|').next().expect("a name");
            let whole = "# gaits: ".len() + pair[0].len() + 1 + next.len() + "\r\n".len();
            assert!(whole > usize::from(LONGEST_LINE), "{pair:?}");
        }
    }
}

#[test]
fn status_tells_everything_as_key_and_value() {
    let mut dialogue = standing();
    dialogue.board.late = 7;
    dialogue.board.lose(65_535);
    dialogue.run(1);
    dialogue.say("speed 42");
    dialogue.say("sway left");
    dialogue.run(200);
    let line = dialogue.say("status");
    let motion = dialogue.motion();
    let phase = (u64::from(motion.phase()) * 1000) >> 24;
    let angles: Vec<String> = motion
        .pose()
        .angles(&motion.robot().neutral())
        .iter()
        .map(|angle| {
            let centideg = angle.centideg();
            format!("{}.{:02}", centideg / 100, centideg % 100)
        })
        .collect();
    let margin = Clearance::of(motion.robot(), motion.pose())
        .smallest()
        .thousandths();
    let expected = format!(
        "ok gait=sway-left phase=0.{phase:03} pose={} margin=0.{margin:03} speed=42 frames={} \
         late=7 rx_lost=65535 guard=clear fault=none reset=power resets=0 vcc=5.00 rail=6.00",
        angles.join(","),
        motion.frames(),
    );
    assert_eq!(line, expected);
}

#[test]
fn status_names_what_the_robot_does() {
    let mut dialogue = standing();
    assert_eq!(dialogue.status("gait"), "stand");
    for (command, name) in [
        ("sway", "sway"),
        ("sway left", "sway-left"),
        (NEUTRAL, "pose"),
        ("stop", "stop"),
        ("rest", "rest"),
        ("stand", "stand"),
    ] {
        dialogue.say(command);
        assert_eq!(dialogue.status("gait"), name);
    }
}

#[test]
fn the_longest_status_that_there_can_be_fits_a_line() {
    let name = "longest name of a gait that any robot may have..";
    assert_eq!(name.len(), crate::gait::LONGEST_NAME);
    let robot = Sample::odd().with_gait(name);
    let mut dialogue = awake(robot);
    dialogue.board.late = u16::MAX;
    dialogue.board.lose(u16::MAX);
    assert_eq!(dialogue.say(name), format!("ok {name}"));
    let line = dialogue.say("status");
    // Each number as long as it gets.
    let values = pairs(line.strip_prefix("ok ").expect("a status"));
    let most = [
        ("phase", "0.999"),
        ("pose", "359.99,359.99,359.99,359.99"),
        ("margin", "-1.000"),
        ("speed", "100"),
        ("frames", "4294967295"),
        ("guard", "clear"),
    ];
    let more: usize = most
        .iter()
        .map(|(key, most)| most.len() - values[*key].len())
        .sum();
    assert!(line.len() + more + "\r\n".len() <= usize::from(LONGEST_LINE));
}

#[test]
fn watch_reports_the_pose_of_every_nth_frame_until_it_is_ended() {
    for every in [1u32, 2, 7, 50] {
        let mut dialogue = standing();
        dialogue.say("sway");
        dialogue.say(&format!("watch {every}"));
        let begin = dialogue.motion().frames();
        let mut times = Vec::new();
        for _ in 0..200 {
            for line in dialogue.run(1) {
                let report = pairs(line.strip_prefix("# ").expect("a report"));
                let time: u32 = report["t"].parse().expect("a number");
                assert_eq!(time, dialogue.motion().frames());
                assert_eq!(report["pose"], dialogue.status("pose"));
                assert_eq!(report.len(), 2);
                times.push(time - begin);
            }
        }
        let expected: Vec<u32> = (1..=200).filter(|time| time % every == 0).collect();
        assert_eq!(times, expected);
        dialogue.say("watch 0");
        assert!(dialogue.run(200).is_empty());
    }
}

#[test]
fn watch_goes_on_while_the_robot_rests_and_a_new_one_counts_from_its_own_beginning() {
    let mut dialogue = standing();
    dialogue.say("watch 5");
    dialogue.say("rest");
    assert_eq!(dialogue.run(50).len(), 10);
    dialogue.run(3);
    dialogue.say("watch 10");
    assert!(dialogue.run(9).is_empty());
    assert_eq!(dialogue.run(1).len(), 1);
}

#[test]
fn a_report_that_nobody_read_is_written_once_and_a_new_watch_ends_them() {
    let mut dialogue = standing();
    dialogue.say("watch 2");
    dialogue.run_unheard(20);
    assert_eq!(dialogue.lines().len(), 1);
    dialogue.run_unheard(2);
    assert!(dialogue.has_output());
    dialogue.board.send(b"watch 0\r");
    let said = dialogue.lines();
    assert!(said.len() == 2 && said[1] == "ok watch 0", "{said:?}");
    assert!(dialogue.run(10).is_empty());
}

/// A robot that the guard has just stopped, with nothing read since.
fn guarded() -> Dialogue {
    let mut dialogue = standing();
    dialogue.say("stray");
    for _ in 0..200 {
        dialogue.run_unheard(1);
        if dialogue.motion().hazard().is_some() {
            return dialogue;
        }
    }
    panic!("stray is safe");
}

#[test]
fn why_the_guard_holds_the_robot_is_told_once_and_status_goes_on_saying_so() {
    let mut dialogue = guarded();
    let told = dialogue.lines();
    assert_eq!(told.len(), 1);
    assert!(
        told[0].starts_with("# held in the last safe pose: "),
        "{told:?}"
    );
    assert!(told[0].contains(" margin of ") || told[0].contains(" slider is at "));
    assert!(dialogue.run(100).is_empty());
    assert_eq!(dialogue.status("guard"), "held");
    dialogue.say("stand");
    dialogue.run(1);
    assert_eq!(dialogue.status("guard"), "clear");
    dialogue.run(100);
    dialogue.say("stray");
    assert_eq!(
        dialogue.run(200).len(),
        1,
        "and again, when it happens again"
    );
}

#[test]
fn the_reason_is_still_told_when_stand_comes_before_it_could_be() {
    let mut dialogue = guarded();
    dialogue.board.send(b"stand\r");
    dialogue.run_unheard(3);
    let said = dialogue.lines();
    assert_eq!(said.len(), 2);
    assert!(said[0].starts_with("# held in the last safe pose: "));
    assert_eq!(said[1], "ok stand");
    assert!(!dialogue.has_output());
    dialogue.run(3);
    assert_eq!(dialogue.status("guard"), "clear");
}

#[test]
fn what_waits_is_written_in_one_order_banner_answer_fault_reason_report() {
    let mut dialogue = Dialogue::power_on(*Sample::odd());
    dialogue.board.send(b"stray\rwatch 1\rhelp\r");
    // Room for a line at a time, until the first one of the help is written.
    let mut said = Vec::new();
    let mut line = |dialogue: &mut Dialogue| {
        while !dialogue.board.transmitter.text.ends_with("\r\n") {
            assert_eq!(dialogue.main.step(&mut dialogue.board), Step::Worked);
        }
        said.push(core::mem::take(&mut dialogue.board.transmitter.text));
        said.last().expect("a line").starts_with("# gaits: ")
    };
    while !line(&mut dialogue) {}
    // The guard holds the robot, an edge comes late, a report is due.
    dialogue.run_unheard(199);
    assert!(dialogue.motion().hazard().is_some());
    dialogue.board.late = 1;
    dialogue.run_unheard(1);
    let rest = dialogue.lines();
    let starts = [
        "# lizard ",
        "# calibration: ",
        "ok stray",
        "ok watch 1",
        "# gaits: ",
        "# others: ",
        "# a word ",
        "ok help",
        "# fault: ",
        "# held ",
        "# t=200 pose=",
    ];
    said.extend(rest);
    assert_eq!(said.len(), starts.len(), "{said:?}");
    for (line, start) in said.iter().zip(starts) {
        assert!(line.starts_with(start), "{line}");
    }
}

#[test]
fn a_resting_robot_refuses_to_move_until_it_is_told_to_stand() {
    let unsafe_pose = "pose 95 90 309.64 226.18";
    for line in ["sway", "sway left", "stop", NEUTRAL, unsafe_pose] {
        let mut dialogue = standing();
        assert_eq!(dialogue.say("rest"), "ok rest");
        assert_eq!(
            dialogue.say(line),
            "err 7 servos are resting, send stand first"
        );
        for _ in 0..50 {
            assert_eq!(dialogue.frame(), Pulses::default(), "{line}");
        }
        assert_eq!(dialogue.status("gait"), "rest");
        // What moves nothing is answered, and a mistake is still a mistake.
        for line in ["speed 50", "watch 0", "rest", "help"] {
            assert_eq!(dialogue.say(line), format!("ok {line}"));
        }
        assert_eq!(
            dialogue.say("pose 1 2 3 4"),
            "err 3 A1 reaches 61.37..215.36"
        );
        assert!(dialogue.say("dance").starts_with("err 1 "));
        assert_eq!(dialogue.say("stand"), "ok stand");
        dialogue.run(25);
        assert!(dialogue.frame().0.iter().all(|width| *width > Width(0)));
    }
}

#[test]
fn travel_is_checked_before_margins_and_a_refusal_names_what_is_wrong() {
    let mut dialogue = standing();
    assert_eq!(
        dialogue.say("pose 400 1 1 1"),
        "err 3 A1 reaches 61.37..215.36"
    );
    assert_eq!(
        dialogue.say("pose 132 47 200 226"),
        "err 3 A3 reaches 235.64..18.64"
    );
    let refused = dialogue.say("pose 132.37 4 309.64 226.18");
    assert!(
        refused.starts_with("err 4 ") || refused.starts_with("err 5 "),
        "{refused}"
    );
    assert_eq!(dialogue.status("gait"), "stand");
}

#[test]
fn a_pose_that_is_accepted_is_reached_and_told_to_the_hundredth() {
    let mut dialogue = standing();
    for pose in ["130.00 50.00 311.00 224.50", "136.37 45.01 306.05 229.99"] {
        let line = format!("pose {pose}");
        assert_eq!(dialogue.say(&line), format!("ok {line}"));
        dialogue.run(120);
        assert_eq!(dialogue.status("pose"), pose.replace(' ', ","));
    }
}

#[test]
fn a_line_that_is_too_long_is_refused_and_the_next_one_is_read() {
    let mut dialogue = standing();
    let refused = "err 6 a line has at most 63 characters";
    assert_eq!(dialogue.say(&"stand".repeat(13)), refused);
    assert_eq!(dialogue.say("stand"), "ok stand");
}

/// Lines that are refused, in whatever state the robot is.
const REFUSED: [&str; 9] = [
    "dance",
    "sway fast",
    "speed 9",
    "speed",
    "watch 10001",
    "pose 1 2 3",
    "pose 400 1 1 1",
    "pose 132.37 1 309.64 226.18",
    "pose 170 130 309.64 226.18",
];

/// Bytes of a person, of a program gone mad, and of a broken cable.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    let mut lines = GAITS.to_vec();
    lines.extend([
        "help", "stop", "rest", "speed 33", "watch 9", "watch 0", "status", NEUTRAL,
    ]);
    lines.extend(REFUSED);
    let line = prop::sample::select(lines).prop_map(|line| format!("{line}\r").into_bytes());
    let piece = prop_oneof![
        4 => line,
        1 => prop::collection::vec(any::<u8>(), 0..40),
        1 => "[ -~\x08\x7f\t]{0,80}[\r\n]{0,2}".prop_map(String::into_bytes),
        2 => "(pose|speed|watch|sway|POSE)( [+-]?[0-9]{0,6}\\.?[0-9]{0,3}){0,5}\r\n"
            .prop_map(String::into_bytes),
    ];
    prop::collection::vec(piece, 0..12).prop_map(|pieces| pieces.concat())
}

/// The final lines that bytes are owed.
fn owed(bytes: &[u8]) -> usize {
    let mut line = Line::new();
    bytes
        .iter()
        .filter(|byte| line.push(**byte).is_some())
        .count()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn every_line_of_any_bytes_gets_one_final_line_whatever_the_frames_between(
        bytes in bytes(),
        frames in 0u32..3,
    ) {
        let (mut at_once, mut apart) = (standing(), standing());
        let finals = |said: Vec<String>| -> Vec<String> {
            said.into_iter().filter(|line| is_final(line)).collect()
        };
        let once = finals(at_once.send(&bytes));
        prop_assert_eq!(once.len(), owed(&bytes));
        let mut said = Vec::new();
        for byte in &bytes {
            said.extend(apart.send(&[*byte]));
            said.extend(apart.run(frames));
        }
        // All but status say the same at any time.
        let timeless = |said: Vec<String>| -> Vec<String> {
            said.into_iter().filter(|line| !line.contains('=')).collect()
        };
        prop_assert_eq!(timeless(finals(said)), timeless(once));
    }

    #[test]
    fn a_refused_line_changes_nothing(
        history in prop::collection::vec((prop::sample::select(GAITS.to_vec()), 0u32..90), 0..4),
        speed in 10u8..=100,
        line in prop::sample::select(REFUSED.to_vec()),
    ) {
        let [mut asked, mut spared] = [(); 2].map(|()| standing());
        for dialogue in [&mut asked, &mut spared] {
            dialogue.say(&format!("speed {speed}"));
            for (gait, frames) in &history {
                dialogue.say(gait);
                dialogue.run(*frames);
            }
        }
        prop_assert!(asked.say(line).starts_with("err "));
        for _ in 0..40 {
            prop_assert_eq!(asked.frame(), spared.frame());
            prop_assert_eq!(asked.lines(), spared.lines());
        }
        prop_assert_eq!(asked.say("status"), spared.say("status"));
    }
}
