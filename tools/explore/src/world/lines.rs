//! Lines that the search sends to the robot, and lines that the robot prints.

use lizard_core::console::command::{effect, parse};
use lizard_core::step::StepResult;
use lizard_core::virtual_board::{RunningRobot, is_answer};
use lizard_rules::{Event, Rule, Time};

use super::{MAX_LINES_TO_FIND_RATE, UNREADABLE_BYTES, Verdict, World, violation};
use crate::fingerprint;

/// Returns a fingerprint of main without the fields that record the arrival of a line.
fn robot_fingerprint(robot: &RunningRobot) -> u64 {
    fingerprint::fingerprint_without_line_arrival(&robot.main)
}

impl World {
    /// Sends a line and runs main until main has read the line, or is busy and reads it later. `bytes` differ from
    /// `line` if noise has changed them.
    pub(super) fn send_line(&mut self, line: &'static str, bytes: &[u8]) -> Verdict {
        let robot_before = self.clone_and_settle();
        self.running_robot.board.send(bytes);
        self.running_robot.board.send(b"\n");
        self.observe(Event::ByteReceived);
        let is_command = bytes == line.as_bytes() && parse(bytes, &self.robot()).is_ok();
        self.observe(Event::LineReceived { is_command });
        self.unchecked_line = Some(line);
        for _ in 0..10_000 {
            if self.running_robot.board.unread_count() == 0 {
                break;
            }
            let step = self.running_robot.main.step(&mut self.running_robot.board);
            if step != StepResult::Worked || self.running_robot.board.memory.take_polled_busy() {
                // Main is busy and reads the line later.
                break;
            }
        }
        if self.running_robot.board.unread_count() == 0 {
            self.check_next_answer(line, &robot_before)?;
        }
        if self.unchecked_line.is_some() {
            let effect = effect(line, &self.robot());
            self.observer.observe_command(self.now, effect, None);
        }
        self.observe_output(self.now)
    }

    /// Sends a line at another baud rate than the receiver's, and checks that the robot ignores the line.
    pub(super) fn send_line_at_other_rate(&mut self) -> Verdict {
        let robot_before = self.clone_and_settle();
        self.running_robot.board.send(&UNREADABLE_BYTES);
        self.observe(Event::ByteReceived);
        let robot_after = self.clone_and_settle();
        if robot_fingerprint(&robot_after) != robot_fingerprint(&robot_before) {
            return violation(Rule::OtherRateIgnored, robot_after.board.transmitter.text);
        }
        Ok(())
    }

    /// Checks that a robot that is queried repeatedly finds the sender's baud rate and answers.
    pub(super) fn check_rate_is_found(&self) -> Verdict {
        let mut queried_robot = self.running_robot.clone();
        queried_robot.board.transmitter.is_held = false;
        for _ in 0..MAX_LINES_TO_FIND_RATE {
            if queried_robot.board.are_pulses_ended() {
                return Ok(());
            }
            let line: &[u8] = match queried_robot.board.rate == self.sender_rate {
                true => b"status\n",
                false => &UNREADABLE_BYTES,
            };
            queried_robot.board.send(line);
            for _ in 0..4 {
                queried_robot.run_frame();
            }
            if queried_robot.board.transmitter.text.contains("ok gait=") {
                return Ok(());
            }
        }
        let observation = format!("at {} baud", self.sender_rate.baud());
        violation(Rule::RateFound, observation)
    }

    /// Returns a clone of the robot, run until it has printed all its output.
    fn clone_and_settle(&self) -> RunningRobot {
        let mut clone = self.running_robot.clone();
        clone.board.transmitter.text.clear();
        clone.settle();
        clone
    }

    /// Checks the answer that the robot is about to print: the robot's state must already agree with the answer.
    fn check_next_answer(&mut self, line: &'static str, robot_before: &RunningRobot) -> Verdict {
        let robot_after = self.clone_and_settle();
        let text = &robot_after.board.transmitter.text;
        let Some(answer) = text.lines().find(|line| is_answer(line)) else {
            return Ok(());
        };
        if answer.starts_with("err ")
            && (robot_fingerprint(&robot_after) != robot_fingerprint(robot_before)
                || robot_after.board.memory.bytes() != robot_before.board.memory.bytes())
        {
            return violation(Rule::RefusalChangesNothing, text.clone());
        }
        if answer.starts_with("ok gait=") {
            // The answer to `status` is checked when it is printed.
            return Ok(());
        }
        self.checked_answer_count += 1;
        self.unchecked_line = None;
        self.check_answer(line, answer)?;
        self.check_promises()
    }

    /// Passes the printed lines to the observer. `composed_from` is the earliest time at which the robot may have
    /// composed them.
    pub(super) fn observe_output(&mut self, composed_from: Time) -> Verdict {
        let text = std::mem::take(&mut self.running_robot.board.transmitter.text);
        // The last line may be incomplete.
        let (complete_lines, rest) = text.rsplit_once("\r\n").unwrap_or(("", &text));
        rest.clone_into(&mut self.running_robot.board.transmitter.text);
        for line in complete_lines.split("\r\n").filter(|line| !line.is_empty()) {
            self.observe(Event::LinePrinted(composed_from, line));
            if is_answer(line) {
                if self.checked_answer_count > 0 && !line.starts_with("ok gait=") {
                    self.checked_answer_count -= 1;
                } else if let Some(sent_line) = self.unchecked_line.take() {
                    self.check_answer(sent_line, line)?;
                }
            }
        }
        self.check_promises()
    }

    /// Passes the robot's `# boot: ` lines to the observer while the output is held.
    pub(super) fn observe_held_boot_lines(&mut self) {
        let mut clone = self.running_robot.clone();
        clone.board.transmitter.is_held = false;
        clone.settle();
        let lines = clone.board.transmitter.text.lines();
        for line in lines.filter(|line| line.starts_with("# boot: ")) {
            self.observe(Event::LinePrinted(self.now, line));
        }
    }
}
