//! The state that survives a reset of the processor, in a few bytes of RAM that the start-up code does not clear.
//!
//! RAM keeps its contents while there is power. The boot loader of the UNO clears the register with the cause of the
//! reset and does not pass its value on. Therefore these bytes contain a mark, the state of the program and checksums,
//! from which the next run determines whether power was lost and whether the program hung, and restores the servo
//! state. Random bytes seem to have survived a reset (a correct mark and a valid program state) with a probability of
//! 1 in 32 768, and then have a seemingly valid servo state with a probability of 1 in 256.
//!
//! Two copies of the servo state are written alternately, so a reset between any two stores does not lose it. One byte,
//! which is stored last, selects the complete copy.
//!
//! | cell | content |
//! |---|---|
//! | 0 | a mark: power was not lost |
//! | 1 | the state of the program: running or hung |
//! | 2 | resets since power-on |
//! | 3 | the number of the valid copy, in the lowest bit |
//! | 4 | the baud rate, in the lowest two bits; autobaud corrects a wrong rate |
//! | 5 | first copy: frames awake with a flag for rest, suspected brown-outs, pose (8 bytes), pulses (8 bytes), checksum |
//! | 24 | second copy, with the same fields |

use crate::memory::restart::{Cause, Restart, ServoState};
use crate::numbers::rate::BaudRate;

/// The number of cells.
pub const CELL_COUNT: usize = FIRST_COPY_CELL + 2 * CELLS_PER_COPY;

/// Bytes that survive a reset. At power-on each byte may have any value.
pub trait Cells {
    /// Reads the byte in a cell; `index` is below [`CELL_COUNT`].
    fn get(&self, index: usize) -> u8;

    /// Stores a byte with one instruction; the stores keep the order of the calls.
    fn set(&self, index: usize, byte: u8);
}

const MARK_CELL: usize = 0;
const PROGRAM_STATE_CELL: usize = 1;
const RESET_COUNT_CELL: usize = 2;
const VALID_COPY_CELL: usize = 3;
const RATE_CELL: usize = 4;
const FIRST_COPY_CELL: usize = 5;

/// The number of cells of a copy.
const CELLS_PER_COPY: usize = 19;

/// The value of [`MARK_CELL`] while there is power.
const POWERED_MARK: u8 = 0x96;

/// The value of [`PROGRAM_STATE_CELL`] while the program runs.
const RUNNING: u8 = 0x5c;

/// The value of [`PROGRAM_STATE_CELL`] after the program has hung.
const HUNG: u8 = 0xa3;

/// The flag in a copy's first byte that is set while the servos rest; the other bits are the frames awake.
const RESTING_FLAG: u8 = 0x80;

/// The first byte of a copy that holds no servo state.
const NO_SERVO_STATE: u8 = 0x7f;

/// Returns the information that survived the reset, and marks the program as running. `reported_cause` is the cause
/// that the chip reports, or `None` if a boot loader has cleared it. Call this function once, before the watchdog
/// starts.
#[inline(never)]
pub fn begin<C: Cells>(cells: &C, reported_cause: Option<Cause>) -> Restart {
    let (state, reset_count) = (cells.get(PROGRAM_STATE_CELL), cells.get(RESET_COUNT_CELL));
    let has_survived = cells.get(MARK_CELL) == POWERED_MARK && matches!(state, RUNNING | HUNG);
    let cause = match reported_cause {
        Some(cause) => cause,
        None if !has_survived => Cause::Power,
        None if state == HUNG => Cause::Watchdog,
        None => Cause::External,
    };
    let is_cause_hidden = reported_cause.is_none();
    let mut restart = Restart {
        cause,
        reset_count: 0,
        is_supply_suspected: cause == Cause::BrownOut
            || cause == Cause::External && is_cause_hidden,
        suspected_brown_outs: 0,
        rate: BaudRate::Fastest,
        servo_state_before: None,
    };
    if has_survived && cause != Cause::Power {
        restart.reset_count = reset_count.saturating_add(1);
        if cause != Cause::External {
            restart.rate = BaudRate::from_number(cells.get(RATE_CELL));
        }
        read_servo_state(cells, &mut restart);
    } else {
        // By chance RAM may contain a seemingly valid copy, which the next run must not find.
        cells.set(FIRST_COPY_CELL, NO_SERVO_STATE);
        cells.set(FIRST_COPY_CELL + CELLS_PER_COPY, NO_SERVO_STATE);
    }
    store_rate(cells, restart.rate);
    cells.set(RESET_COUNT_CELL, restart.reset_count);
    cells.set(PROGRAM_STATE_CELL, RUNNING);
    cells.set(MARK_CELL, POWERED_MARK);
    restart
}

