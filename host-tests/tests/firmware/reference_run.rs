//! A robot that walks or stands, and its expected pulse widths, for tests that disturb the robot at chosen cycles.

use lizard_host::sim::frame::{FRAME_CYCLES, Frame, group_frames, servo_pins};
use lizard_host_tests::{FirmwareBench, robot};
use simulated_uno::Fidelity;

use crate::pulses::compute_core_widths;
use crate::{boot_to_stand, first_moving_gait};

/// Cycles from the start of one servo's pulse to the start of the next servo's pulse.
pub const SLOT_CYCLES: u64 = FRAME_CYCLES / 5;

/// A robot that walks its first gait or stands. Its expected widths follow from the received bytes and the first pulse.
pub struct ReferenceRun {
    pub bench: FirmwareBench,
    fidelity: Fidelity,
    first_pulse_cycle: u64,
    received_byte_count: usize,
}

impl ReferenceRun {
    /// Starts the robot's first gait and runs for a second.
    pub fn start_walking(fidelity: Fidelity) -> Self {
        Self::start(&first_moving_gait(), fidelity)
    }

    /// Makes the robot stand in its neutral pose and runs for a second.
    pub fn start_standing(fidelity: Fidelity) -> Self {
        Self::start("stand", fidelity)
    }

    fn start(line: &str, fidelity: Fidelity) -> Self {
        let mut bench = boot_to_stand(fidelity);
        let first_pulse_cycle = bench.first_pulse_cycle().expect("the robot stands");
        bench.say(line);
        let received_byte_count = bench.uno.received_by_uno().len();
        bench.run_ms(1000);
        Self {
            bench,
            fidelity,
            first_pulse_cycle,
            received_byte_count,
        }
    }

    /// Runs to just before the first pulse of the next frame and returns the pulse's cycle. Discards the edges recorded
    /// so far.
    pub fn run_to_next_frame(&mut self) -> u64 {
        self.bench.run_for_frames(0);
        let cycles_since_pulse = self.bench.uno.cycle() - self.first_pulse_cycle;
        self.first_pulse_cycle + cycles_since_pulse.div_ceil(FRAME_CYCLES) * FRAME_CYCLES
    }

    /// Returns the frames from cycle `start` to now, each with its expected widths.
    pub fn frames_since(&self, start: u64) -> Vec<(Frame, [u64; 4])> {
        let count = (self.bench.uno.cycle() + SLOT_CYCLES / 2 - start) / FRAME_CYCLES;
        let edges = self.bench.uno.edges();
        let sent_frames = group_frames(&edges, servo_pins(robot()), start, count);
        let expected = self.expected_widths(start, count);
        sent_frames.into_iter().zip(expected).collect()
    }

    /// Returns the expected widths of `count` frames from cycle `start` on.
    pub fn expected_widths(&self, start: u64, count: u64) -> Vec<[u64; 4]> {
        let silent_frame = Frame {
            start,
            starts: [None; 4],
            widths: [None; 4],
        };
        let frames = vec![silent_frame; count as usize];
        let (first_rise, count) = (self.first_pulse_cycle, self.received_byte_count);
        compute_core_widths(robot(), &self.bench, first_rise, count, &frames)
    }

    /// True if the simulation is simavr corrected to follow the data sheet.
    pub fn is_data_sheet_simulation(&self) -> bool {
        self.fidelity == Fidelity::DataSheet
    }

    pub fn run_to(&mut self, cycle: u64) {
        self.bench.uno.run_until_cycle(cycle);
    }

    /// Returns the address of one of the firmware's variables, such as `pulses::LATE_EDGES`.
    pub fn variable_address(&self, variable: &str) -> u16 {
        let address = self.bench.uno.image().variable(variable);
        address.unwrap_or_else(|| panic!("the firmware has no variable {variable}"))
    }

    /// Returns the value of one of the firmware's 16-bit variables.
    pub fn read_word(&self, variable: &str) -> u16 {
        let address = self.variable_address(variable);
        u16::from_le_bytes([0, 1].map(|n| self.bench.uno.peek(address + n)))
    }

    /// Returns the number of edges that the firmware has counted as late.
    pub fn late_edge_count(&self) -> u64 {
        self.read_word("pulses::LATE_EDGES").into()
    }
}
