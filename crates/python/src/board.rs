//! A simulated board: the firmware's core without a chip.

use std::sync::{Mutex, PoisonError};

use lizard_core::memory::restart::Cause;
use lizard_core::virtual_board::RunningRobot;
use pyo3::prelude::*;

use crate::robot::Robot;

/// The firmware's core with a robot, which runs frames of 20 ms.
#[pyclass(frozen)]
pub struct Board(Mutex<RunningRobot>);

#[pymethods]
impl Board {
    /// Creates a board with a robot, just after power-on.
    #[new]
    fn new(robot: &Robot) -> Self {
        Self(Mutex::new(RunningRobot::power_on(*robot.0.firmware())))
    }

    /// Sends bytes to the robot, runs one frame, and returns the text from the robot.
    fn run_frame(&self, bytes: &[u8]) -> String {
        // The firmware receives the bytes one by one, as from a serial line.
        let mut running = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        for byte in bytes {
            running.board.send(&[*byte]);
            running.settle();
        }
        running.run_frame();
        core::mem::take(&mut running.board.transmitter.text)
    }

    /// Resets the board as its reset button does.
    fn reset(&self) {
        let mut running = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        running.reset(Cause::External);
    }
}
