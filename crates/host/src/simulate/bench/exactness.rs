//! The exactness of the servo pulses: errors of widths and periods in cycles.

use simulated_uno::max_pins_high;

use lizard_robot::CoreRobot;

use crate::simulate::board::{BoardError, SimulatedBoard};
use crate::simulate::sim::core_run;
use crate::simulate::sim::frame::{FRAME_CYCLES, first_cycle, group_frames};

/// The errors of the pulses' widths and periods.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exactness {
    /// Smallest and largest difference between a width and its command, cycles; `None` if the commands are not known
    /// because the firmware was built from different source code.
    pub width_error_range: Option<[i64; 2]>,
    /// Largest deviation of a servo's pulse period from 20 ms, cycles.
    pub max_period_error: u64,
    /// Largest number of servo pins that are high at the same time.
    pub max_pins_high: u32,
    /// The greatest common divisor of all width changes, cycles; `None` if the widths do not change.
    pub width_step: Option<u64>,
}

impl Exactness {
    /// Measures all pulses that the board has sent so far. The first `command_bytes` bytes that the board received must
    /// contain all commands that determine the pulses.
    ///
    /// # Errors
    /// Fails if the board has sent no pulse.
    pub fn measure(
        board: &mut SimulatedBoard,
        robot: &CoreRobot,
        command_bytes: usize,
    ) -> Result<Self, BoardError> {
        let banner = board.lines().first().map(|line| line.text.clone());
        let first_pulse_cycle = board.first_pulse_cycle()?;
        let pins = board.pins();
        let mut edges = board.uno.edges();
        let frame_count = (board.uno.cycle() - first_cycle(first_pulse_cycle)) / FRAME_CYCLES;
        let sent_frames = group_frames(&edges, pins, first_pulse_cycle, frame_count);
        let received = &board.uno.received_by_uno()[..command_bytes];
        let expected_run = core_run::play(*robot, received, first_pulse_cycle, sent_frames.len());
        let are_commands_known = banner.as_deref() == expected_run.text.lines().next();

        let mut error_range = [i64::MAX, i64::MIN];
        let (mut max_period_error, mut width_step) = (0, 0);
        for (frame, commanded_widths) in sent_frames.iter().zip(&expected_run.widths) {
            for (width, commanded_width) in frame.widths.iter().zip(commanded_widths) {
                let difference = width.unwrap_or(0) as i64 - i64::from(*commanded_width);
                error_range = [
                    error_range[0].min(difference),
                    error_range[1].max(difference),
                ];
            }
        }
        for pair in sent_frames.windows(2) {
            for servo in 0..4 {
                if let (Some(current), Some(next)) = (pair[0].starts[servo], pair[1].starts[servo])
                {
                    max_period_error = (next - current)
                        .abs_diff(FRAME_CYCLES)
                        .max(max_period_error);
                }
                if let (Some(current), Some(next)) = (pair[0].widths[servo], pair[1].widths[servo])
                {
                    width_step = gcd(width_step, current.abs_diff(next));
                }
            }
        }
        edges.retain(|edge| pins.contains(&edge.pin));
        Ok(Self {
            width_error_range: are_commands_known.then_some(error_range),
            max_period_error,
            max_pins_high: max_pins_high(&edges),
            width_step: (width_step > 0).then_some(width_step),
        })
    }

    /// Returns the peak-to-peak error of the widths, cycles; `None` if the commands are not known.
    pub fn jitter(&self) -> Option<u64> {
        self.width_error_range
            .map(|[min_error, max_error]| max_error.abs_diff(min_error))
    }

    /// Returns the largest deviation of a width from its command, cycles; `None` if the commands are not known.
    pub fn max_width_error(&self) -> Option<u64> {
        self.width_error_range
            .map(|[min_error, max_error]| min_error.unsigned_abs().max(max_error.unsigned_abs()))
    }
}

/// Computes the greatest common divisor.
fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
