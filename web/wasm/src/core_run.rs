//! The firmware's core running in the page without a chip, for a second robot.
//!
//! Simulating another chip would double the CPU time. The core is plain integer Rust, so its answers
//! and pulses equal those of a UNO to the bit; only the timing by the chip's cycles is missing.

use lizard_core::control::supply::Reading;
use lizard_core::memory::restart::Restart;
use lizard_core::virtual_board::{Eeprom, RunningRobot};
use lizard_robot::{CoreRobot, healthy_rail_mv};
use serde::Serialize;
use tsify::Tsify;

/// Number of steps of the analogue converter, and the voltage of the chip's internal reference, V.
const FULL_SCALE: f64 = 1024.0;
const REFERENCE_VOLTS: f64 = 1.1;

/// The output of a frame.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Tsify)]
pub struct CoreFrame {
    /// Pulse widths, CPU cycles of 62.5 ns, A1 to A4; 0 for no pulse.
    pub widths: [u16; 4],
    /// Text that was written to the serial line.
    pub text: String,
}

/// The core of a robot, running.
pub struct CoreRun {
    running: RunningRobot,
    /// Voltage at the measuring pin while the servos' rail is healthy, mV; 0 if the rail is not measured.
    rail_mv: f64,
}

impl CoreRun {
    /// Starts a robot's core at power-on, with the content of its EEPROM.
    #[must_use]
    pub fn begin(robot: CoreRobot, memory: Eeprom) -> Self {
        Self {
            rail_mv: healthy_rail_mv(&robot.supplies()).unwrap_or(0.0),
            running: RunningRobot::with_memory(robot, memory, Restart::default()),
        }
    }

    /// The EEPROM after the run.
    #[must_use]
    pub fn into_memory(self) -> Eeprom {
        self.running.board.memory
    }

    /// Runs one frame of 20 ms at a supply in V; the core first receives the bytes from the serial line.
    pub fn frame(&mut self, bytes: &[u8], volts: f64) -> CoreFrame {
        let converter_steps = |volts: f64, full_volts: f64| {
            (FULL_SCALE * volts / full_volts).clamp(0.0, FULL_SCALE - 1.0)
        };
        self.running.board.converter.set(Reading {
            reference: converter_steps(REFERENCE_VOLTS, volts).round() as u16,
            rail: converter_steps(self.rail_mv / 1000.0, volts) as u16,
        });
        // The bytes arrive one by one, as on a serial line.
        for byte in bytes {
            self.running.board.send(&[*byte]);
            self.running.settle();
        }
        self.running.frame();
        CoreFrame {
            widths: self.running.board.submitted().0.map(|width| width.0),
            text: std::mem::take(&mut self.running.board.transmitter.text),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lizard_robot::Robot;

    fn run_line(output: &mut String, core: &mut CoreRun, line: &str, frames: usize) -> [u16; 4] {
        let mut bytes = line.as_bytes();
        let mut widths = [0; 4];
        for _ in 0..frames {
            let frame = core.frame(bytes, 5.0);
            bytes = &[];
            *output += &frame.text;
            widths = frame.widths;
        }
        widths
    }

    #[test]
    fn the_core_prints_its_banner_walks_and_keeps_saved_settings() {
        let robot = Robot::parse(include_str!("../../../robots/large.toml")).expect("right");
        let mut core = CoreRun::begin(*robot.firmware(), Eeprom::blank());
        let mut output = String::new();
        let standing_widths = run_line(&mut output, &mut core, "", 200);
        assert!(output.starts_with("# lizard "), "{output}");
        assert!(
            standing_widths.iter().all(|width| *width == 24_000),
            "{standing_widths:?}"
        );
        let trimmed_widths = run_line(&mut output, &mut core, "trim 1 3\nsave\n", 500);
        assert!(
            output.contains("ok trim 1 3") && output.contains("ok save"),
            "{output}"
        );
        let mut restarted = CoreRun::begin(*robot.firmware(), core.into_memory());
        assert_eq!(
            run_line(&mut output, &mut restarted, "", 200),
            trimmed_widths
        );
        assert_ne!(
            run_line(&mut output, &mut restarted, "walk\n", 60),
            trimmed_widths
        );
    }

    #[test]
    fn a_low_supply_stops_the_core() {
        let robot = Robot::parse(include_str!("../../../robots/paper.toml")).expect("right");
        let mut core = CoreRun::begin(*robot.firmware(), Eeprom::blank());
        let mut output = String::new();
        run_line(&mut output, &mut core, "", 200);
        for _ in 0..200 {
            output += &core.frame(&[], 3.9).text;
        }
        assert!(output.contains("# supply:"), "{output}");
    }
}
