//! A robot that runs on a virtual board, and a user at the other end of its serial port.

use std::string::{String, ToString};
use std::vec::Vec;

use lizard_avr::Region;

use super::{Adc, Eeprom, VirtualBoard, compute_reading};
use crate::console::MAX_OUTPUT_LINE_BYTES;
use crate::memory::restart::{Cause, Restart};
use crate::motion::Motion;
use crate::numbers::pose::Pulses;
use crate::numbers::robot::Robot;
use crate::step::{Main, StepResult};

/// The firmware's main loop and its board.
#[derive(Clone, Debug)]
pub struct RunningRobot {
    /// The firmware's main loop.
    pub main: Main,
    /// The board on which the main loop runs.
    pub board: VirtualBoard,
    /// The flash that holds the robot's section.
    flash: Region<'static>,
}

impl RunningRobot {
    /// Powers on a robot with good supplies and a blank EEPROM.
    pub fn power_on(robot: Robot<'static>) -> Self {
        Self::with_eeprom(robot, Eeprom::blank(), Restart::NONE)
    }

    /// Starts a robot with good supplies and this EEPROM; `restart` says what it recovers from.
    pub fn with_eeprom(robot: Robot<'static>, eeprom: Eeprom, restart: Restart) -> Self {
        let supplies = robot.supplies();
        // A rail voltage well above the thresholds of the rail.
        let rail_mv = u32::from(supplies.rail.slow_mv) + 1_000;
        let reading = compute_reading(&supplies, 5_000, rail_mv.max(6_000));
        let board = VirtualBoard {
            adc: Adc::new(reading, supplies.rail_reference_mv != 0),
            ..VirtualBoard::new(eeprom).after_restart(restart)
        };
        Self::with_flash(robot.section(), board)
    }

    /// Starts the firmware on this board, with `flash` as the flash region of the robot's section.
    pub fn with_flash(flash: Region<'static>, mut board: VirtualBoard) -> Self {
        let mut main = Main::new();
        main.begin(flash, &mut board);
        Self { main, board, flash }
    }

    /// The motion of the robot.
    pub const fn motion(&self) -> &Motion {
        self.main.control().motion()
    }

    /// True while there is output to write.
    pub const fn has_output(&self) -> bool {
        self.main.console().has_output(self.main.control())
    }

    /// Runs steps of the main loop until it only waits for time to pass. Does nothing once the watchdog has ended the
    /// pulses, until the reset.
    ///
    /// # Panics
    /// Panics if the main loop never becomes idle.
    pub fn settle(&mut self) {
        if self.board.are_pulses_ended() {
            return;
        }
        for _ in 0..100_000 {
            let result = self.main.step(&mut self.board);
            if result != StepResult::Worked || self.board.memory.take_polled_busy() {
                return;
            }
        }
        panic!("the main loop never becomes idle");
    }

    /// Runs a frame: lets time pass until 19 ms after the next tick, so that the main loop computes the frame and its
    /// four pulses begin. Returns these pulses.
    pub fn run_frame(&mut self) -> Pulses {
        self.settle();
        self.board.pass_time(self.board.ms_until_tick());
        self.settle();
        // The main loop also runs between the pulses.
        for ms in [4, 4, 4, 4, 3] {
            self.board.pass_time(ms);
            self.settle();
        }
        self.board.started_pulses()
    }

    /// Runs frames and returns their output.
    pub fn run_frames(&mut self, frame_count: u32) -> Vec<String> {
        let mut printed_lines = Vec::new();
        for _ in 0..frame_count {
            self.run_frame();
            printed_lines.extend(self.read_lines());
        }
        printed_lines
    }

    /// Runs frames while the output is not read.
    pub fn run_without_reader(&mut self, frame_count: u32) {
        self.board.transmitter.is_held = true;
        for _ in 0..frame_count {
            self.run_frame();
        }
        self.board.transmitter.is_held = false;
    }

    /// Reads all waiting lines and checks their format.
    ///
    /// # Panics
    /// Panics if a line has a wrong format.
    pub fn read_lines(&mut self) -> Vec<String> {
        self.settle();
        let text = core::mem::take(&mut self.board.transmitter.text);
        let mut lines = Vec::new();
        for line in text.split_inclusive("\r\n") {
            assert!(line.len() <= usize::from(MAX_OUTPUT_LINE_BYTES), "{line}");
            let line = line.strip_suffix("\r\n");
            let line = line.expect("every line ends with CR and LF");
            let is_plain = |byte: u8| byte == b' ' || byte.is_ascii_graphic();
            assert!(line.bytes().all(is_plain), "{line:?}");
            assert!(line.starts_with("# ") || is_answer(line), "{line:?}");
            lines.push(line.to_string());
        }
        lines
    }

