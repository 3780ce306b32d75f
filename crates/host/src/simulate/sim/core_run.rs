//! The firmware's core run on this machine, compared with the simulated chip.
//!
//! The core is plain integer Rust, so with the same bytes received before the same ticks it
//! must compute the same widths here as on the AVR, to the bit. The pulses at the pins are
//! compared with them: any difference is a fault of the compiler, of the board's code or of the
//! pulses.
//!
//! The time at which main takes a byte has to be reconstructed. Main takes it not before the byte is complete at the
//! UNO, and not while the serial line has no room for the longest answer, which follows from the length of the text
//! written so far. Main also waits while it writes the EEPROM; these waits are not reconstructed, and take no time
//! here.

use lizard_core::console::LONGEST_LINE;
use lizard_core::numbers::robot::Robot;
use lizard_core::virtual_board::{Converter, RunningRobot, Transmitter, VirtualBoard};
use simulated_uno::{CYCLES_PER_MS, SerialByte};

use super::frame::{FRAME, SLOT};
use super::press::ContactChange;
use super::supplies;

/// Cycles that the UNO takes to send a byte: 10 bits, 17 * 8 cycles each.
const BYTE_CYCLES: u64 = 1360;
/// Bytes that the serial line takes before its writer has to wait: a ring of 255,
/// and two in the transmitter.
const CAPACITY: u64 = 255 + 2;
/// Largest number of queued bytes that leaves room for the longest answer.
const MAX_QUEUED: u64 = CAPACITY - LONGEST_LINE as u64;
/// Cycles that the AVR takes to compute a frame, approximately.
const COMPUTE_CYCLES: u64 = 8_000;
/// Cycles that the AVR takes to read the end of a line and to act on it, at most.
const MAX_READING_CYCLES: u64 = 3_000;
/// Largest number of frames from power-on until the robot wakes.
const MAX_FRAMES_TO_WAKE: usize = 500;

/// The firmware's main loop on a virtual board.
struct CoreRun {
    running: RunningRobot,
}

impl CoreRun {
    fn new(robot: Robot<'static>) -> Self {
        let supplies = robot.supplies();
        let mut board = VirtualBoard::default();
        board.transmitter = Transmitter::new(BYTE_CYCLES, CAPACITY);
        board.converter =
            Converter::new(supplies::reading(&supplies), supplies.rail_reference != 0);
        Self {
            running: RunningRobot::with_flash(robot.section(), board),
        }
    }

    /// Runs the main loop from this cycle on, until it has nothing left to do.
    fn wake(&mut self, cycle: u64) {
        self.running.board.transmitter.at(cycle);
        self.running.settle();
    }

    /// Runs a tick at this cycle, and returns the widths of the frame that it begins.
    fn tick(&mut self, cycle: u64) -> [u16; 4] {
        self.wake(cycle);
        self.running.board.tick();
        _ = self.running.main.step(&mut self.running.board);
        let widths = self.running.board.submitted().0.map(|width| width.0);
        // The output of a frame is written right after it.
        self.wake(cycle + COMPUTE_CYCLES);
        widths
    }

    /// The cycle at which waiting lines are written and waiting bytes are read; `None` if nothing waits.
    fn next_wake(&self) -> Option<u64> {
        let board = &self.running.board;
        let is_waiting = board.unread() > 0 || self.running.has_output();
        is_waiting.then(|| {
            board
                .transmitter
                .free()
                .saturating_sub(MAX_QUEUED * BYTE_CYCLES)
        })
    }
}

/// The pulse widths computed by the core.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Commands {
    /// Widths in cycles, 0 for no pulse, of each frame from A1's first pulse on.
    pub widths: Vec<[u16; 4]>,
    /// The core's output, in which `late` and `rx_lost` are always 0.
    pub written: String,
}

/// Runs the core of a robot on a recording: `received` are the bytes that reached the UNO, `first_pulse` is the cycle
/// of A1's first pulse, `frame_count` the number of frames from that pulse on. The result is exact except for the lines
/// of [`undecided_lines`].
pub fn play(
    robot: Robot<'static>,
    received: &[SerialByte],
    first_pulse: u64,
    frame_count: usize,
) -> Commands {
    play_with_contacts(robot, received, &[], first_pulse, frame_count)
}

/// Runs the core of a robot like [`play`], but with contacts that close and open.
pub fn play_with_contacts(
    robot: Robot<'static>,
    received: &[SerialByte],
    contacts: &[ContactChange],
    first_pulse: u64,
    frame_count: usize,
) -> Commands {
    let mut contacts = contacts.iter().peekable();
    let silent_frames = frames_before_waking(robot);
    let mut run = CoreRun::new(robot);
    let mut received = received.iter().peekable();
    let mut widths = Vec::with_capacity(frame_count);
    for frame_index in 0..silent_frames + frame_count {
        let start = first_pulse + frame_index as u64 * FRAME;
        // A tick is one slot before the first pulse of the frame that it begins.
        let tick_cycle = start.saturating_sub(silent_frames as u64 * FRAME + SLOT);
        loop {
            let next_wake = run.next_wake().filter(|next_wake| *next_wake < tick_cycle);
            let is_due = |byte: &&SerialByte| {
                byte.cycle < tick_cycle && next_wake.is_none_or(|next_wake| byte.cycle < next_wake)
            };
            if let Some(byte) = received.next_if(is_due) {
                run.running.board.send(&[byte.byte]);
                run.wake(byte.cycle);
            } else if let Some(next_wake) = next_wake {
                run.wake(next_wake);
            } else {
                break;
            }
        }
        while let Some(change) = contacts.next_if(|change| change.ms * CYCLES_PER_MS < tick_cycle) {
            let bit = 1 << change.pin;
            let closed_pins = &mut run.running.board.closed;
            *closed_pins = if change.is_closed {
                *closed_pins | bit
            } else {
                *closed_pins & !bit
            };
        }
        let pulse_widths = run.tick(tick_cycle);
        if frame_index >= silent_frames {
            widths.push(pulse_widths);
        }
    }
    Commands {
        widths,
        written: run.running.board.transmitter.text,
    }
}

/// Indices of the lines that end so shortly before a tick that a few cycles decide if main has read them in time.
pub fn undecided_lines(received: &[SerialByte], first_pulse: u64) -> impl Iterator<Item = usize> {
    let tick_cycle = first_pulse.saturating_sub(SLOT) % FRAME;
    let line_ends = received.iter().filter(|byte| byte.byte == b'\n');
    let cycles_left = line_ends.map(move |end| (tick_cycle + FRAME - end.cycle % FRAME) % FRAME);
    cycles_left
        .enumerate()
        .filter_map(|(line, cycles_left)| (cycles_left < MAX_READING_CYCLES).then_some(line))
}

/// Number of frames before A1's first pulse, if no command comes.
fn frames_before_waking(robot: Robot<'static>) -> usize {
    let mut run = CoreRun::new(robot);
    (0..MAX_FRAMES_TO_WAKE)
        .take_while(|_| run.tick(0)[0] == 0)
        .count()
}