/// Stores the servo state, and the number of consecutive resets that a weak supply may have caused. The previous copy
/// stays valid until the new copy is complete.
#[inline(never)]
pub fn store_servo_state<C: Cells>(cells: &C, servo_state: &ServoState, suspected_brown_outs: u8) {
    let copy_number = !cells.get(VALID_COPY_CELL) & 1;
    let mut copy = CopyCursor::new(cells, copy_number);
    copy.write_byte(
        servo_state.frames_awake
            | if servo_state.is_resting {
                RESTING_FLAG
            } else {
                0
            },
    );
    copy.write_byte(suspected_brown_outs);
    for sweep in &servo_state.pose.0 {
        copy.write_word(sweep.0 as u16);
    }
    for width in &servo_state.sent_pulses.0 {
        copy.write_word(width.0);
    }
    copy.write_byte(!copy.sum);
    cells.set(VALID_COPY_CELL, copy_number);
}

/// Stores the baud rate.
pub fn store_rate<C: Cells>(cells: &C, rate: BaudRate) {
    cells.set(RATE_CELL, rate as u8);
}

/// Marks the program as hung; called by the interrupt handler of the watchdog.
pub fn mark_hung<C: Cells>(cells: &C) {
    cells.set(PROGRAM_STATE_CELL, HUNG);
}

/// Reads the valid copy, if any, into `restart`.
#[inline(never)]
fn read_servo_state<C: Cells>(cells: &C, restart: &mut Restart) {
    let mut copy = CopyCursor::new(cells, cells.get(VALID_COPY_CELL) & 1);
    let first_byte = copy.read_byte();
    let suspected_brown_outs = copy.read_byte();
    let mut servo_state = ServoState {
        is_resting: first_byte & RESTING_FLAG != 0,
        frames_awake: first_byte & !RESTING_FLAG,
        ..ServoState::RESTING
    };
    for sweep in &mut servo_state.pose.0 {
        sweep.0 = copy.read_word() as i16;
    }
    for width in &mut servo_state.sent_pulses.0 {
        width.0 = copy.read_word();
    }
    let checksum = !copy.sum;
    if copy.read_byte() == checksum && first_byte != NO_SERVO_STATE {
        restart.suspected_brown_outs = suspected_brown_outs;
        restart.servo_state_before = Some(servo_state);
    }
}

/// The position in a copy that is being written or read cell by cell.
struct CopyCursor<'a, C> {
    cells: &'a C,
    /// The next cell.
    cell: usize,
    /// The sum of all bytes written or read so far.
    sum: u8,
}

impl<'a, C: Cells> CopyCursor<'a, C> {
    const fn new(cells: &'a C, copy_number: u8) -> Self {
        let cell = if copy_number == 0 {
            FIRST_COPY_CELL
        } else {
            FIRST_COPY_CELL + CELLS_PER_COPY
        };
        Self {
            cells,
            cell,
            sum: 0,
        }
    }

    fn write_byte(&mut self, byte: u8) {
        self.cells.set(self.cell, byte);
        self.advance(byte);
    }

    fn write_word(&mut self, word: u16) {
        let [low, high] = word.to_le_bytes();
        self.write_byte(low);
        self.write_byte(high);
    }

    fn read_byte(&mut self) -> u8 {
        let byte = self.cells.get(self.cell);
        self.advance(byte);
        byte
    }

    #[inline(never)]
    fn read_word(&mut self) -> u16 {
        let low = self.read_byte();
        u16::from_le_bytes([low, self.read_byte()])
    }

    fn advance(&mut self, byte: u8) {
        self.sum = self.sum.wrapping_add(byte);
        self.cell += 1;
    }
}

#[cfg(test)]
mod tests;
