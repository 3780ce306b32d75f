//! A simulated robot, and helpers that send lines to it and read its answers.

use std::collections::HashMap;
use std::format;
use std::string::{String, ToString};

use super::NEUTRAL_COMMAND;
use crate::memory::restart::Restart;
use crate::motion::Activity;
use crate::numbers::units::CYCLE;
use crate::sample::Sample;
use crate::virtual_board::{Eeprom, RunningRobot, compute_reading};

/// The number of frames until the robot stands and may begin to move.
pub(super) const WAKING_FRAMES: u32 = 21;

/// A running robot that is commanded over its console.
pub(super) type Dialogue = RunningRobot;

/// Powers on the asymmetric sample robot, reads its banner, and runs it until it is awake.
pub(super) fn wake_asymmetric_robot() -> Dialogue {
    wake_robot(Sample::asymmetric())
}

/// Powers on a robot, reads its banner, and runs it until it is awake.
pub(super) fn wake_robot(robot: Sample) -> Dialogue {
    let mut dialogue = Dialogue::power_on(*robot);
    let printed_lines = dialogue.read_lines();
    assert_eq!(
        printed_lines.len(),
        2,
        "only the banner and the notice of blank settings are printed: {printed_lines:?}"
    );
    dialogue.run_frames(WAKING_FRAMES);
    dialogue
}

/// Starts the asymmetric sample robot with a copy of this memory.
pub(super) fn start_asymmetric_robot(memory: &Eeprom, restart: Restart) -> Dialogue {
    Dialogue::with_memory(*Sample::asymmetric(), memory.clone(), restart)
}

/// Checks several values of the status.
#[track_caller]
pub(super) fn assert_status(dialogue: &mut Dialogue, values: &[(&str, &str)]) {
    for (key, value) in values {
        assert_eq!(dialogue.status_value(key), *value, "{key}");
    }
}

/// Returns the name of the current gait, or of another activity.
pub(super) fn activity_name(dialogue: &Dialogue) -> String {
    let motion = dialogue.motion();
    match motion.activity() {
        Activity::Gait(id) => motion.robot().gait_name(id).map(char::from).collect(),
        activity => format!("{activity:?}"),
    }
}

/// Runs a frame and returns its pulse widths, CPU cycles.
pub(super) fn run_frame_and_read_widths(dialogue: &mut Dialogue) -> [u16; 4] {
    dialogue.run_frame().0.map(|width| width.0)
}

/// Runs frames. Returns the advance of the phase, 1/2^24 cycle.
pub(super) fn measure_phase_advance(dialogue: &mut Dialogue, frames: u32) -> u32 {
    let phase_before = dialogue.motion().phase();
    dialogue.run_frames(frames);
    dialogue.motion().phase().wrapping_sub(phase_before) & (CYCLE - 1)
}

/// Splits a text into `key=value` pairs and checks that each key occurs only once.
pub(super) fn parse_pairs(text: &str) -> HashMap<String, String> {
    let mut pairs = HashMap::new();
    for word in text.split(' ') {
        let (key, value) = word
            .split_once('=')
            .expect("each word has the form key=value");
        assert!(!key.is_empty() && !value.is_empty(), "{text}");
        assert!(pairs.insert(key.to_string(), value.to_string()).is_none());
    }
    pairs
}

/// Sets the supply voltage of the board, and sets the voltage of the servo rail to 6 V.
pub(super) fn set_supply(dialogue: &mut Dialogue, board_mv: u32) {
    let supplies = dialogue.motion().robot().supplies();
    let reading = compute_reading(&supplies, board_mv, 6_000);
    dialogue.board.adc.set_true_reading(reading);
}

/// Returns the neutral pose in the format of `status`.
pub(super) fn format_neutral_pose() -> String {
    NEUTRAL_COMMAND.replacen("pose ", "", 1).replace(' ', ",")
}
