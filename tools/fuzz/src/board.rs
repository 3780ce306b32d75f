//! The core on a virtual board, where time passes only in calls of [`Board::frame`]. An observer
//! judges each byte and each frame.

use lizard_core::console::command::{effect, parse};
use lizard_core::console::word::Effect;
use lizard_core::memory::copies::{self, REST_POSE_ADDRESS, SavedState};
use lizard_core::memory::record::Memory;
use lizard_core::memory::restart::{Cause, Restart};
use lizard_core::memory::settings::Settings;
use lizard_core::virtual_board::{Eeprom, RunningRobot};
use lizard_robot::Robot;
use lizard_rules::{Event, Limits, MS, Observer, Rule, Time};

/// A virtual board with the core on it; time passes only in [`Board::frame`].
pub struct Board {
    robot: &'static Robot,
    running: RunningRobot,
    observer: Observer,
    now: Time,
    output: String,
    /// The line so far, collected independently of the core.
    line: Vec<u8>,
    is_overlong: bool,
}

/// Returns the observer's limits for a robot whose supply is good and whose lines come between frames.
fn limits(robot: &Robot) -> Limits {
    let cycles_of = |us: f64| (us * 16.0).round() as u32;
    let servos = robot.servos().each_ref();
    Limits {
        widths: servos.map(|servo| (cycles_of(servo.min_us) - 3, cycles_of(servo.max_us) + 3)),
        ..Limits::default()
    }
}

impl Board {
    /// Starts a robot with this memory.
    ///
    /// # Panics
    /// If the robot breaks a rule.
    pub fn new(robot: &'static Robot, memory: Eeprom) -> Self {
        let mut board = Self {
            robot,
            running: RunningRobot::with_memory(*robot.firmware(), memory, Restart::default()),
            observer: Observer::new(limits(robot)),
            now: 0,
            output: String::new(),
            line: Vec::new(),
            is_overlong: false,
        };
        board.observe(Event::Start(Cause::Power));
        // A `save` waits until the supplies have been measured.
        for _ in 0..30 {
            board.frame();
        }
        board
    }

    fn observe(&mut self, event: Event<'_>) {
        self.observer.observe(self.now, event);
    }

    /// Runs the robot until it has printed all its output.
    fn settle(&mut self) {
        self.running.settle();
        let text = std::mem::take(&mut self.running.board.transmitter.text);
        for line in text.lines() {
            self.observe(Event::Printed(self.now, line));
        }
        self.output.push_str(&text);
        self.running.board.memory.log.clear();
    }

    fn assert_rules_hold(&mut self) {
        let verdict = self.observer.verdict();
        assert!(
            verdict.is_ok(),
            "{}: {:?}",
            verdict.unwrap_err(),
            self.output
        );
    }

    /// Returns the output since the last byte was sent.
    pub fn output(&self) -> &str {
        &self.output
    }

    /// Returns the robot's EEPROM.
    pub const fn memory(&self) -> &Eeprom {
        &self.running.board.memory
    }

    /// Sends a byte. If it ends a line, checks that the line gets exactly one answer.
    ///
    /// # Panics
    /// If the robot breaks a rule.
    pub fn send_byte(&mut self, byte: u8) {
        self.output.clear();
        let mut ended_line = None;
        match byte {
            b'\r' | b'\n' => {
                let line = std::mem::take(&mut self.line);
                let is_overlong = std::mem::take(&mut self.is_overlong);
                let text = String::from_utf8_lossy(&line).to_ascii_lowercase();
                let text = text.trim().replace('\t', " ");
                if is_overlong || !line.trim_ascii().is_empty() {
                    let is_known = parse(text.as_bytes(), self.robot.firmware()).is_ok();
                    let is_command = !is_overlong && is_known;
                    self.observe(Event::Line { is_command });
                    ended_line = Some(if is_overlong { String::new() } else { text });
                }
            }
            0x08 | 0x7f => _ = self.line.pop(),
            // A line with a garbled byte is answered, whatever else it contains.
            0x80.. => self.is_overlong = true,
            _ if self.line.len() == 63 => self.is_overlong = true,
            _ => self.line.push(byte),
        }
        self.observe(Event::Byte);
        self.running.board.send(&[byte]);
        self.settle();
        if let Some(line) = ended_line {
            self.observe_answer(&line);
        }
        self.assert_rules_hold();
    }

    /// Passes the answer to a line on to the observer.
    fn observe_answer(&mut self, line: &str) {
        assert!(
            !self.observer.has_unanswered_lines(),
            "{}: {line:?}",
            Rule::OneAnswer.sentence()
        );
        let effect = effect(line, self.robot.firmware());
        let output = std::mem::take(&mut self.output);
        let is_answer = |line: &&str| !line.starts_with('#');
        let text = output
            .lines()
            .find(is_answer)
            .expect("the observer counts it");
        if matches!(effect, Effect::Moves | Effect::Freezes | Effect::Rests) {
            let done = Some(text.starts_with("ok "));
            self.observe(Event::Order { effect, done });
        }
        let asked = self.now;
        self.observe(Event::Answer {
            line,
            effect,
            asked,
            text,
        });
        self.output = output;
    }

    /// Runs the robot for one frame, 20 ms.
    ///
    /// # Panics
    /// If its pulses break a rule.
    pub fn frame(&mut self) {
        self.running.run_frame();
        let widths = self.running.board.started_pulses().0.map(|width| width.0);
        self.observer.observe_frame(self.now, widths);
        self.now += 20 * MS;
        self.settle();
        self.assert_rules_hold();
    }

    /// Checks that the memory holds complete settings or none, and a complete pose or none.
    ///
    /// # Panics
    /// If the memory holds anything else.
    pub fn assert_memory_is_right(&self) {
        let rule = Rule::Memory.sentence();
        let robot = self.robot.firmware();
        let mut settings = Settings::of(robot);
        let outcome = copies::load(robot, self.memory(), &mut settings);
        let is_whole = matches!(outcome, SavedState::Latest | SavedState::Blank);
        assert!(is_whole, "{rule}: {outcome:?}");
        let is_forgotten = self.memory().read(REST_POSE_ADDRESS.0) == 0xff;
        let has_rest_pose = copies::last_rest_pose(robot, self.memory()).is_some();
        assert!(is_forgotten || has_rest_pose, "{rule}: a pose");
        assert!(
            (192..1024).all(|address| self.memory().read(address) == 0xff),
            "{rule}"
        );
    }
}
