//! The core on a board without time: what it says and does is checked at every byte
//! and every frame.

use lizard_core::console::line::GARBLED;
use lizard_core::memory::copies::{self, Outcome, RESTED};
use lizard_core::memory::record::Memory;
use lizard_core::memory::restart::Restart;
use lizard_core::memory::settings::Settings;
use lizard_core::virtual_board::{Eeprom, Running};
use lizard_robot::Robot;

/// The core on a board without time.
pub struct Board {
    robot: &'static Robot,
    running: Running,
    said: String,
    /// The line under way as another reader of lines has it.
    line: Vec<u8>,
    overlong: bool,
}

impl Board {
    /// A robot that has begun with this memory.
    ///
    /// # Panics
    /// If it never falls silent.
    #[must_use]
    pub fn new(robot: &'static Robot, memory: Eeprom) -> Self {
        let mut running = Running::with(*robot.firmware(), memory, Restart::default());
        // Until the supplies have been measured, a `save` waits.
        for _ in 0..30 {
            running.frame();
        }
        let mut board = Self {
            robot,
            running,
            said: String::new(),
            line: Vec::new(),
            overlong: false,
        };
        board.settle();
        board
    }

    /// Lets it write all that it has to write.
    fn settle(&mut self) {
        self.running.settle();
        self.said.push_str(&self.running.board.transmitter.text);
        self.running.board.transmitter.text.clear();
        self.running.board.memory.log.clear();
    }

    /// What was said since the last byte.
    #[must_use]
    pub fn said(&self) -> &str {
        &self.said
    }

    /// What it keeps.
    #[must_use]
    pub const fn memory(&self) -> &Eeprom {
        &self.running.board.memory
    }

    /// A byte; what it ends has exactly one answer.
    ///
    /// # Panics
    /// If it has not.
    pub fn take(&mut self, byte: u8) {
        self.said.clear();
        self.running.board.send(&[byte]);
        self.settle();
        let mut due = 0;
        match byte {
            b'\r' | b'\n' => {
                due = usize::from(self.overlong || !self.line.trim_ascii().is_empty());
                self.line.clear();
                self.overlong = false;
            }
            0x08 | 0x7f => _ = self.line.pop(),
            // What stands for a garbled byte: its line is answered, whatever else it is.
            GARBLED => self.overlong = true,
            _ if self.line.len() == 63 => self.overlong = true,
            _ => self.line.push(byte),
        }
        let answers = self.said.lines().filter(|line| !line.starts_with('#'));
        let mut count = 0;
        for answer in answers {
            assert!(
                answer.starts_with("ok ") || answer.starts_with("err "),
                "{answer}"
            );
            count += 1;
        }
        assert_eq!(count, due, "{:?}", self.said);
    }

    /// A frame: its pulses are those of no servo beyond its limits.
    ///
    /// # Panics
    /// If one is.
    pub fn frame(&mut self) {
        self.running.frame();
        let pulses = self.running.board.submitted();
        for (width, servo) in pulses.0.into_iter().zip(self.robot.servos()) {
            let us = f64::from(width.0) / 16.0;
            assert!(
                width.0 == 0 || (servo.min_us - 0.2..=servo.max_us + 0.2).contains(&us),
                "{us} us"
            );
        }
        self.settle();
    }

    /// The memory holds settings that are whole, or nothing; and so the pose.
    ///
    /// # Panics
    /// If not.
    pub fn assert_memory_is_right(&self) {
        let robot = self.robot.firmware();
        let mut settings = Settings::of(robot);
        let outcome = copies::load(robot, self.memory(), &mut settings);
        assert!(
            matches!(outcome, Outcome::Latest | Outcome::Blank),
            "{outcome:?}"
        );
        let is_forgotten = self.memory().read(RESTED.0) == 0xff;
        assert!(
            is_forgotten || copies::rested(robot, self.memory()).is_some(),
            "a pose that is not whole"
        );
        let beyond = 192..1024;
        assert!(beyond.into_iter().all(|at| self.memory().read(at) == 0xff));
    }
}
