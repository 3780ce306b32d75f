//! A recorded session: its events, frames and commands.

use lizard_robot::Robot;
use simulated_uno::{CYCLES_PER_MS, CYCLES_PER_US};

use super::super::recorder::{Event, FORMAT, TimedEvent};
use super::super::session::answer::is_stop_refusal;
use crate::simulate::sim::frame_log::FrameLog;
use crate::simulate::sim::script::{Script, Step};
use crate::simulate::sim::spans::{self, Span};
use lizard_robot::Status;

/// Length of a frame, ms.
pub(super) const FRAME_MS: u64 = 20;
/// Longest gap between two reported poses that is filled with the earlier pose, in frames.
const MAX_HELD_FRAMES: usize = 50;
/// Largest difference between the robot's frame count and this machine's clock, in frames. A line may arrive late, and
/// a simulated robot lags behind on a slow machine.
const MAX_CLOCK_DIFFERENCE_FRAMES: usize = 10;
/// Largest time of an event that is read, ms: a day. Later events are ignored.
const MAX_SESSION_MS: u64 = 86_400_000;

/// A recorded session.
#[derive(Debug)]
pub(super) struct RecordedSession {
    /// The events in order of time.
    pub(super) entries: Vec<TimedEvent>,
}

impl RecordedSession {
    /// Parses a session's file. A partial last line, left by a killed program or a full disk, is ignored, and so are
    /// the events after [`MAX_SESSION_MS`]. The error says which line is not an event or is out of place, or that the
    /// file is not a session or has another format.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let not_a_session = format!(
            "this is not a session of `lizard console --record`: \"{FORMAT}\" is missing from its \
             first line"
        );
        let mut entries: Vec<TimedEvent> = Vec::new();
        for (index, line) in text.lines().enumerate() {
            let is_partial = !text.ends_with('\n') && index + 1 == text.lines().count();
            let to_error = |problem: String| match index {
                0 => not_a_session.clone(),
                _ => format!("line {}: {problem}", index + 1),
            };
            let mut entry: TimedEvent = match serde_json::from_str(line) {
                Ok(entry) => entry,
                Err(_) if is_partial && index > 0 => break,
                Err(_) => return Err(to_error("not a line of a recorded session".to_owned())),
            };
            let is_begin = matches!(&entry.event, Event::Begin { format, .. } if format == FORMAT);
            if is_begin != (index == 0) {
                return Err(to_error(
                    "`begin` must occur exactly once, in the first line".to_owned(),
                ));
            }
            if entry.ms > MAX_SESSION_MS {
                break;
            }
            if entries.last().is_some_and(|last| last.ms > entry.ms) {
                return Err(to_error(format!("{} ms is out of order", entry.ms)));
            }
            entry.event.escape_controls();
            entries.push(entry);
        }
        if entries.is_empty() {
            return Err(not_a_session);
        }
        Ok(Self { entries })
    }

    /// Returns the robot's banner, if it was recorded.
    pub(super) fn banner(&self) -> Option<&str> {
        match &self.entries.first()?.event {
            Event::Begin { banner, .. } => banner.as_deref(),
            _ => None,
        }
    }

    /// Returns the time of the last event, ms.
    pub(super) fn end_ms(&self) -> u64 {
        self.entries.last().map_or(0, |last| last.ms)
    }

    /// Returns the pulse widths of the reported poses, CPU cycles, one entry per frame since the start of the session.
    /// They are zero while the robot rested, before the first pose, after the last pose, and between two poses that are
    /// more than [`MAX_HELD_FRAMES`] frames apart.
    pub(super) fn build_frame_log(&self, robot: &Robot) -> FrameLog {
        let mut widths: Vec<[u16; 4]> = vec![[0; 4]; (self.end_ms() / FRAME_MS) as usize + 1];
        let mut is_resting = false;
        // The robot's frame count and the index in `widths` of the reference pose for later poses.
        let mut anchor: Option<(u64, usize)> = None;
        let mut last_frame_count = 0;
        // The index in `widths` of the last pose; `None` if the robot has rested or was reset since then.
        let mut last_index: Option<usize> = None;
        for entry in &self.entries {
            match &entry.event {
                Event::Answer(line) if line == "ok rest" => is_resting = true,
                Event::Answer(line) if line == "ok stand" => is_resting = false,
                Event::Status(line) => {
                    if let Some(status) = Status::parse(line) {
                        is_resting = status.gait == "rest";
                    }
                }
                Event::Pose { frame, angles } => {
                    let index_by_clock = (entry.ms / FRAME_MS) as usize;
                    if *frame < last_frame_count {
                        (anchor, last_index) = (None, None);
                    }
                    last_frame_count = *frame;
                    // The robot's frame count is steadier than the arrival time of a line.
                    let index_by_count = anchor.and_then(|(anchor_frame, anchor_index)| {
                        anchor_index
                            .checked_add(usize::try_from(frame.checked_sub(anchor_frame)?).ok()?)
                    });
                    let pose_index = index_by_count
                        .filter(|index| {
                            index.abs_diff(index_by_clock) <= MAX_CLOCK_DIFFERENCE_FRAMES
                        })
                        .unwrap_or(index_by_clock);
                    if index_by_count != Some(pose_index) {
                        anchor = Some((*frame, pose_index));
                    }
                    let Some(frame_widths) = widths.get_mut(pose_index) else {
                        continue;
                    };
                    if is_resting {
                        last_index = None;
                        continue;
                    }
                    *frame_widths = std::array::from_fn(|servo| {
                        let width_us = robot.servos()[servo].pulse(angles[servo]);
                        (width_us * CYCLES_PER_US as f64)
                            .round()
                            .clamp(1.0, 65_534.0) as u16
                    });
                    if let Some(previous_index) = last_index
                        .filter(|index| pose_index.saturating_sub(*index) <= MAX_HELD_FRAMES)
                    {
                        let held_widths = widths[previous_index];
                        for gap in widths.iter_mut().take(pose_index).skip(previous_index + 1) {
                            *gap = held_widths;
                        }
                    }
                    last_index = Some(pose_index);
                }
                _ => {}
            }
        }
        FrameLog::new(0, widths)
    }

    /// Returns the commands, each with the time span of its effect.
    pub(super) fn compute_spans(&self) -> Vec<Span> {
        let mut steps: Vec<Step> = Vec::new();
        let mut answers: Vec<Option<String>> = Vec::new();
        for entry in &self.entries {
            match &entry.event {
                Event::Sent(command) => {
                    answers.push(None);
                    steps.push(Step::new(entry.ms, command));
                }
                Event::Answer(line) => {
                    // A `stop` may be sent before the previous line is answered. Each press of Esc is recorded as a
                    // `stop`, but all unanswered ones have one recorded answer.
                    let previous_index = steps.iter().rposition(|step| step.command != "stop");
                    let first_stop = previous_index.map_or(0, |index| index + 1);
                    let has_open_stop = answers[first_stop..].iter().any(Option::is_none);
                    let is_for_stop = line == "ok stop" || is_stop_refusal(line) && has_open_stop;
                    match previous_index.map(|index| &mut answers[index]) {
                        Some(answer @ None) if !is_for_stop => *answer = Some(line.clone()),
                        _ => {
                            for answer in &mut answers[first_stop..] {
                                answer.get_or_insert_with(|| line.clone());
                            }
                        }
                    }
                }
                _ => {}
            }
        }
        let script = Script::new(steps, self.end_ms());
        spans::list_command_spans(&script, &answers)
    }
}

