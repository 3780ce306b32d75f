//! The exactness of the pulses: widths and periods in cycles.

use simulated_uno::most_pins_high;

use lizard_robot::CoreRobot;

use crate::simulate::board::{BoardError, SimulatedBoard};
use crate::simulate::sim::core_run;
use crate::simulate::sim::frame::{FRAME, first_cycle, group_frames};

/// The errors of the pulses' widths and periods.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exactness {
    /// Smallest and largest difference between a width and its command, cycles; `None` if the commands are not
    /// known, because the firmware was built from another source.
    pub error: Option<[i64; 2]>,
    /// Largest deviation of the distance between two frames from 20 ms, cycles.
    pub period_error: u64,
    /// Largest number of servo pins that are high at the same time.
    pub pins_high: u32,
    /// The step in which widths vary, cycles; `None` if they do not vary.
    pub step: Option<u64>,
}

impl Exactness {
    /// Measures all pulses that the firmware of `robot` has sent so far. The commands that set them must be within
    /// the first `command_bytes` bytes that the board received.
    ///
    /// # Errors
    /// Fails if the board has sent no pulse.
    pub fn measure(
        board: &mut SimulatedBoard,
        robot: &CoreRobot,
        command_bytes: usize,
    ) -> Result<Self, BoardError> {
        let banner = board.lines().first().map(|line| line.text.clone());
        let first_pulse = board.first_pulse()?;
        let pins = board.pins();
        let mut edges = board.uno.edges();
        let frame_count = (board.uno.cycle() - first_cycle(first_pulse)) / FRAME;
        let frames_sent = group_frames(&edges, pins, first_pulse, frame_count);
        let received = &board.uno.received_by_uno()[..command_bytes];
        let expected_run = core_run::play(*robot, received, first_pulse, frames_sent.len());
        let is_known = banner.as_deref() == expected_run.written.lines().next();

        let mut error_range = [i64::MAX, i64::MIN];
        let (mut period_error, mut width_step) = (0, 0);
        for (frame, commanded_widths) in frames_sent.iter().zip(&expected_run.widths) {
            for (width, commanded_width) in frame.widths.iter().zip(commanded_widths) {
                let difference = width.unwrap_or(0) as i64 - i64::from(*commanded_width);
                error_range = [
                    error_range[0].min(difference),
                    error_range[1].max(difference),
                ];
            }
        }
        for pair in frames_sent.windows(2) {
            for servo in 0..4 {
                if let (Some(current), Some(next)) = (pair[0].starts[servo], pair[1].starts[servo])
                {
                    period_error = (next - current).abs_diff(FRAME).max(period_error);
                }
                if let (Some(current), Some(next)) = (pair[0].widths[servo], pair[1].widths[servo])
                {
                    width_step = gcd(width_step, current.abs_diff(next));
                }
            }
        }
        edges.retain(|edge| pins.contains(&edge.pin));
        Ok(Self {
            error: is_known.then_some(error_range),
            period_error,
            pins_high: most_pins_high(&edges),
            step: (width_step > 0).then_some(width_step),
        })
    }

    /// Peak-to-peak error of the widths, cycles.
    pub fn jitter(&self) -> Option<u64> {
        self.error
            .map(|[min_error, max_error]| max_error.abs_diff(min_error))
    }

    /// Worst deviation of a width from its command, cycles.
    pub fn max_width_error(&self) -> Option<u64> {
        self.error
            .map(|[min_error, max_error]| min_error.unsigned_abs().max(max_error.unsigned_abs()))
    }
}

/// The greatest common divisor.
fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
