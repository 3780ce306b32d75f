//! Helpers that wake a robot on a virtual board, send lines to it and read its answers.

use std::collections::HashMap;

use super::*;
use crate::numbers::units::CYCLE;
use crate::virtual_board::compute_reading;

/// The number of frames until the robot stands and may begin to move.
pub(super) const WAKING_FRAMES: u32 = 21;

impl RunningRobot {
    /// Sends a line that must be accepted, and runs frames. Returns the lines printed after the answer.
    #[track_caller]
    pub(crate) fn send_and_run(&mut self, line: &str, frames: u32) -> Vec<String> {
        self.expect_accepted(line);
        self.run_frames(frames)
    }

    /// Sends lines that must be accepted.
    #[track_caller]
    pub(super) fn expect_all_accepted(&mut self, lines: &[&str]) {
        for line in lines {
            self.expect_accepted(line);
        }
    }

    /// Checks several values of the status.
    #[track_caller]
    pub(super) fn expect_status(&mut self, values: &[(&str, &str)]) {
        for (key, value) in values {
            assert_eq!(self.status_value(key), *value, "{key}");
        }
    }

    /// Sets the supply voltage of the board, and runs frames. Returns the printed lines.
    pub(super) fn run_at_supply(&mut self, board_mv: u32, frames: u32) -> Vec<String> {
        set_board_supply(self, board_mv);
        self.run_frames(frames)
    }

    /// Powers on another robot like this one, with a copy of this robot's EEPROM.
    pub(super) fn power_on_copy(&self) -> Self {
        let memory = self.board.memory.clone();
        Self::with_eeprom(*self.motion().robot(), memory, Restart::NONE)
    }
}

/// Powers on the asymmetric sample robot, reads its banner, and runs it until it is awake.
pub(super) fn wake_asymmetric_robot() -> RunningRobot {
    wake_robot(Sample::asymmetric())
}

/// Wakes the asymmetric sample robot, and sends lines that must be accepted.
#[track_caller]
pub(super) fn wake_and_send(lines: &[&str]) -> RunningRobot {
    let mut robot = wake_asymmetric_robot();
    robot.expect_all_accepted(lines);
    robot
}

/// Wakes the asymmetric sample robot, sends a line that must be accepted, and runs frames.
#[track_caller]
pub(super) fn wake_and_run(line: &str, frames: u32) -> RunningRobot {
    let mut robot = wake_and_send(&[line]);
    robot.run_frames(frames);
    robot
}

/// Starts the asymmetric sample robot on the routine `patrol`, which executes these steps for `round_count` rounds, or
/// endlessly if that is 0.
pub(super) fn start_patrol(round_count: u16, steps: &[(u8, &str, u16)]) -> RunningRobot {
    let mut robot = wake_robot(Sample::asymmetric().with_routine("patrol", round_count, steps));
    robot.expect_accepted("patrol");
    robot
}

/// Powers on a robot, reads its banner, and runs it until it is awake.
pub(super) fn wake_robot(robot: Sample) -> RunningRobot {
    let mut robot = RunningRobot::power_on(*robot);
    let lines = robot.read_lines();
    let claim = "only the banner and the calibration notice are printed";
    assert_eq!(lines.len(), 2, "{claim}: {lines:?}");
    robot.run_frames(WAKING_FRAMES);
    robot
}

/// Checks that each line begins with its text in `starts`, and that there are no other lines.
#[track_caller]
pub(super) fn assert_line_starts(lines: &[String], starts: &[&str]) {
    assert_eq!(lines.len(), starts.len(), "{lines:?}");
    for (line, start) in lines.iter().zip(starts) {
        assert!(line.starts_with(start), "{line}");
    }
}

/// Returns the name of the current gait, or of another activity.
pub(super) fn activity_name(robot: &RunningRobot) -> String {
    let motion = robot.motion();
    match motion.activity() {
        Activity::Gait(id) => motion.robot().gait_name(id).map(char::from).collect(),
        activity => format!("{activity:?}"),
    }
}

/// Runs a frame and returns its pulse widths, CPU cycles.
pub(super) fn run_frame_and_read_widths(robot: &mut RunningRobot) -> [u16; 4] {
    robot.run_frame().0.map(|width| width.0)
}

/// Runs frames. Returns the advance of the phase, 1/2^24 cycle.
pub(super) fn measure_phase_advance(robot: &mut RunningRobot, frames: u32) -> u32 {
    let phase_before = robot.motion().phase();
    robot.run_frames(frames);
    robot.motion().phase().wrapping_sub(phase_before) & (CYCLE - 1)
}

/// Splits a text into `key=value` pairs and checks that each key occurs only once.
pub(super) fn parse_pairs(text: &str) -> HashMap<String, String> {
    let mut pairs = HashMap::new();
    for word in text.split(' ') {
        let pair = word.split_once('=');
        let (key, value) = pair.expect("each word has the form key=value");
        assert!(!key.is_empty() && !value.is_empty(), "{text}");
        assert!(pairs.insert(key.to_string(), value.to_string()).is_none());
    }
    pairs
}

/// Sets the supply voltage of the board; the servo rail has 6 V.
pub(super) fn set_board_supply(robot: &mut RunningRobot, board_mv: u32) {
    let supplies = robot.motion().robot().supplies();
    let reading = compute_reading(&supplies, board_mv, 6_000);
    robot.board.adc.set_true_reading(reading);
}

/// Returns byte 128 of the EEPROM, the mark of the rest pose's record: 0xa5 while a pose is saved, 0xff otherwise.
pub(super) fn rest_pose_mark(robot: &RunningRobot) -> u8 {
    robot.board.memory.bytes()[128]
}

/// Returns the neutral pose in the format of `status`.
pub(super) fn format_neutral_pose() -> String {
    NEUTRAL_COMMAND.replacen("pose ", "", 1).replace(' ', ",")
}