    /// Sends bytes one by one, reads the output before the first and after every byte, and returns all output.
    pub fn send(&mut self, bytes: &[u8]) -> Vec<String> {
        let mut lines = self.read_lines();
        for byte in bytes {
            self.board.send(&[*byte]);
            lines.extend(self.read_lines());
        }
        lines
    }

    /// Sends a line and returns its answer. Discards the lines before the answer; the later lines stay in the output.
    ///
    /// # Panics
    /// Panics if the line gets no answer or several answers.
    pub fn send_line(&mut self, line: &str) -> String {
        self.read_lines();
        let mut printed_lines = self.send(line.as_bytes());
        printed_lines.extend(self.send(b"\r"));
        let answer_index = printed_lines.iter().position(|line| is_answer(line));
        let answer_index = answer_index.expect("the line has an answer");
        let answer = printed_lines.remove(answer_index);
        let (earlier_lines, later_lines) = printed_lines.split_at(answer_index);
        let format_line = |line: &String| std::format!("{line}\r\n");
        self.board.transmitter.text = later_lines.iter().map(format_line).collect();
        let are_all_notes = printed_lines.iter().all(|line| line.starts_with("# "));
        assert!(are_all_notes, "{earlier_lines:?} {later_lines:?}");
        answer
    }

    /// Sends a line that must be accepted.
    ///
    /// # Panics
    /// Panics if the answer is not `ok` followed by the line.
    #[track_caller]
    pub fn expect_accepted(&mut self, line: &str) {
        assert_eq!(self.send_line(line), std::format!("ok {line}"));
    }

    /// Sends a line that must be refused with an answer that begins with `err ` and `code_and_reason`, such as `7 the
    /// servos are resting`.
    ///
    /// # Panics
    /// Panics if the line is accepted, or refused with another answer.
    #[track_caller]
    pub fn expect_refused(&mut self, line: &str, code_and_reason: &str) {
        let answer = self.send_line(line);
        let is_refused = answer
            .strip_prefix("err ")
            .is_some_and(|text| text.starts_with(code_and_reason));
        assert!(is_refused, "{line}: {answer}, expected {code_and_reason}");
    }

    /// Requests the status and returns the value of a key in it.
    ///
    /// # Panics
    /// Panics if the status has no such key.
    pub fn status_value(&mut self, key: &str) -> String {
        let line = self.send_line("status");
        let pairs = line.split(' ').filter_map(|word| word.split_once('='));
        let value = pairs.into_iter().find(|(name, _)| *name == key);
        value.expect("the status has this key").1.to_string()
    }

    /// Stalls the main loop for `ms` milliseconds. Once the watchdog has ended the pulses, the loop remains stopped
    /// until the reset. Returns true if the processor was reset.
    pub fn stall(&mut self, ms: u16) -> bool {
        let mut is_reset = self.board.pass_time(ms);
        while self.board.are_pulses_ended() && !is_reset {
            is_reset = self.board.pass_time(1);
        }
        if is_reset {
            self.reset(Cause::Watchdog);
        }
        is_reset
    }

    /// Resets the processor with this cause.
    pub fn reset(&mut self, cause: Cause) {
        self.board.reset(cause);
        self.restart_main();
    }

    /// Switches the power off and on; see [`VirtualBoard::cycle_power`].
    pub fn cycle_power(&mut self, torn_byte: Option<u8>) {
        self.board.cycle_power(torn_byte);
        self.restart_main();
    }

    fn restart_main(&mut self) {
        self.main = Main::new();
        self.main.begin(self.flash, &mut self.board);
    }
}

/// The codes of the answers that begin with `err`.
const ERROR_CODES: [&str; 10] = ["1", "2", "3", "4", "5", "6", "7", "8", "9", "10"];

/// True if a line is the answer to a command: `ok` and the command, or `err`, a code and a reason.
pub fn is_answer(line: &str) -> bool {
    let code_and_reason = line
        .strip_prefix("err ")
        .and_then(|rest| rest.split_once(' '));
    let is_error = code_and_reason
        .is_some_and(|(code, reason)| ERROR_CODES.contains(&code) && !reason.is_empty());
    line.starts_with("ok ") || is_error
}
