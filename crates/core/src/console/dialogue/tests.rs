//! Tests of the console through its serial line: commands go in, printed lines come out.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use proptest::prelude::*;

mod any_line;
mod calibration;
mod counts;
mod dialogue;
mod effect;
mod faults;
mod inputs;
mod memory;
mod routines;
mod status;

use super::*;
use crate::console::word::Word;
use crate::guard::clearance::Clearance;
use crate::memory::restart::{Cause, Restart, Stance};
use crate::memory::settings::Settings;
use crate::motion::Activity;
use crate::numbers::pose::{Pose, Pulses};
use crate::numbers::units::Width;
use crate::sample::{GAITS, SLOW_PACE, Sample};
use crate::step::Step;
use crate::virtual_board::{Eeprom, VirtualBoard, is_final};
use dialogue::{Dialogue, neutral, pairs, supply, wake_odd_robot, wake_robot, widths};

/// The command for the neutral pose of [`Sample::odd`].
const NEUTRAL: &str = "pose 132.37 47.91 309.64 226.18";

#[test]
fn the_banner_names_version_and_robot_once() {
    for hash in [0, 0x1f0a_9c3e, 0x0000_00f0, u32::MAX, 0x9999_9999] {
        let mut dialogue = Dialogue::power_on(Sample::odd().with_hash(hash));
        let version = env!("CARGO_PKG_VERSION");
        let banner =
            format!("# lizard {version} robot sample {hash:08x}, send help for the commands");
        let calibration_line = "# calibration: none is saved, robot.toml's is in use".to_string();
        assert_eq!(dialogue.read_lines(), [banner, calibration_line]);
        assert!(dialogue.run_frames(50).is_empty());
    }
}

#[test]
fn an_accepted_line_is_answered_by_ok_and_the_line_in_lower_case() {
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
        assert_eq!(wake_odd_robot().send_line(command), format!("ok {command}"));
        let upper_case_line = format!("  {}\t", command.to_uppercase());
        assert_eq!(
            wake_odd_robot().send_line(&upper_case_line),
            format!("ok {command}")
        );
    }
}

#[test]
fn help_lists_every_gait_and_every_command_and_may_be_asked_twice() {
    let mut dialogue = wake_odd_robot();
    let printed_lines = dialogue.send(b"help\r");
    let gaits_line = format!("# gaits: {}", GAITS.join("|"));
    let words: Vec<&str> = Word::ALL.iter().map(|word| word.text()).collect();
    let words_line = format!("# others: {}", words.join("|"));
    let expected = [
        gaits_line.as_str(),
        words_line.as_str(),
        "# a word alone tells what it wants, the docs what it does",
        "ok help",
    ];
    assert_eq!(printed_lines, expected);
    assert_eq!(dialogue.send(b"?\r"), expected);
}

#[test]
fn many_or_long_gait_names_fill_several_lines_of_help_and_none_is_too_long() {
    for (count, length) in [
        (4, 48),
        (40, 5),
        (8, 23),
        (6, 28),
        (70, 1),
        (26, 48),
        (6, 21),
    ] {
        let mut robot = Sample::paper();
        for number in 0..count {
            robot = robot.with_gait(&format!("{number:x>length$}")[..length]);
        }
        let names: Vec<String> = crate::numbers::gaits::GaitId::all(robot.gait_count())
            .map(|id| robot.name(id).map(char::from).collect())
            .collect();
        let printed_lines = wake_robot(robot).send(b"help\r");
        let lines: Vec<&str> = printed_lines
            .iter()
            .filter_map(|line| line.strip_prefix("# gaits: "))
            .collect();
        let listed: Vec<&str> = lines.iter().flat_map(|line| line.split('|')).collect();
        assert_eq!(listed, names);
        // A line ends only where the prefix, its names, a bar and the next name would be too long.
        for pair in lines.windows(2) {
            let next_name = pair[1].split('|').next().expect("a name");
            let joined_length = "# gaits: ".len() + pair[0].len() + 1 + next_name.len();
            assert!(
                joined_length > usize::from(print::LONGEST_NAMES),
                "{pair:?}"
            );
        }
    }
}

/// A robot that the guard has just stopped, and whose output has not been read since.
fn run_until_guarded() -> Dialogue {
    let mut dialogue = wake_odd_robot();
    dialogue.send_line("stray");
    for _ in 0..200 {
        dialogue.run_without_reader(1);
        if dialogue.motion().hazard().is_some() {
            return dialogue;
        }
    }
    panic!("stray is safe");
}

