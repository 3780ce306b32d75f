//! A robot that walks or stands, and its expected pulse widths, for tests that disturb the robot at chosen cycles.

use lizard_host::sim::core_run;
use lizard_host::sim::frame::{FRAME_CYCLES, Frame, group_frames};
use lizard_host_tests::{FirmwareBench, robot};
use lizard_robot::Robot;
use simulated_uno::Fidelity;

use crate::measurements::peek_word;
use crate::{boot_to_stand, first_moving_gait};

/// Cycles from the start of one servo's pulse to the start of the next servo's pulse.
pub const SLOT_CYCLES: u64 = FRAME_CYCLES / 5;

/// A robot that walks or stands. Its expected widths follow from the received bytes and the first pulse.
pub struct ReferenceRun<'a> {
    pub bench: FirmwareBench,
    robot: &'a Robot,
    /// The cycle at which A1's first pulse begins.
    pub first_pulse_cycle: u64,
    /// The number of received bytes that affect the widths.
    pub received_byte_count: usize,
}

impl ReferenceRun<'static> {
    /// Starts the robot's first gait that moves, and runs for a second.
    pub fn start_walking(fidelity: Fidelity) -> Self {
        Self::start(&first_moving_gait(), fidelity)
    }

    /// Makes the robot stand in its neutral pose and runs for a second.
    pub fn start_standing(fidelity: Fidelity) -> Self {
        Self::start("stand", fidelity)
    }

    fn start(line: &str, fidelity: Fidelity) -> Self {
        let mut run = Self::with_lines(boot_to_stand(fidelity), robot(), &[line]);
        run.bench.run_ms(1000);
        run
    }
}

impl<'a> ReferenceRun<'a> {
    /// Sends lines to a standing robot. No later byte may affect the widths.
    pub fn with_lines(mut bench: FirmwareBench, robot: &'a Robot, lines: &[&str]) -> Self {
        for line in lines {
            bench.say(line);
        }
        Self {
            robot,
            first_pulse_cycle: bench.first_pulse_cycle().expect("the robot stands"),
            received_byte_count: bench.uno.received_by_uno().len(),
            bench,
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
        let sent_frames = group_frames(&edges, self.bench.pins(), start, count);
        let expected = self.expected_widths(start, sent_frames.len());
        sent_frames.into_iter().zip(expected).collect()
    }

    /// Checks that each frame from cycle `start` to now has its expected widths, and returns the number of frames.
    #[track_caller]
    pub fn assert_exact_since(&self, start: u64, case: &str) -> usize {
        let frames = self.frames_since(start);
        for (frame, expected) in &frames {
            assert_eq!(frame.all_widths(), Some(*expected), "{case}: {frame:?}");
        }
        frames.len()
    }

    /// Computes the widths of `count` frames from cycle `start` on with the core on the host.
    pub fn expected_widths(&self, start: u64, count: usize) -> Vec<[u64; 4]> {
        let first_rise = self.first_pulse_cycle;
        let frames_before = ((start - first_rise) / FRAME_CYCLES) as usize;
        let firmware = *self.robot.firmware();
        let frame_count = frames_before + count;
        let received = &self.bench.uno.received_by_uno()[..self.received_byte_count];
        let host_run = core_run::play(firmware, received, &[], first_rise, frame_count);
        let widths = host_run.widths[frames_before..].iter();
        widths.map(|widths| widths.map(u64::from)).collect()
    }

    /// Runs until `cycle`, which must not have passed: otherwise a test would disturb the robot too late, and see
    /// nothing.
    pub fn run_to(&mut self, cycle: u64) {
        let now = self.bench.uno.cycle();
        assert!(now <= cycle, "cycle {cycle} has passed, now {now}");
        self.bench.uno.run_until_cycle(cycle);
    }

    /// Returns the address of one of the firmware's variables, such as `pulses::LATE_EDGES`.
    pub fn variable_address(&self, variable: &str) -> u16 {
        let address = self.bench.uno.image().variable(variable);
        address.unwrap_or_else(|| panic!("the firmware has no variable {variable}"))
    }

    /// Returns the value of one of the firmware's 16-bit variables.
    pub fn read_word(&self, variable: &str) -> u16 {
        peek_word(&self.bench.uno, self.variable_address(variable))
    }

    /// Returns the number of edges that the firmware has counted as late.
    pub fn late_edge_count(&self) -> u64 {
        self.read_word("pulses::LATE_EDGES").into()
    }
}
