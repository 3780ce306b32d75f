//! A robot and the user at the other end of its line.

use std::collections::HashMap;
use std::string::{String, ToString};

use super::NEUTRAL;
use crate::sample::Sample;
use crate::virtual_board::{Running, reading};

/// Frames until the robot stands and may begin to move.
pub(super) const WAKING: u32 = 21;

/// A robot of these tests, running.
pub(super) type Dialogue = Running;

/// With the banner read and the robot awake.
pub(super) fn standing() -> Dialogue {
    awake(Sample::odd())
}

/// The same of another robot.
pub(super) fn awake(robot: Sample) -> Dialogue {
    let mut dialogue = Dialogue::power_on(*robot);
    let said = dialogue.lines();
    assert_eq!(
        said.len(),
        2,
        "the banner, and that nothing is saved: {said:?}"
    );
    dialogue.run(WAKING);
    dialogue
}

/// The pulses of a frame.
pub(super) fn widths(dialogue: &mut Dialogue) -> [u16; 4] {
    dialogue.frame().0.map(|width| width.0)
}

/// `key=value` with blanks between, each key once.
pub(super) fn pairs(text: &str) -> HashMap<String, String> {
    let mut pairs = HashMap::new();
    for word in text.split(' ') {
        let (key, value) = word.split_once('=').expect("key=value");
        assert!(!key.is_empty() && !value.is_empty(), "{text}");
        assert!(pairs.insert(key.to_string(), value.to_string()).is_none());
    }
    pairs
}

/// The board's supply is at this many millivolts, its rail at 6 V.
pub(super) fn supply(dialogue: &mut Dialogue, mv: u32) {
    let supplies = dialogue.motion().robot().supplies();
    let truth = reading(&supplies, mv, 6_000);
    dialogue.board.converter.set(truth);
}

/// The neutral pose as `status` has it.
pub(super) fn neutral() -> String {
    NEUTRAL.replacen("pose ", "", 1).replace(' ', ",")
}
