//! Tests of the console over its serial port: they send commands and check the printed lines.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use proptest::prelude::*;

mod calibration;
mod counts;
mod effect;
mod faults;
mod helpers;
mod inputs;
mod memory;
mod refused_and_random_lines;
mod routines;
mod status;

use super::*;
use crate::console::word::Word;
use crate::guard::clearance::Clearance;
use crate::memory::restart::{Cause, Restart, ServoState};
use crate::memory::settings::Settings;
use crate::motion::Activity;
use crate::numbers::gaits::Step;
use crate::numbers::pose::{Pose, Pulses};
use crate::numbers::units::PulseWidth;
use crate::sample::{GAIT_NAMES, SLOW_PACE, Sample};
use crate::step::StepResult;
use crate::virtual_board::{Eeprom, RunningRobot, VirtualBoard, is_answer};
use helpers::{
    activity_name, assert_line_starts, format_neutral_pose, measure_phase_advance, parse_pairs,
    rest_pose_mark, run_frame_and_read_widths, set_board_supply, start_patrol, wake_and_run,
    wake_and_send, wake_asymmetric_robot, wake_robot,
};

/// The command for the neutral pose of [`Sample::asymmetric`].
const NEUTRAL_COMMAND: &str = "pose 132.37 47.91 309.64 226.18";

#[test]
fn the_banner_with_version_and_robot_is_printed_once() {
    for hash in [0, 0x1f0a_9c3e, 0x0000_00f0, u32::MAX, 0x9999_9999] {
        let mut robot = RunningRobot::power_on(Sample::asymmetric().with_hash(hash));
        let version = env!("CARGO_PKG_VERSION");
        let banner =
            format!("# lizard {version} robot sample {hash:08x}, send help for the commands");
        let calibration_notice = "# calibration: none saved, using robot.toml's".to_string();
        assert_eq!(robot.read_lines(), [banner, calibration_notice]);
        assert!(robot.run_frames(50).is_empty());
    }
}

#[test]
fn an_accepted_line_is_answered_with_ok_and_the_line_in_lower_case() {
    let commands = [
        "stop",
        "rest",
        "speed 10",
        "speed 100",
        "watch 3",
        "watch 0",
        NEUTRAL_COMMAND,
    ];
    for command in commands.into_iter().chain(GAIT_NAMES) {
        wake_asymmetric_robot().expect_accepted(command);
        let upper_case_line = format!("  {}\t", command.to_uppercase());
        let answer = wake_asymmetric_robot().send_line(&upper_case_line);
        assert_eq!(answer, format!("ok {command}"));
    }
}

#[test]
fn help_lists_every_gait_and_every_command_each_time() {
    let mut robot = wake_asymmetric_robot();
    let printed_lines = robot.send(b"help\r");
    let gaits_line = format!("# gaits: {}", GAIT_NAMES.join("|"));
    let words: Vec<&str> = Word::ALL.iter().map(|word| word.spelling()).collect();
    let words_line = format!("# others: {}", words.join("|"));
    let expected = [
        gaits_line.as_str(),
        words_line.as_str(),
        "# send a command alone for its usage; the docs explain it",
        "ok help",
    ];
    assert_eq!(printed_lines, expected);
    assert_eq!(robot.send(b"?\r"), expected);
}

#[test]
fn a_long_list_of_gaits_fills_each_line_of_help_before_the_next() {
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
        let names: Vec<String> = GaitId::all(robot.gait_count())
            .map(|id| robot.gait_name(id).map(char::from).collect())
            .collect();
        let printed_lines = wake_robot(robot).send(b"help\r");
        let lines: Vec<&str> = printed_lines
            .iter()
            .filter_map(|line| line.strip_prefix("# gaits: "))
            .collect();
        let listed_names: Vec<&str> = lines.iter().flat_map(|line| line.split('|')).collect();
        assert_eq!(listed_names, names);
        // A line ends only if the prefix, its names, a bar and the next name would exceed the limit.
        for pair in lines.windows(2) {
            let next_name = pair[1].split('|').next().expect("each line has a name");
            let joined_length = "# gaits: ".len() + pair[0].len() + 1 + next_name.len();
            let max_length = usize::from(print::MAX_GAIT_NAMES_LINE_BYTES);
            assert!(joined_length > max_length, "{pair:?}");
        }
    }
}

/// Runs a robot in the gait `stray` until the guard holds it, without reading its output.
fn run_until_held() -> RunningRobot {
    let mut robot = wake_and_send(&["stray"]);
    for _ in 0..200 {
        robot.run_without_reader(1);
        if robot.motion().hazard().is_some() {
            return robot;
        }
    }
    panic!("the guard has not held the robot in `stray`");
}

