//! The firmware's core, which runs a second robot in the page without a simulated chip.
//!
//! Simulating another chip would double the CPU time. The core is plain integer Rust; its answers and pulses equal a
//! UNO's to the bit. Only the timing of single CPU cycles is missing.

use lizard_core::control::supply::Reading;
use lizard_core::memory::restart::Restart;
use lizard_core::virtual_board::{Eeprom, RunningRobot};
use lizard_robot::{CoreRobot, healthy_rail_mv};
use serde::Serialize;
use tsify::Tsify;

/// Number of codes of the analogue-to-digital converter.
const ADC_FULL_SCALE: f64 = 1024.0;
/// Voltage of the chip's bandgap reference, V.
const REFERENCE_VOLTS: f64 = 1.1;

/// The output of the core in one frame.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Tsify)]
pub struct CoreFrame {
    /// Pulse widths, CPU cycles of 62.5 ns, A1 to A4; 0 for no pulse.
    pub widths: [u16; 4],
    /// Text that was written to the serial line.
    pub text: String,
}

/// A running core of a robot.
pub struct RunningCore {
    running_robot: RunningRobot,
    /// Voltage at the measuring pin, behind the divider, while the servos' rail is healthy, mV; 0 without a rail.
    rail_pin_mv: f64,
}

impl RunningCore {
    /// Starts a robot's core as at power-on, with these EEPROM contents.
    pub fn power_on(robot: CoreRobot, memory: Eeprom) -> Self {
        Self {
            rail_pin_mv: healthy_rail_mv(&robot.supplies()).unwrap_or(0.0),
            running_robot: RunningRobot::with_memory(robot, memory, Restart::default()),
        }
    }

    /// Ends the run and returns the EEPROM's contents.
    pub fn into_memory(self) -> Eeprom {
        self.running_robot.board.memory
    }

    /// Runs a frame of 20 ms with a board supply of `volts`; the core first receives `bytes` from the serial line.
    pub fn run_frame(&mut self, bytes: &[u8], volts: f64) -> CoreFrame {
        let compute_adc_code = |pin_volts: f64, supply_volts: f64| {
            (ADC_FULL_SCALE * pin_volts / supply_volts).clamp(0.0, ADC_FULL_SCALE - 1.0)
        };
        let reading = Reading {
            reference: compute_adc_code(REFERENCE_VOLTS, volts).round() as u16,
            rail: compute_adc_code(self.rail_pin_mv / 1000.0, volts) as u16,
        };
        self.running_robot.board.adc.set_true_reading(reading);
        // The bytes arrive one by one, as on a serial line.
        for byte in bytes {
            self.running_robot.board.send(&[*byte]);
            self.running_robot.settle();
        }
        self.running_robot.run_frame();
        let board = &mut self.running_robot.board;
        CoreFrame {
            widths: board.submitted_pulses().0.map(|width| width.0),
            text: std::mem::take(&mut board.transmitter.text),
        }
    }
}

#[cfg(test)]
mod tests {
    use lizard_robot::Robot;

    use super::*;
    use crate::paper::load_paper_robot;

    /// Sends a line in the first frame and runs `frame_count` frames; returns the last pulse widths in CPU cycles.
    fn send_and_run(
        output: &mut String,
        core: &mut RunningCore,
        line: &str,
        frame_count: usize,
    ) -> [u16; 4] {
        let mut bytes = line.as_bytes();
        let mut widths = [0; 4];
        for _ in 0..frame_count {
            let frame = core.run_frame(bytes, 5.0);
            bytes = &[];
            *output += &frame.text;
            widths = frame.widths;
        }
        widths
    }

    #[test]
    fn the_core_prints_its_banner_walks_and_keeps_saved_settings() {
        let robot =
            Robot::parse(include_str!("../../../robots/large.toml")).expect("large.toml is valid");
        let mut core = RunningCore::power_on(*robot.firmware(), Eeprom::blank());
        let mut output = String::new();
        let standing_widths = send_and_run(&mut output, &mut core, "", 200);
        assert!(output.starts_with("# lizard "), "{output}");
        assert_eq!(standing_widths, [24_000; 4]);
        let trimmed_widths = send_and_run(&mut output, &mut core, "trim 1 3\nsave\n", 500);
        assert!(output.contains("ok trim 1 3"), "{output}");
        assert!(output.contains("ok save"), "{output}");
        let mut restarted_core = RunningCore::power_on(*robot.firmware(), core.into_memory());
        let widths = send_and_run(&mut output, &mut restarted_core, "", 200);
        assert_eq!(widths, trimmed_widths);
        let walking_widths = send_and_run(&mut output, &mut restarted_core, "walk\n", 60);
        assert_ne!(walking_widths, trimmed_widths);
    }

    #[test]
    fn a_low_supply_is_reported() {
        let mut core = RunningCore::power_on(*load_paper_robot().firmware(), Eeprom::blank());
        let mut output = String::new();
        send_and_run(&mut output, &mut core, "", 200);
        for _ in 0..200 {
            output += &core.run_frame(&[], 3.9).text;
        }
        assert!(output.contains("# supply:"), "{output}");
    }
}
