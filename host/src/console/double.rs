//! For tests: the firmware's own console behind a connection, without a chip. Time
//! passes when nothing is left to read, much faster than on the wall.

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::time::Duration;

use lizard_core::console::{Console, Counters};
use lizard_core::memory::Bytes;
use lizard_core::restart::Restart;
use lizard_core::safety::Health;
use lizard_robot::Robot;

use super::link::{Link, Patience};

/// The core's console, its memory, and what it has written.
pub struct Double {
    console: Box<dyn FnMut(Option<u8>) -> String>,
    out: VecDeque<u8>,
    /// Every line it was sent.
    pub sent: String,
}

/// A connection to the paper's robot, its banner already read.
pub fn robot() -> Link<Double> {
    robot_of(PAPER)
}

/// The paper's robot.
pub const PAPER: &str = include_str!("../../../robots/paper.toml");

/// A connection to the robot of this robot.toml.
pub fn robot_of(text: &str) -> Link<Double> {
    let robot = Robot::parse(text).expect("its robot.toml is right");
    // The console holds it for as long as the test lasts.
    let robot = Box::leak(Box::new(robot));
    let mut link = Link::new(Double::of(robot), Patience::default());
    link.greet().expect("it has a banner");
    link
}

impl Double {
    fn of(robot: &'static Robot) -> Self {
        let mut memory = Bytes::default();
        let mut console = Console::new(robot.firmware());
        console.begin(&memory, &Restart::default());
        // A byte, or a frame without one.
        let step = move |byte: Option<u8>| {
            match byte {
                Some(byte) => console.receive(byte),
                None => {
                    console.frame(&Health::default());
                }
            }
            let mut text = String::new();
            while console.has_output() || console.is_writing() {
                console.write_memory(&mut memory);
                let Ok(()) = console.write_line(&mut text, Counters::default());
            }
            text
        };
        Self {
            console: Box::new(step),
            out: VecDeque::new(),
            sent: String::new(),
        }
    }
}

impl Read for Double {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if self.out.is_empty() {
            let text = (self.console)(None);
            self.out.extend(text.bytes());
        }
        if self.out.is_empty() {
            std::thread::sleep(Duration::from_micros(200));
            return Err(ErrorKind::TimedOut.into());
        }
        self.out.read(into)
    }
}

impl Write for Double {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.sent.push_str(&String::from_utf8_lossy(bytes));
        for byte in bytes {
            let text = (self.console)(Some(*byte));
            self.out.extend(text.bytes());
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
