//! A test double of a board: the firmware's console behind a connection, without a chip. Simulated time advances when
//! there is nothing left to read, much faster than real time.

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::time::Duration;

use lizard_core::memory::restart::Cause;
use lizard_core::virtual_board::RunningRobot;
use lizard_robot::{Calibration, Robot};
use pollster::block_on;

use super::link::Link;

/// The firmware's core on a virtual board, and its output.
pub struct BoardDouble {
    running_robot: RunningRobot,
    /// The robot's unread output.
    output: VecDeque<u8>,
    /// All text that the link has sent to the robot.
    sent_text: String,
    /// The line after which the board is unplugged.
    unplug_line: &'static str,
}

/// The robot.toml of the paper's robot.
pub const PAPER_TOML: &str = include_str!("../../../../../robots/paper.toml");

/// Connects to the paper's robot and reads its banner.
pub fn connect_paper_robot() -> Link<BoardDouble> {
    connect_paper_robot_unplugged_at("never sent")
}

/// Connects as [`connect_paper_robot`] does, to a board that is unplugged when it gets the line `unplug_line`.
pub fn connect_paper_robot_unplugged_at(unplug_line: &'static str) -> Link<BoardDouble> {
    let robot = Robot::parse(PAPER_TOML).expect("the robot.toml is valid");
    let mut link = Link::new(BoardDouble {
        running_robot: RunningRobot::power_on(*robot.firmware()),
        output: VecDeque::new(),
        sent_text: String::new(),
        unplug_line,
    });
    link.wait_for_robot().expect("the robot sends a banner");
    link
}

/// Reads the active calibration of a connected robot.
pub fn read_calibration(link: &mut Link<BoardDouble>) -> Calibration {
    block_on(lizard_calibrate::read_settings(link)).expect("the robot answers")
}

impl BoardDouble {
    /// Resets the board as a weak supply does.
    pub fn reset(&mut self) {
        self.running_robot.reset(Cause::BrownOut);
        self.collect_output();
    }

    /// Lets time pass, in which the robot receives nothing.
    pub fn run_frames(&mut self, count: u32) {
        for _ in 0..count {
            self.running_robot.run_frame();
            self.collect_output();
        }
    }

    /// Moves the robot's pending output into `output`.
    fn collect_output(&mut self) {
        self.running_robot.settle();
        let text = &mut self.running_robot.board.transmitter.text;
        self.output
            .extend(text.drain(..).map(|character| character as u8));
    }
}

impl Read for BoardDouble {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.sent_text.lines().next_back() == Some(self.unplug_line) {
            return Err(ErrorKind::BrokenPipe.into());
        }
        if self.output.is_empty() {
            self.running_robot.run_frame();
            self.collect_output();
        }
        if self.output.is_empty() {
            std::thread::sleep(Duration::from_micros(200));
            return Err(ErrorKind::TimedOut.into());
        }
        self.output.read(buffer)
    }
}

impl Write for BoardDouble {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.sent_text.push_str(&String::from_utf8_lossy(bytes));
        for byte in bytes {
            self.running_robot.board.send(&[*byte]);
            self.collect_output();
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
