//! The state that survives a reset of the processor: a few bytes of RAM that the start-up
//! code does not clear.
//!
//! RAM keeps its contents as long as there is power. The boot loader of the UNO clears the register with the
//! cause of the reset, and does not pass its value on. So these bytes tell the next run, by a mark and
//! checksums, if power was lost, if the program hung, and the state of the servos. Random bytes pass for a mark
//! once in 32 768 times, and then for a stance once in 256.
//!
//! A reset may come between any two stores, and nothing is lost. There are two copies of
//! the stance, which are written alternately. One byte says which of them is complete,
//! and it is stored last.
//!
//! | cell | what |
//! |---|---|
//! | 0 | a mark: power was not lost |
//! | 1 | the program runs, or hung |
//! | 2 | restarts since power came on |
//! | 3 | number of the valid copy, in the lowest bit |
//! | 4 | the rate of the serial line, in the lowest two bits; if it is wrong, the console finds the right one |
//! | 5 | first copy: state, brown-outs in a row, pose (8), pulses (8), check |
//! | 24 | second copy, with the fields of the first one |

use crate::memory::restart::{Cause, Restart, Stance};
use crate::numbers::rate::Rate;

/// The number of cells.
pub const CELLS: usize = FIRST_COPY_CELL + 2 * COPY_CELLS;

/// Bytes that survive a reset. At power-on each may hold anything.
pub trait Cells {
    /// The byte in a cell below [`CELLS`].
    fn get(&self, index: usize) -> u8;

    /// Stores a byte, in one instruction and in the order of the calls.
    fn set(&self, index: usize, byte: u8);
}

const MARK_CELL: usize = 0;
const STATE_CELL: usize = 1;
const COUNT_CELL: usize = 2;
const VALID_COPY_CELL: usize = 3;
const RATE_CELL: usize = 4;
const FIRST_COPY_CELL: usize = 5;

/// Number of cells in a copy.
const COPY_CELLS: usize = 19;

/// The value of the mark's cell as long as there is power.
const POWERED_MARK: u8 = 0x96;

/// The values of [`STATE_CELL`] for a program that runs, and for one that hung.
const RUNNING: u8 = 0x5c;
const HUNG: u8 = 0xa3;

/// The flag in a copy's first byte for no pulses; the other bits are the frames since pulses began.
const RESTING_FLAG: u8 = 0x80;

/// The first byte of a copy that holds no stance.
const EMPTY_STATE: u8 = 0x7f;

/// Returns the cause of the reset and the state from before it, and marks the program as
/// running. `reported_cause` is the cause that the chip reports, or `None` if a boot loader has
/// cleared it. To be called once, before the watchdog starts.
#[inline(never)]
pub fn begin<C: Cells>(cells: &C, reported_cause: Option<Cause>) -> Restart {
    let (state, count) = (cells.get(STATE_CELL), cells.get(COUNT_CELL));
    let survived = cells.get(MARK_CELL) == POWERED_MARK && matches!(state, RUNNING | HUNG);
    let cause = match reported_cause {
        Some(cause) => cause,
        None if !survived => Cause::Power,
        None if state == HUNG => Cause::Watchdog,
        None => Cause::External,
    };
    let is_hidden = reported_cause.is_none();
    let mut restart = Restart {
        cause,
        count: 0,
        may_be_supply: cause == Cause::BrownOut || cause == Cause::External && is_hidden,
        brown_outs: 0,
        rate: Rate::Fastest,
        stance_before: None,
    };
    if survived && cause != Cause::Power {
        restart.count = count.saturating_add(1);
        if cause != Cause::External {
            restart.rate = Rate::from_number(cells.get(RATE_CELL));
        }
        read_stance(cells, &mut restart);
    } else {
        // By chance RAM may hold a copy that looks valid: the next reset must not find
        // it.
        cells.set(FIRST_COPY_CELL, EMPTY_STATE);
        cells.set(FIRST_COPY_CELL + COPY_CELLS, EMPTY_STATE);
    }
    store_rate(cells, restart.rate);
    cells.set(COUNT_CELL, restart.count);
    cells.set(STATE_CELL, RUNNING);
    cells.set(MARK_CELL, POWERED_MARK);
    restart
}

/// Stores the servos' state, and the consecutive resets that a weak supply may have caused.
/// The older copy stays valid until the new one is complete.
#[inline(never)]
pub fn store_stance<C: Cells>(cells: &C, stance: &Stance, brown_outs: u8) {
    let turn = !cells.get(VALID_COPY_CELL) & 1;
    let mut copy = CopyCursor::new(cells, turn);
    copy.write_byte(stance.frames_awake | if stance.is_resting { RESTING_FLAG } else { 0 });
    copy.write_byte(brown_outs);
    for sweep in &stance.pose.0 {
        copy.write_word(sweep.0 as u16);
    }
    for width in &stance.sent.0 {
        copy.write_word(width.0);
    }
    copy.write_byte(!copy.sum);
    cells.set(VALID_COPY_CELL, turn);
}

/// Stores the rate of the serial line.
pub fn store_rate<C: Cells>(cells: &C, rate: Rate) {
    cells.set(RATE_CELL, rate as u8);
}

/// Marks the program as hung; called by the watchdog's interrupt.
pub fn mark_hung<C: Cells>(cells: &C) {
    cells.set(STATE_CELL, HUNG);
}

/// Reads the valid copy, if there is one, into `restart`.
#[inline(never)]
fn read_stance<C: Cells>(cells: &C, restart: &mut Restart) {
    let mut copy = CopyCursor::new(cells, cells.get(VALID_COPY_CELL) & 1);
    let state = copy.read_byte();
    let brown_outs = copy.read_byte();
    let mut stance = Stance {
        is_resting: state & RESTING_FLAG != 0,
        frames_awake: state & !RESTING_FLAG,
        ..Stance::RESTING
    };
    for sweep in &mut stance.pose.0 {
        sweep.0 = copy.read_word() as i16;
    }
    for width in &mut stance.sent.0 {
        width.0 = copy.read_word();
    }
    let check = !copy.sum;
    if copy.read_byte() == check && state != EMPTY_STATE {
        restart.brown_outs = brown_outs;
        restart.stance_before = Some(stance);
    }
}

/// A copy that is being written or read, cell by cell.
struct CopyCursor<'a, C> {
    cells: &'a C,
    /// The next cell.
    cell: usize,
    /// The sum of all bytes written or read so far.
    sum: u8,
}

impl<'a, C: Cells> CopyCursor<'a, C> {
    const fn new(cells: &'a C, turn: u8) -> Self {
        let cell = if turn == 0 {
            FIRST_COPY_CELL
        } else {
            FIRST_COPY_CELL + COPY_CELLS
        };
        Self {
            cells,
            cell,
            sum: 0,
        }
    }

    fn write_byte(&mut self, byte: u8) {
        self.cells.set(self.cell, byte);
        self.add_to_sum(byte);
    }

    fn write_word(&mut self, word: u16) {
        let [low, high] = word.to_le_bytes();
        self.write_byte(low);
        self.write_byte(high);
    }

    fn read_byte(&mut self) -> u8 {
        let byte = self.cells.get(self.cell);
        self.add_to_sum(byte);
        byte
    }

    #[inline(never)]
    fn read_word(&mut self) -> u16 {
        let low = self.read_byte();
        u16::from_le_bytes([low, self.read_byte()])
    }

    fn add_to_sum(&mut self, byte: u8) {
        self.sum = self.sum.wrapping_add(byte);
        self.cell += 1;
    }
}

#[cfg(test)]
mod tests;
