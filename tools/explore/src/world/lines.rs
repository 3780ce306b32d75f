//! The lines that the search sends to the robot, and the lines that the robot prints.

use lizard_core::console::command::{effect, parse};
use lizard_core::step::Step;
use lizard_core::virtual_board::{RunningRobot, is_answer};
use lizard_rules::{Event, Rule, Time};

use super::{MAX_LINES_TO_FIND_RATE, UNREADABLE, Verdict, World, broken};
use crate::fingerprint;

impl World {
    /// Sends a line and runs main up to the line's immediate effect.
    pub(super) fn say(&mut self, line: &'static str, bytes: &[u8]) -> Verdict {
        let robot_before = self.settled_clone();
        self.running.board.send(bytes);
        self.running.board.send(b"\n");
        self.observe(Event::Byte);
        let is_command = bytes == line.as_bytes() && parse(bytes, &self.robot()).is_ok();
        self.observe(Event::Line { is_command });
        self.unread = Some(line);
        for _ in 0..10_000 {
            if self.running.board.unread_count() == 0 {
                break;
            }
            let step = self.running.main.step(&mut self.running.board);
            if step != Step::Worked || self.running.board.memory.was_polled_busy() {
                // Main reads the line later, when it has time.
                break;
            }
        }
        if self.running.board.unread_count() == 0 {
            self.predict(line, &robot_before)?;
        }
        if self.unread.is_some() {
            let effect = effect(line, &self.robot());
            self.order(effect, None);
        }
        self.listen(self.now)
    }

    /// Sends a line at a rate other than the rate of the robot's receiver, and checks that the robot ignores it.
    pub(super) fn say_at_another_rate(&mut self) -> Verdict {
        let robot_before = self.settled_clone();
        self.running.board.send(&UNREADABLE);
        self.observe(Event::Byte);
        let robot_after = self.settled_clone();
        let fingerprint_of =
            |running: &RunningRobot| fingerprint::fingerprint_without_line_arrival(&running.main);
        if fingerprint_of(&robot_after) != fingerprint_of(&robot_before) {
            return broken(Rule::OtherRate, robot_after.board.transmitter.text);
        }
        Ok(())
    }

    /// Checks that the robot finds the sender's rate and answers, if it is asked repeatedly.
    pub(super) fn check_rate_is_found(&self) -> Verdict {
        let mut asked_robot = self.running.clone();
        asked_robot.board.transmitter.is_held = false;
        for _ in 0..MAX_LINES_TO_FIND_RATE {
            if asked_robot.is_stopped_by_watchdog() {
                return Ok(());
            }
            let line: &[u8] = if asked_robot.board.rate == self.sender_rate {
                b"status\n"
            } else {
                &UNREADABLE
            };
            asked_robot.board.send(line);
            for _ in 0..4 {
                asked_robot.run_frame();
            }
            if asked_robot.board.transmitter.text.contains("ok gait=") {
                return Ok(());
            }
        }
        broken(Rule::Found, format!("at {} baud", self.sender_rate.baud()))
    }

    /// Returns a clone of the robot that has printed all its output.
    fn settled_clone(&self) -> RunningRobot {
        let mut clone = self.running.clone();
        clone.board.transmitter.text.clear();
        clone.settle();
        clone
    }

    /// Judges the answer that the robot is about to print, if it answers at once: the robot's
    /// state must already match that answer.
    fn predict(&mut self, line: &'static str, robot_before: &RunningRobot) -> Verdict {
        let robot_after = self.settled_clone();
        let text = &robot_after.board.transmitter.text;
        let Some(answer) = text.lines().find(|line| is_answer(line)) else {
            return Ok(());
        };
        let fingerprint_of =
            |running: &RunningRobot| fingerprint::fingerprint_without_line_arrival(&running.main);
        if answer.starts_with("err ")
            && (fingerprint_of(&robot_after) != fingerprint_of(robot_before)
                || robot_after.board.memory.bytes() != robot_before.board.memory.bytes())
        {
            return broken(Rule::Refused, text.clone());
        }
        if answer.starts_with("ok gait=") {
            // The answer to `status` is judged when it is printed.
            return Ok(());
        }
        self.judged_answers += 1;
        self.unread = None;
        self.judge_answer(line, answer)?;
        self.look_ahead()
    }

    /// Passes the lines that the robot has printed to the observer. The robot composed them at `since` or later.
    pub(super) fn listen(&mut self, since: Time) -> Verdict {
        let text = std::mem::take(&mut self.running.board.transmitter.text);
        // The last line may have been printed only in part.
        let (complete_lines, rest) = text.rsplit_once("\r\n").unwrap_or(("", &text));
        rest.clone_into(&mut self.running.board.transmitter.text);
        for line in complete_lines.split("\r\n").filter(|line| !line.is_empty()) {
            self.observe(Event::Printed(since, line));
            if is_answer(line) {
                if self.judged_answers > 0 && !line.starts_with("ok gait=") {
                    self.judged_answers -= 1;
                } else if let Some(asked_line) = self.unread.take() {
                    self.judge_answer(asked_line, line)?;
                }
            }
        }
        self.look_ahead()
    }

    /// Passes the robot's `# boot: ` lines to the observer while the transmitter holds them.
    pub(super) fn predict_boot(&mut self) {
        let mut clone = self.running.clone();
        clone.board.transmitter.is_held = false;
        clone.settle();
        let lines = clone.board.transmitter.text.lines();
        for line in lines.filter(|line| line.starts_with("# boot: ")) {
            self.observe(Event::Printed(self.now, line));
        }
    }
}