/// A frame is a whole number of milliseconds.
const _: () = assert!(crate::simulate::sim::frame::FRAME_CYCLES == FRAME_MS * CYCLES_PER_MS);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::robot_args::built_in_robot;

    const BEGIN_LINE: &str =
        "{\"ms\":0,\"begin\":{\"format\":\"lizard record 1\",\"port\":\"p\",\"banner\":null}}\n";

    fn parse_session(lines: &[String]) -> RecordedSession {
        let text = format!("{BEGIN_LINE}{}\n", lines.join("\n"));
        RecordedSession::parse(&text).expect("the session is valid")
    }

    fn pose_line(ms: u64, frame: u64, a1: f64) -> String {
        format!(
            "{{\"ms\":{ms},\"pose\":{{\"frame\":{frame},\"angles\":[{a1},41.41,318.59,221.41]}}}}"
        )
    }

    #[test]
    fn control_characters_in_a_session_are_escaped() {
        let text = BEGIN_LINE.replace("\"p\"", "\"p\\u001b[2J\"")
            + "{\"ms\":1,\"note\":\"# x\\u001b]0;y\\u0007\"}\n{\"ms\":2,\"sent\":\"\\u009b1m\"}\n";
        let session = RecordedSession::parse(&text).expect("the session is valid");
        let events: Vec<&Event> = session.entries.iter().map(|entry| &entry.event).collect();
        assert!(
            matches!(events[0], Event::Begin { port, .. } if port == "p\\u{1b}[2J"),
            "{events:?}"
        );
        assert_eq!(events[1], &Event::Note("# x\\u{1b}]0;y\\u{7}".to_owned()));
        assert_eq!(events[2], &Event::Sent("\\u{9b}1m".to_owned()));
    }

    #[test]
    fn a_missing_pose_repeats_the_previous_pulse_widths() {
        let session = parse_session(&[
            pose_line(104, 50, 138.590378),
            pose_line(131, 51, 139.590378),
            // The line is late by a frame and a half; frame 52 is missing.
            pose_line(190, 53, 140.590378),
        ]);
        let log = session.build_frame_log(&built_in_robot("paper"));
        let a1_widths: Vec<u16> = log.widths.iter().map(|widths| widths[0]).collect();
        assert_eq!(
            a1_widths,
            [0, 0, 0, 0, 0, 24_000, 24_160, 24_160, 24_320, 0],
            "10 us per degree, 16 cycles per us"
        );
    }

    #[test]
    fn a_slow_robot_leaves_no_gap() {
        let slow_poses = (0..100).map(|n| pose_line(20 + 30 * n, n, 138.590378));
        let log = parse_session(&slow_poses.collect::<Vec<_>>())
            .build_frame_log(&built_in_robot("paper"));
        let first = log.widths.iter().position(|widths| widths[0] > 0);
        assert_eq!(first, Some(1));
        assert!(log.widths[1..140].iter().all(|widths| widths[0] == 24_000));
    }

    #[test]
    fn a_resting_or_reset_robot_has_no_pulses() {
        let session = parse_session(&[
            pose_line(20, 1, 138.590378),
            "{\"ms\":30,\"answer\":\"ok rest\"}".to_owned(),
            pose_line(40, 2, 138.590378),
            pose_line(60, 3, 138.590378),
            "{\"ms\":70,\"answer\":\"ok stand\"}".to_owned(),
            pose_line(80, 4, 138.590378),
            // The robot was reset, so its frame count starts again.
            pose_line(160, 0, 138.590378),
            pose_line(180, 1, 138.590378),
            // An impossible frame count has no effect.
            pose_line(190, u64::MAX, 138.590378),
        ]);
        let log = session.build_frame_log(&built_in_robot("paper"));
        let pulsed_frames: Vec<usize> = (0..10).filter(|n| log.widths[*n][0] > 0).collect();
        assert_eq!(pulsed_frames, [1, 4, 8, 9]);
    }

    #[test]
    fn commands_are_in_effect_unless_refused() {
        let session = parse_session(&[
            "{\"ms\":1000,\"sent\":\"walk\"}".to_owned(),
            "{\"ms\":1001,\"answer\":\"ok walk\"}".to_owned(),
            "{\"ms\":2000,\"sent\":\"fly\"}".to_owned(),
            "{\"ms\":2001,\"answer\":\"err 1 no\"}".to_owned(),
            "{\"ms\":3000,\"sent\":\"stop\"}".to_owned(),
            "{\"ms\":3001,\"answer\":\"ok stop\"}".to_owned(),
            // This `stop` is sent before the refusal arrives.
            "{\"ms\":4000,\"sent\":\"trot\"}".to_owned(),
            "{\"ms\":4001,\"sent\":\"STOP\"}".to_owned(),
            "{\"ms\":4002,\"answer\":\"err 6 no\"}".to_owned(),
            "{\"ms\":4003,\"answer\":\"ok stop\"}".to_owned(),
            // A resting robot refuses `stop`; a radio has lost the answer to `rest`.
            "{\"ms\":4500,\"sent\":\"rest\"}".to_owned(),
            "{\"ms\":4600,\"sent\":\"stop\"}".to_owned(),
            "{\"ms\":4601,\"answer\":\"err 7 the servos are resting; send stand first\"}"
                .to_owned(),
            // Two presses of Esc before the refusal arrives.
            "{\"ms\":4700,\"sent\":\"trot\"}".to_owned(),
            "{\"ms\":4701,\"sent\":\"stop\"}".to_owned(),
            "{\"ms\":4702,\"sent\":\"stop\"}".to_owned(),
            "{\"ms\":4703,\"answer\":\"err 6 no\"}".to_owned(),
            "{\"ms\":4704,\"answer\":\"ok stop\"}".to_owned(),
            "{\"ms\":5000,\"sent\":\"left\"}".to_owned(),
        ]);
        let spans = session.compute_spans();
        let commands: Vec<(&str, f64)> = spans
            .iter()
            .map(|span| (span.command.as_str(), span.start_s))
            .collect();
        let expected = [
            ("stand", 0.0),
            ("walk", 1.0),
            ("stop", 3.0),
            ("stop", 4.001),
            ("rest", 4.5),
            ("stop", 4.701),
            ("stop", 4.702),
            ("left", 5.0),
        ];
        assert_eq!(commands, expected);
    }

    #[test]
    fn an_invalid_session_is_refused_with_the_line_number() {
        let parse_error = |text: &str| {
            RecordedSession::parse(text).expect_err("an invalid session must be refused")
        };
        for text in ["", "{}\n", "walk\n", "{\"ms\":0,\"sent\":\"walk\"}\n"] {
            assert!(
                parse_error(text).starts_with("this is not a session"),
                "{text}"
            );
        }
        let third_line_error =
            |line: &str| parse_error(&format!("{BEGIN_LINE}{{\"ms\":9,\"gone\":null}}\n{line}\n"));
        assert_eq!(
            third_line_error("{\"ms\":10,\"flew\":1}"),
            "line 3: not a line of a recorded session"
        );
        assert_eq!(
            third_line_error("{\"ms\":8,\"gone\":null}"),
            "line 3: 8 ms is out of order"
        );
    }

    #[test]
    fn the_events_after_a_day_are_ignored() {
        let session = parse_session(&[
            "{\"ms\":1000,\"sent\":\"walk\"}".to_owned(),
            "{\"ms\":86400001,\"sent\":\"stop\"}".to_owned(),
        ]);
        assert_eq!(session.end_ms(), 1000);
    }

    #[test]
    fn a_partial_last_line_is_ignored() {
        let text = format!("{BEGIN_LINE}{{\"ms\":9,\"gone\":null}}\n{{\"ms\":10,\"se");
        let session = RecordedSession::parse(&text).expect("the other lines are complete");
        assert_eq!(session.entries.len(), 2);
    }
}
