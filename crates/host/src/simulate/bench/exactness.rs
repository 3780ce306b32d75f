//! The exactness of the servo pulses: errors of widths and periods in cycles.

use lizard_robot::CoreRobot;
use simulated_uno::max_pins_high;

use crate::simulate::board::{BoardError, SimulatedBoard};
use crate::simulate::sim::core_run;
use crate::simulate::sim::frame::{FRAME_CYCLES, first_cycle, group_frames};

/// The errors of the pulses' widths and periods.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exactness {
    /// Peak-to-peak error of the widths, cycles; `None` if the commands are not known because the firmware was built
    /// from different source code.
    pub jitter: Option<u64>,
    /// Largest deviation of a width from its command, cycles; `None` if the commands are not known.
    pub max_width_error: Option<u64>,
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
        let frame_count = sent_frames.len();
        let expected_run = core_run::play(*robot, received, &[], first_pulse_cycle, frame_count);
        let are_commands_known = banner.as_deref() == expected_run.text.lines().next();

        let (mut min_error, mut max_error) = (i64::MAX, i64::MIN);
        for (frame, commanded_widths) in sent_frames.iter().zip(&expected_run.widths) {
            for (width, commanded_width) in frame.widths.iter().zip(commanded_widths) {
                let error = width.unwrap_or(0) as i64 - i64::from(*commanded_width);
                min_error = min_error.min(error);
                max_error = max_error.max(error);
            }
        }
        let mut max_period_error = 0;
        let mut width_step = 0;
        for pair in sent_frames.windows(2) {
            for servo in 0..4 {
                if let (Some(current), Some(next)) =
                    (pair[0].pulse_starts[servo], pair[1].pulse_starts[servo])
                {
                    let period_error = (next - current).abs_diff(FRAME_CYCLES);
                    max_period_error = period_error.max(max_period_error);
                }
                if let (Some(current), Some(next)) = (pair[0].widths[servo], pair[1].widths[servo])
                {
                    width_step = gcd(width_step, current.abs_diff(next));
                }
            }
        }
        edges.retain(|edge| pins.contains(&edge.pin));
        let some_if_known = |cycles: u64| are_commands_known.then_some(cycles);
        Ok(Self {
            jitter: some_if_known(max_error.abs_diff(min_error)),
            max_width_error: some_if_known(min_error.unsigned_abs().max(max_error.unsigned_abs())),
            max_period_error,
            max_pins_high: max_pins_high(&edges),
            width_step: (width_step > 0).then_some(width_step),
        })
    }
}

/// Computes the greatest common divisor.
fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
