//! A robot and the user at the other end of its serial line.

use std::collections::HashMap;
use std::string::{String, ToString};

use super::NEUTRAL;
use crate::sample::Sample;
use crate::virtual_board::{RunningRobot, compute_reading};

/// Frames until the robot stands and may begin to move.
pub(super) const WAKING: u32 = 21;

/// A running robot with its console.
pub(super) type Dialogue = RunningRobot;

/// The odd robot, awake, with its banner read.
pub(super) fn wake_odd_robot() -> Dialogue {
    wake_robot(Sample::odd())
}

/// A robot, awake, with its banner read.
pub(super) fn wake_robot(robot: Sample) -> Dialogue {
    let mut dialogue = Dialogue::power_on(*robot);
    let printed_lines = dialogue.read_lines();
    assert_eq!(
        printed_lines.len(),
        2,
        "the banner, and that nothing is saved: {printed_lines:?}"
    );
    dialogue.run_frames(WAKING);
    dialogue
}

/// Runs a frame and returns its pulse widths, CPU cycles.
pub(super) fn widths(dialogue: &mut Dialogue) -> [u16; 4] {
    dialogue.frame().0.map(|width| width.0)
}

/// Splits a text into `key=value` pairs, and checks that each key occurs once.
pub(super) fn pairs(text: &str) -> HashMap<String, String> {
    let mut pairs = HashMap::new();
    for word in text.split(' ') {
        let (key, value) = word.split_once('=').expect("key=value");
        assert!(!key.is_empty() && !value.is_empty(), "{text}");
        assert!(pairs.insert(key.to_string(), value.to_string()).is_none());
    }
    pairs
}

/// Sets the board's supply, mV, and its rail to 6 V.
pub(super) fn supply(dialogue: &mut Dialogue, mv: u32) {
    let supplies = dialogue.motion().robot().supplies();
    let reading = compute_reading(&supplies, mv, 6_000);
    dialogue.board.converter.set(reading);
}

/// The neutral pose in the format of `status`.
pub(super) fn neutral() -> String {
    NEUTRAL.replacen("pose ", "", 1).replace(' ', ",")
}
