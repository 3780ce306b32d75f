//! A test double: the firmware's own console behind a connection, without a chip. Time advances
//! when there is nothing left to read, much faster than real time.

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::time::Duration;

use lizard_core::virtual_board::RunningRobot;
use lizard_robot::{Calibration, Robot};
use pollster::block_on;

use super::link::{Link, Timeouts};

/// The core on a virtual board, and its output.
pub struct ConsoleDouble {
    running: RunningRobot,
    out: VecDeque<u8>,
    /// All text that the link has sent to the robot.
    pub sent: String,
}

/// A connection to the paper's robot, its banner already read.
pub fn connect_paper_robot() -> Link<ConsoleDouble> {
    connect_robot(PAPER)
}

/// The robot.toml of the paper's robot.
pub const PAPER: &str = include_str!("../../../../../robots/paper.toml");

/// A connection to the robot of this robot.toml, its banner already read.
pub fn connect_robot(text: &str) -> Link<ConsoleDouble> {
    let robot = Robot::parse(text).expect("its robot.toml is right");
    let mut link = Link::new(ConsoleDouble::of(&robot), Timeouts::default());
    link.greet().expect("it has a banner");
    link
}

/// The settings of a connected robot.
pub fn calibration_of(link: &mut Link<ConsoleDouble>) -> Calibration {
    block_on(lizard_calibrate::read(link)).expect("it answers")
}

impl ConsoleDouble {
    fn of(robot: &Robot) -> Self {
        Self {
            running: RunningRobot::power_on(*robot.firmware()),
            out: VecDeque::new(),
            sent: String::new(),
        }
    }

    /// Moves the robot's pending output into `out`.
    fn collect(&mut self) {
        self.running.settle();
        let text = &mut self.running.board.transmitter.text;
        self.out
            .extend(text.drain(..).map(|character| character as u8));
    }
}

impl Read for ConsoleDouble {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.out.is_empty() {
            self.running.frame();
            self.collect();
        }
        if self.out.is_empty() {
            std::thread::sleep(Duration::from_micros(200));
            return Err(ErrorKind::TimedOut.into());
        }
        self.out.read(buffer)
    }
}

impl Write for ConsoleDouble {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.sent.push_str(&String::from_utf8_lossy(bytes));
        for byte in bytes {
            self.running.board.send(&[*byte]);
            self.collect();
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
