//! The firmware's core, which runs a second robot in the page without a simulated chip.
//!
//! Simulating another chip would double the CPU time. The core is plain integer Rust; its answers and pulses equal a
//! UNO's to the bit. Only the timing of single CPU cycles is missing.

use lizard_core::control::supply::Reading;
use lizard_core::virtual_board::RunningRobot;
use lizard_robot::{CoreRobot, healthy_rail_pin_mv};

/// Number of codes of the analogue-to-digital converter.
const ADC_FULL_SCALE: f64 = 1024.0;
/// Voltage of the chip's bandgap reference, V.
const REFERENCE_VOLTS: f64 = 1.1;

/// A running core of a robot.
pub struct RunningCore {
    running_robot: RunningRobot,
    /// Voltage at the measuring pin, behind the divider, while the servos' rail is healthy, mV; 0 if the rail is not
    /// measured.
    rail_pin_mv: f64,
}

impl RunningCore {
    /// Starts a robot's core as at power-on, with an erased EEPROM.
    pub fn power_on(robot: CoreRobot) -> Self {
        Self {
            rail_pin_mv: healthy_rail_pin_mv(&robot.supplies()).unwrap_or(0.0),
            running_robot: RunningRobot::power_on(robot),
        }
    }

    /// Runs a frame of 20 ms with a board supply of `volts`; the core first receives `bytes` from the serial line.
    /// Returns the pulse widths of A1 to A4, in CPU cycles of 62.5 ns; 0 for no pulse.
    pub fn run_frame(&mut self, bytes: &[u8], volts: f64) -> [u16; 4] {
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
        let pulses = self.running_robot.board.submitted_pulses();
        pulses.0.map(|width| width.0)
    }
}

#[cfg(test)]
mod tests {
    use lizard_robot::Robot;

    use super::*;
    use crate::paper::load_paper_robot;

    /// Sends a line in the first frame and runs `frame_count` frames; returns the last pulse widths in CPU cycles.
    fn send_and_run(core: &mut RunningCore, line: &str, frame_count: usize) -> [u16; 4] {
        let mut widths = core.run_frame(line.as_bytes(), 5.0);
        for _ in 1..frame_count {
            widths = core.run_frame(&[], 5.0);
        }
        widths
    }

    /// Returns the text that the core has written to the serial line.
    fn read_output(core: &RunningCore) -> &str {
        &core.running_robot.board.transmitter.text
    }

    #[test]
    fn the_core_prints_its_banner_accepts_a_trim_and_walks() {
        let robot =
            Robot::parse(include_str!("../../../robots/large.toml")).expect("large.toml is valid");
        let mut core = RunningCore::power_on(*robot.firmware());
        let standing_widths = send_and_run(&mut core, "", 200);
        let output = read_output(&core);
        assert!(output.starts_with("# lizard "), "{output}");
        assert_eq!(standing_widths, [24_000; 4]);
        let trimmed_widths = send_and_run(&mut core, "trim 1 3\n", 500);
        let output = read_output(&core);
        assert!(output.contains("ok trim 1 3"), "{output}");
        assert_ne!(trimmed_widths, standing_widths);
        let walking_widths = send_and_run(&mut core, "walk\n", 60);
        assert_ne!(walking_widths, trimmed_widths);
    }

    #[test]
    fn a_low_supply_is_reported() {
        let mut core = RunningCore::power_on(*load_paper_robot().firmware());
        send_and_run(&mut core, "", 200);
        for _ in 0..200 {
            core.run_frame(&[], 3.9);
        }
        let output = read_output(&core);
        assert!(output.contains("# supply:"), "{output}");
    }
}