#[test]
fn the_guards_reason_is_printed_once_and_stays_in_status() {
    let mut dialogue = run_until_guarded();
    let printed_lines = dialogue.read_lines();
    assert_eq!(printed_lines.len(), 1);
    assert!(
        printed_lines[0].starts_with("# held in the last safe pose: "),
        "{printed_lines:?}"
    );
    assert!(
        printed_lines[0].contains(" margin of ") || printed_lines[0].contains(" slider is at ")
    );
    assert!(dialogue.run_frames(100).is_empty());
    assert_eq!(dialogue.status("guard"), "held");
    assert_eq!(dialogue.status("fault"), "guard");
    dialogue.send_line("stand");
    dialogue.run_frames(1);
    assert_eq!(dialogue.status("guard"), "clear");
    assert_eq!(dialogue.status("fault"), "none");
    dialogue.run_frames(100);
    dialogue.send_line("stray");
    assert_eq!(
        dialogue.run_frames(200).len(),
        1,
        "and again, when it happens again"
    );
}

#[test]
fn the_reason_is_still_printed_if_stand_comes_before_it_could_be() {
    let mut dialogue = run_until_guarded();
    dialogue.board.send(b"stand\r");
    dialogue.run_without_reader(3);
    let printed_lines = dialogue.read_lines();
    assert_eq!(printed_lines.len(), 2);
    assert!(printed_lines[0].starts_with("# held in the last safe pose: "));
    assert_eq!(printed_lines[1], "ok stand");
    assert!(!dialogue.has_output());
    dialogue.run_frames(3);
    assert_eq!(dialogue.status("guard"), "clear");
}

#[test]
fn pending_lines_are_written_in_this_order_banner_answer_fault_reason_report() {
    let mut dialogue = Dialogue::power_on(*Sample::odd());
    dialogue.board.send(b"stray\rwatch 1\rhelp\r");
    // Every line is read as soon as it is written, until the first line of the help.
    let mut printed_lines = Vec::new();
    let mut reads_gaits_line = |dialogue: &mut Dialogue| {
        while !dialogue.board.transmitter.text.ends_with("\r\n") {
            assert_eq!(dialogue.main.step(&mut dialogue.board), Step::Worked);
        }
        printed_lines.push(core::mem::take(&mut dialogue.board.transmitter.text));
        printed_lines
            .last()
            .expect("a line")
            .starts_with("# gaits: ")
    };
    while !reads_gaits_line(&mut dialogue) {}
    // From here nobody reads. Meanwhile the guard stops the robot, an edge comes late, and a report is due.
    dialogue.run_without_reader(199);
    assert!(dialogue.motion().hazard().is_some());
    dialogue.board.late_edges = 1;
    dialogue.run_without_reader(1);
    let later_lines = dialogue.read_lines();
    let expected_starts = [
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
    printed_lines.extend(later_lines);
    assert_eq!(
        printed_lines.len(),
        expected_starts.len(),
        "{printed_lines:?}"
    );
    for (line, start) in printed_lines.iter().zip(expected_starts) {
        assert!(line.starts_with(start), "{line}");
    }
}

#[test]
fn a_resting_robot_refuses_to_move_until_it_is_told_to_stand() {
    let unsafe_pose = "pose 95 90 309.64 226.18";
    for line in ["sway", "sway left", "stop", NEUTRAL, unsafe_pose] {
        let mut dialogue = wake_odd_robot();
        dialogue.expect_accepted("rest");
        dialogue.expect_refused(line, "7 servos are resting, send stand first");
        for _ in 0..50 {
            assert_eq!(dialogue.frame(), Pulses::default(), "{line}");
        }
        assert_eq!(dialogue.status("gait"), "rest");
        // Commands that move nothing are still obeyed, and errors are still reported.
        for line in ["speed 50", "watch 0", "rest", "help"] {
            dialogue.expect_accepted(line);
        }
        dialogue.expect_refused("pose 1 2 3 4", "3 A1 reaches 61.37..215.36");
        dialogue.expect_refused("dance", "1 ");
        dialogue.expect_accepted("stand");
        dialogue.run_frames(25);
        assert!(dialogue.frame().0.iter().all(|width| *width > Width(0)));
    }
}

#[test]
fn travel_is_checked_before_margins_and_a_refusal_names_what_is_wrong() {
    let mut dialogue = wake_odd_robot();
    dialogue.expect_refused("pose 400 1 1 1", "3 A1 reaches 61.37..215.36");
    dialogue.expect_refused("pose 132 47 200 226", "3 A3 reaches 235.64..18.64");
    let message = dialogue.send_line("pose 132.37 4 309.64 226.18");
    assert!(
        message.starts_with("err 4 ") || message.starts_with("err 5 "),
        "{message}"
    );
    assert_eq!(dialogue.status("gait"), "stand");
}

#[test]
fn a_pose_that_is_accepted_is_reached_and_told_to_the_hundredth() {
    let mut dialogue = wake_odd_robot();
    for pose in ["130.00 50.00 311.00 224.50", "136.37 45.01 306.05 229.99"] {
        let line = format!("pose {pose}");
        dialogue.expect_accepted(&line);
        dialogue.run_frames(120);
        assert_eq!(dialogue.status("pose"), pose.replace(' ', ","));
    }
}
