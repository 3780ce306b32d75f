//! Runs the firmware's core on this machine, for comparison with the simulated chip.
//!
//! The core is plain integer Rust. If it receives the same bytes before the same ticks, it must compute exactly the
//! same widths here as on the AVR. The pulses at the pins are compared with these widths: a difference is a bug in the
//! compiler, in the board's code or in the code for the pulses.
//!
//! The time when main reads a received byte must be reconstructed. Main reads a byte when the UNO has received it
//! completely and no answer or notice waits for room in the transmit buffer; the free room follows from the length of
//! the text written so far. Main also waits while it writes the EEPROM; these waits are not reconstructed and take no
//! time here.

use lizard_core::console::MAX_OUTPUT_LINE_BYTES;
use lizard_core::numbers::robot::Robot;
use lizard_core::virtual_board::{Adc, RunningRobot, Transmitter, VirtualBoard};
use simulated_uno::{CYCLES_PER_MS, SerialByte};

use super::frame::{FRAME_CYCLES, SLOT_CYCLES};
use super::press::ContactChange;
use super::supplies;

/// Cycles that the UNO takes to send a byte: 10 bits of 17 * 8 cycles.
const CYCLES_PER_BYTE: u64 = 1360;
/// Bytes that main can write before it must wait: 255 in the ring buffer and two in the transmitter.
const SERIAL_CAPACITY_BYTES: u64 = 255 + 2;
/// Largest number of queued bytes that leaves room for the longest answer.
const MAX_QUEUED_BYTES: u64 = SERIAL_CAPACITY_BYTES - MAX_OUTPUT_LINE_BYTES as u64;
/// Approximate cycles for the computation of a frame on the AVR.
const FRAME_COMPUTE_CYCLES: u64 = 8_000;
/// Most cycles for reading the end of a line and executing the line on the AVR.
const MAX_READING_CYCLES: u64 = 3_000;
/// Largest number of frames from power-on to A1's first pulse.
const MAX_FRAMES_TO_WAKE: usize = 500;

/// Starts a robot's main loop on a virtual board with healthy supplies.
fn power_on(robot: Robot<'static>) -> RunningRobot {
    let supplies = robot.supplies();
    let mut board = VirtualBoard::default();
    board.transmitter = Transmitter::new(CYCLES_PER_BYTE, SERIAL_CAPACITY_BYTES);
    board.adc = Adc::new(
        supplies::healthy_reading(&supplies),
        supplies.rail_reference_mv != 0,
    );
    RunningRobot::with_flash(robot.section(), board)
}

/// Runs the main loop from `cycle` until it has nothing left to do.
fn wake(run: &mut RunningRobot, cycle: u64) {
    run.board.transmitter.set_cycle(cycle);
    run.settle();
}

/// Runs a control tick at `cycle` and returns the pulse widths of its frame, cycles.
fn tick(run: &mut RunningRobot, cycle: u64) -> [u16; 4] {
    wake(run, cycle);
    run.board.tick();
    _ = run.main.step(&mut run.board);
    let widths = run.board.submitted_pulses().0.map(|width| width.0);
    // The output of a frame is written as soon as the frame is computed.
    wake(run, cycle + FRAME_COMPUTE_CYCLES);
    widths
}

/// Returns the cycle from which the transmit buffer has room for the longest answer, so that main writes waiting lines
/// and then reads the bytes that had to wait; `None` if nothing waits.
fn compute_next_wake_cycle(run: &RunningRobot) -> Option<u64> {
    let is_waiting = run.board.unread_count() > 0 || run.has_output();
    let idle_from_cycle = run.board.transmitter.idle_from_cycle();
    is_waiting.then(|| idle_from_cycle.saturating_sub(MAX_QUEUED_BYTES * CYCLES_PER_BYTE))
}

/// The core's pulse widths and text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CoreOutput {
    /// Widths of each frame from A1's first pulse, cycles; 0 for no pulse.
    pub widths: Vec<[u16; 4]>,
    /// The text written to the serial line; its counters `late` and `rx_lost` are always 0.
    pub text: String,
}

/// Runs a robot's core on a recording: `received` are the bytes that reached the UNO, `contact_changes` are the changes
/// of the robot's contacts, `first_pulse_cycle` is the cycle of A1's first pulse, and `frame_count` is the number of
/// frames from this pulse on. The result is exact except for the effects of the lines that [`find_undetermined_lines`]
/// returns.
pub fn play(
    robot: Robot<'static>,
    received: &[SerialByte],
    contact_changes: &[ContactChange],
    first_pulse_cycle: u64,
    frame_count: usize,
) -> CoreOutput {
    let mut changes = contact_changes.iter().peekable();
    let silent_count = count_frames_before_waking(robot);
    let mut run = power_on(robot);
    let mut received = received.iter().peekable();
    let mut widths = Vec::with_capacity(frame_count);
    for frame_index in 0..silent_count + frame_count {
        let start = first_pulse_cycle + frame_index as u64 * FRAME_CYCLES;
        // A control tick comes one slot before the first pulse of its frame.
        let tick_cycle = start.saturating_sub(silent_count as u64 * FRAME_CYCLES + SLOT_CYCLES);
        loop {
            let next_wake_cycle = compute_next_wake_cycle(&run)
                .filter(|next_wake_cycle| *next_wake_cycle < tick_cycle);
            let is_due = |byte: &&SerialByte| {
                byte.cycle < tick_cycle
                    && next_wake_cycle.is_none_or(|next_wake_cycle| byte.cycle < next_wake_cycle)
            };
            if let Some(byte) = received.next_if(is_due) {
                run.board.send(&[byte.value]);
                wake(&mut run, byte.cycle);
            } else if let Some(next_wake_cycle) = next_wake_cycle {
                wake(&mut run, next_wake_cycle);
            } else {
                break;
            }
        }
        while let Some(change) =
            changes.next_if(|change| change.time_ms * CYCLES_PER_MS < tick_cycle)
        {
            let bit = 1 << change.pin;
            if change.is_closed {
                run.board.closed_pins |= bit;
            } else {
                run.board.closed_pins &= !bit;
            }
        }
        let pulse_widths = tick(&mut run, tick_cycle);
        if frame_index >= silent_count {
            widths.push(pulse_widths);
        }
    }
    CoreOutput {
        widths,
        text: run.board.transmitter.text,
    }
}

/// Returns the indices of received lines that end so shortly before a control tick that main may read them before or
/// after the tick.
pub fn find_undetermined_lines(
    received: &[SerialByte],
    first_pulse_cycle: u64,
) -> impl Iterator<Item = usize> {
    let tick_cycle = first_pulse_cycle.saturating_sub(SLOT_CYCLES) % FRAME_CYCLES;
    let line_ends = received.iter().filter(|byte| byte.value == b'\n');
    let cycles_left = line_ends
        .map(move |end| (tick_cycle + FRAME_CYCLES - end.cycle % FRAME_CYCLES) % FRAME_CYCLES);
    cycles_left
        .enumerate()
        .filter_map(|(line, cycles_left)| (cycles_left < MAX_READING_CYCLES).then_some(line))
}

/// Counts the frames before A1's first pulse if no command arrives.
fn count_frames_before_waking(robot: Robot<'static>) -> usize {
    let mut run = power_on(robot);
    (0..MAX_FRAMES_TO_WAKE)
        .take_while(|_| tick(&mut run, 0)[0] == 0)
        .count()
}