#[test]
fn each_hold_is_reported_once_and_status_shows_it_until_the_robot_moves_again() {
    let mut robot = run_until_held();
    let printed_lines = robot.read_lines();
    assert_line_starts(&printed_lines, &["# held in the last safe pose: "]);
    let hazard_texts = [" margin of ", " slider is at "];
    assert!(
        hazard_texts
            .iter()
            .any(|text| printed_lines[0].contains(text))
    );
    assert!(robot.run_frames(100).is_empty());
    robot.expect_status(&[("guard", "held"), ("fault", "guard")]);
    robot.send_and_run("stand", 1);
    robot.expect_status(&[("guard", "clear"), ("fault", "none")]);
    robot.run_frames(100);
    let printed_lines = robot.send_and_run("stray", 200);
    assert_eq!(
        printed_lines.len(),
        1,
        "a second hold must be reported again"
    );
}

#[test]
fn the_hold_reason_is_printed_even_if_stand_arrives_before_it() {
    let mut robot = run_until_held();
    robot.board.send(b"stand\r");
    robot.run_without_reader(3);
    let printed_lines = robot.read_lines();
    assert_eq!(printed_lines.len(), 2);
    assert!(printed_lines[0].starts_with("# held in the last safe pose: "));
    assert_eq!(printed_lines[1], "ok stand");
    assert!(!robot.has_output());
    robot.run_frames(3);
    assert_eq!(robot.status_value("guard"), "clear");
}

#[test]
fn pending_lines_are_written_in_the_order_banner_answer_notice_hold_reason_report() {
    let mut robot = RunningRobot::power_on(*Sample::asymmetric());
    robot.board.send(b"stray\rwatch 1\rhelp\r");
    // Every line is read as soon as it is written, up to the first line of `help`.
    let mut printed_lines: Vec<String> = Vec::new();
    let lists_gaits = |line: &String| line.starts_with("# gaits: ");
    while !printed_lines.last().is_some_and(lists_gaits) {
        while !robot.board.transmitter.text.ends_with("\r\n") {
            assert_eq!(robot.main.step(&mut robot.board), StepResult::Worked);
        }
        printed_lines.push(core::mem::take(&mut robot.board.transmitter.text));
    }
    // From here on the output is not read. Meanwhile the guard stops the robot, a pulse edge is late, and a report
    // becomes pending.
    robot.run_without_reader(199);
    assert!(robot.motion().hazard().is_some());
    robot.board.late_edges = 1;
    robot.run_without_reader(1);
    printed_lines.extend(robot.read_lines());
    let expected_starts = [
        "# lizard ",
        "# calibration: ",
        "ok stray",
        "ok watch 1",
        "# gaits: ",
        "# others: ",
        "# send a command ",
        "ok help",
        "# fault: ",
        "# held ",
        "# t=200 pose=",
    ];
    assert_line_starts(&printed_lines, &expected_starts);
}

#[test]
fn a_resting_robot_refuses_to_move_until_it_receives_stand() {
    let unsafe_pose = "pose 95 90 309.64 226.18";
    for line in ["sway", "sway left", "stop", NEUTRAL_COMMAND, unsafe_pose] {
        let mut robot = wake_and_send(&["rest"]);
        robot.expect_refused(line, "7 the servos are resting; send stand first");
        for _ in 0..50 {
            assert_eq!(robot.run_frame(), Pulses::default(), "{line}");
        }
        assert_eq!(robot.status_value("gait"), "rest");
        // Commands that move no servo are still executed, and errors are still reported.
        robot.expect_all_accepted(&["speed 50", "watch 0", "rest", "help"]);
        robot.expect_refused("pose 1 2 3 4", "3 A1 must be 61.37..215.36");
        robot.expect_refused("dance", "1 ");
        robot.send_and_run("stand", 25);
        let widths = robot.run_frame().0;
        assert!(widths.iter().all(|width| *width > PulseWidth(0)));
    }
}

#[test]
fn servo_travels_are_checked_before_the_margins() {
    let mut robot = wake_asymmetric_robot();
    robot.expect_refused("pose 400 1 1 1", "3 A1 must be 61.37..215.36");
    robot.expect_refused("pose 132 47 200 226", "3 A3 must be 235.64..18.64");
    let message = robot.send_line("pose 132.37 4 309.64 226.18");
    let is_guard_refusal = message.starts_with("err 4 ") || message.starts_with("err 5 ");
    assert!(is_guard_refusal, "{message}");
    assert_eq!(robot.status_value("gait"), "stand");
}

#[test]
fn an_accepted_pose_is_reached_and_reported_to_a_hundredth_of_a_degree() {
    let mut robot = wake_asymmetric_robot();
    for pose in ["130.00 50.00 311.00 224.50", "136.37 45.01 306.05 229.99"] {
        let line = format!("pose {pose}");
        robot.send_and_run(&line, 120);
        assert_eq!(robot.status_value("pose"), pose.replace(' ', ","));
    }
}
