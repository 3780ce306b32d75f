//! Ten million random bytes and ten million lines that are nearly right, through the
//! core on this machine: one answer for each line, no pulse outside the limits, a
//! memory that is always right.
//!
//! `LIZARD_FUZZ=10` takes ten times as many.

use std::thread;

use fastrand::Rng;
use lizard_core::console::{Console, Counters};
use lizard_core::memory::{Bytes, Memory};
use lizard_core::record::{self, Outcome, RESTED};
use lizard_core::restart::Restart;
use lizard_core::safety::Health;
use lizard_core::settings::Settings;
use lizard_core::supply::Reading;
use lizard_host_tests::robot;
use lizard_robot::Firmware;

#[path = "firmware/lines.rs"]
mod lines;

/// How many of each.
const COUNT: u64 = 10_000_000;

/// Parts that run at once.
const PARTS: u64 = 2;

fn count() -> u64 {
    let times = std::env::var("LIZARD_FUZZ").ok();
    let times = times.and_then(|times| times.parse::<f64>().ok());
    (COUNT as f64 * times.unwrap_or(1.0)) as u64
}

/// The core on a board without time.
struct Board {
    console: Console<&'static Firmware>,
    memory: Bytes,
    health: Health,
    said: String,
    /// The line under way as another reader of lines has it.
    line: Vec<u8>,
    overlong: bool,
}

impl Board {
    fn new() -> Self {
        let memory = Bytes::default();
        let health = Health {
            supply: Reading {
                reference: 225,
                rail: 225 * 3,
            },
            ..Health::default()
        };
        let mut console = Console::new(robot().firmware());
        console.begin(&memory, &Restart::default());
        let mut board = Self {
            console,
            memory,
            health,
            said: String::new(),
            line: Vec::new(),
            overlong: false,
        };
        board.settle();
        board
    }

    /// Lets it write all that it has to write.
    fn settle(&mut self) {
        for _ in 0..10_000 {
            if self.console.has_output() {
                let Ok(()) = self.console.write_line(&mut self.said, Counters::default());
            } else if self.console.is_writing() {
                self.console.write_memory(&mut self.memory);
            } else {
                return;
            }
        }
        panic!("it never rests");
    }

    /// A byte; what it ends has exactly one answer.
    fn take(&mut self, byte: u8) {
        self.said.clear();
        self.console.receive(byte);
        if self.console.has_output() || self.console.is_writing() {
            self.settle();
        }
        let mut due = 0;
        match byte {
            b'\r' | b'\n' => {
                due = usize::from(self.overlong || !self.line.trim_ascii().is_empty());
                self.line.clear();
                self.overlong = false;
            }
            0x08 | 0x7f => _ = self.line.pop(),
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
    fn frame(&mut self) {
        let pulses = self.console.frame(&self.health);
        for (width, servo) in pulses.0.into_iter().zip(robot().servos()) {
            let us = f64::from(width.0) / 16.0;
            assert!(
                width.0 == 0 || (servo.min_us - 0.2..=servo.max_us + 0.2).contains(&us),
                "{us} us"
            );
        }
        self.settle();
    }

    /// The memory holds settings that are whole, or nothing; and so the pose.
    fn assert_memory_is_right(&self) {
        let robot = robot().firmware();
        let mut settings = Settings::of(robot);
        let outcome = record::load(robot, &self.memory, &mut settings);
        assert!(
            matches!(outcome, Outcome::Latest | Outcome::Blank),
            "{outcome:?}"
        );
        let is_forgotten = self.memory.read(RESTED.0) == 0xff;
        assert!(
            is_forgotten || record::rested(robot, &self.memory).is_some(),
            "a pose that is not whole"
        );
        let beyond = 192..1024;
        assert!(beyond.into_iter().all(|at| self.memory.read(at) == 0xff));
    }
}

/// Runs parts of a test at once.
fn in_parts(part: impl Fn(&mut Rng, u64) + Sync) {
    thread::scope(|scope| {
        let run = |n| {
            let part = &part;
            scope.spawn(move || part(&mut lizard_host_tests::rng(1000 + n), count() / PARTS))
        };
        let parts: Vec<_> = (0..PARTS).map(run).collect();
        for part in parts {
            assert!(part.join().is_ok());
        }
    });
}

#[test]
fn ten_million_random_bytes_do_no_harm_to_the_core() {
    in_parts(|rng, count| {
        let mut board = Board::new();
        for n in 0..count {
            // Line ends more often than by chance.
            let byte = if rng.u8(..32) == 0 { b'\n' } else { rng.u8(..) };
            board.take(byte);
            if n % 64 == 0 {
                board.frame();
            }
            if n % 65_536 == 0 {
                board.assert_memory_is_right();
            }
        }
        board.take(b'\n');
        for byte in b"stop\n" {
            board.take(*byte);
        }
        assert!(board.said.starts_with("ok ") || board.said.contains("err 7"));
    });
}

#[test]
fn ten_million_lines_that_are_nearly_right_do_no_harm_to_the_core() {
    in_parts(|rng, count| {
        let mut board = Board::new();
        let mut accepted = 0u64;
        for n in 0..count {
            for byte in lines::mutated(rng) {
                board.take(byte);
            }
            board.take(b'\n');
            accepted += u64::from(board.said.contains("ok "));
            if n % 16 == 0 {
                board.frame();
            }
            if n % 4_096 == 0 {
                board.assert_memory_is_right();
            }
        }
        assert!(accepted > count / 4, "{accepted} of {count}");
    });
}
