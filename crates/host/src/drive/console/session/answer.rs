//! The match between the robot's answers and the lines that were sent.

use lizard_core::console::text::Text;

/// True if `answer` can belong to `line`: after `ok`, it must begin with the first word of the line, or with the word
/// that stands for it. A refusal can belong to any line.
pub(super) fn can_answer(answer: &str, line: &str) -> bool {
    let line = line.to_ascii_lowercase();
    let word = match line.split_whitespace().next() {
        Some("status") => "gait=",
        Some("?") => "help",
        word => word.unwrap_or_default(),
    };
    let rest = answer.strip_prefix("ok ");
    rest.is_none_or(|rest| rest.starts_with(word))
}

/// True if a line refuses `stop` because there are no pulses to stop: the robot rests, or the flash has no robot.
/// The whole line must match: a line cut off by a radio may be the beginning of an older answer.
pub(in crate::drive::console) fn is_stop_refusal(line: &str) -> bool {
    let is_refusal = |code: u8, reason: Text| {
        let mut refusal = format!("err {code} ");
        reason.print(&mut refusal);
        line == refusal
    };
    is_refusal(7, Text::Resting) || is_refusal(10, Text::NoRobot)
}
