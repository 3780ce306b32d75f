//! The core on a virtual board, with an observer that checks the robot after each byte and each frame.

use lizard_core::console::command::{effect, parse};
use lizard_core::memory::copies::{self, REST_POSE_ADDRESS, SavedState};
use lizard_core::memory::record::Memory;
use lizard_core::memory::restart::{Cause, Restart};
use lizard_core::memory::settings::Settings;
use lizard_core::virtual_board::{Eeprom, RunningRobot};
use lizard_robot::{FRAMES_PER_SECOND, Robot, STEPS_PER_DEGREE};
use lizard_rules::{Event, Limits, MS, Observer, Rule, Time};

/// A virtual board that runs the core. Time passes only in calls of [`ObservedBoard::run_frame`].
pub struct ObservedBoard {
    robot: &'static Robot,
    running_robot: RunningRobot,
    observer: Observer,
    now: Time,
    output: String,
    /// The bytes of the unfinished line, collected independently of the core.
    line: Vec<u8>,
    /// True if the unfinished line is too long or contains a garbled byte.
    is_line_invalid: bool,
}

/// Returns the observer's limits for a robot that has a good supply and receives its lines between frames.
fn observer_limits(robot: &Robot) -> Limits {
    let us_to_cycles = |us: f64| (us * 16.0).round() as u32;
    let servos = robot.servos().each_ref();
    Limits {
        width_ranges: servos.map(|servo| {
            let [min, max] = [servo.min_us, servo.max_us].map(us_to_cycles);
            (min - 3, max + 3) // a tolerance for rounding, cycles
        }),
        ..Limits::default()
    }
}

impl ObservedBoard {
    /// Powers on a robot with this EEPROM, and runs 30 frames.
    ///
    /// # Panics
    /// If the robot violates a rule.
    pub fn power_on(robot: &'static Robot, memory: Eeprom) -> Self {
        let mut board = Self {
            robot,
            running_robot: RunningRobot::with_eeprom(*robot.firmware(), memory, Restart::NONE),
            observer: Observer::new(observer_limits(robot)),
            now: 0,
            output: String::new(),
            line: Vec::new(),
            is_line_invalid: false,
        };
        board.observe(Event::ProgramStart(Cause::Power));
        // Runs until the supplies have been measured, because `save` waits for the measurement.
        board.run_frames(30);
        board
    }

    fn observe(&mut self, event: Event<'_>) {
        self.observer.observe(self.now, event);
    }

    /// Runs the robot until it has printed all its output.
    fn settle(&mut self) {
        self.running_robot.settle();
        let text = std::mem::take(&mut self.running_robot.board.transmitter.text);
        for line in text.lines() {
            self.observe(Event::LinePrinted(self.now, line));
        }
        self.output.push_str(&text);
        self.running_robot.board.memory.log.clear();
    }

    fn assert_rules_hold(&mut self) {
        if let Err(violation) = self.observer.take_verdict() {
            panic!("{violation}: {:?}", self.output);
        }
    }

    /// Returns the output since the last sent byte.
    pub fn output(&self) -> &str {
        &self.output
    }

    /// Returns the robot's EEPROM.
    pub const fn memory(&self) -> &Eeprom {
        &self.running_robot.board.memory
    }

    /// Sends a byte. If it ends a line, checks that the line gets exactly one answer.
    ///
    /// # Panics
    /// If the robot violates a rule.
    pub fn send_byte(&mut self, byte: u8) {
        self.output.clear();
        let mut ended_line = None;
        match byte {
            b'\r' | b'\n' => {
                let line = std::mem::take(&mut self.line);
                let is_line_invalid = std::mem::take(&mut self.is_line_invalid);
                let text = String::from_utf8_lossy(&line).to_ascii_lowercase();
                let text = text.trim().replace('\t', " ");
                if is_line_invalid || !line.trim_ascii().is_empty() {
                    let is_parsed = parse(text.as_bytes(), self.robot.firmware()).is_ok();
                    let is_command = !is_line_invalid && is_parsed;
                    self.observe(Event::LineReceived { is_command });
                    ended_line = Some(if is_line_invalid { String::new() } else { text });
                }
            }
            0x08 | 0x7f => _ = self.line.pop(),
            // A line with a garbled byte always gets an answer, even if all its other bytes are spaces.
            0x80.. => self.is_line_invalid = true,
            _ if self.line.len() == 63 => self.is_line_invalid = true,
            _ => self.line.push(byte),
        }
        self.observe(Event::ByteReceived);
        self.running_robot.board.send(&[byte]);
        self.settle();
        if let Some(line) = ended_line {
            self.observe_answer(&line);
        }
        self.assert_rules_hold();
    }

    /// Passes the answer to a line to the observer.
    fn observe_answer(&mut self, line: &str) {
        let rule = Rule::OneAnswer.sentence();
        assert!(!self.observer.has_unanswered_lines(), "{rule}: {line:?}");
        let effect = effect(line, self.robot.firmware());
        let output = std::mem::take(&mut self.output);
        let answer = output.lines().find(|line| !line.starts_with('#'));
        let answer = answer.expect("the observer has counted an answer");
        let is_accepted = answer.starts_with("ok ");
        self.observer
            .observe_command(self.now, effect, Some(is_accepted));
        self.observe(Event::Answer {
            line,
            effect,
            sent_at: self.now,
            answer,
        });
        self.output = output;
    }

    /// Runs the robot for a frame of 20 ms.
    ///
    /// # Panics
    /// If the robot violates a rule.
    pub fn run_frame(&mut self) {
        self.running_robot.run_frame();
        let widths = self.running_robot.board.started_pulses().0;
        let widths = widths.map(|width| width.0);
        self.update_max_changes();
        self.observer.observe_frame(self.now, widths);
        self.now += 20 * MS;
        self.settle();
        self.assert_rules_hold();
    }

    /// Sets the observer's limits for the changes of pulses, which depend on the scales of the servos.
    fn update_max_changes(&mut self) {
        /// Tolerance for the rounding of angles and pulses, cycles.
        const ROUNDING_CYCLES: u32 = 8;
        let speed_limits = self.robot.speed_limits();
        let max_speed = speed_limits.slew.max(speed_limits.gait_slew);
        let steps_per_frame = (max_speed * STEPS_PER_DEGREE / FRAMES_PER_SECOND) as u16;
        let calibrations = self.running_robot.motion().calibration().each_ref();
        self.observer.limits.max_change_cycles = calibrations.map(|calibration| {
            u32::from(calibration.max_width_change(steps_per_frame)) + ROUNDING_CYCLES
        });
    }

    /// Runs the robot for a number of frames.
    ///
    /// # Panics
    /// If the robot violates a rule.
    pub fn run_frames(&mut self, count: usize) {
        for _ in 0..count {
            self.run_frame();
        }
    }

    /// Checks that the EEPROM holds valid settings or none, a valid rest pose or none, and nothing else.
    ///
    /// # Panics
    /// If the EEPROM holds anything else.
    pub fn assert_memory_is_valid(&self) {
        let rule = Rule::MemoryValid.sentence();
        let robot = self.robot.firmware();
        let mut settings = Settings::for_robot(robot);
        let outcome = copies::load(robot, self.memory(), &mut settings);
        let are_settings_valid = matches!(outcome, SavedState::Latest | SavedState::Blank);
        assert!(are_settings_valid, "{rule}: {outcome:?}");
        let is_rest_pose_blank = self.memory().read(REST_POSE_ADDRESS.0) == 0xff;
        let has_rest_pose = copies::read_rest_pose(robot, self.memory()).is_some();
        assert!(is_rest_pose_blank || has_rest_pose, "{rule}: the rest pose");
        // No record reaches these addresses.
        let is_remainder_blank = (192..1024).all(|address| self.memory().read(address) == 0xff);
        assert!(is_remainder_blank, "{rule}");
    }
}
