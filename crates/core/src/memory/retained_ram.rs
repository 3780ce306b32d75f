//! The state that survives a reset of the processor: a few bytes of RAM that the start-up
//! code does not clear.
//!
//! RAM keeps its contents as long as there is power. The boot loader of the UNO clears the register with the
//! cause of the reset, and does not pass its value on. So a mark and checksums in these bytes tell the next run
//! whether power was lost, whether the program hung, and what the state of the servos was. Random bytes pass for those
//! of a powered chip with a probability of 1 in 32 768, and then contain a seemingly valid stance with one of 1 in 256.
//!
//! A reset may occur between any two stores without a loss: there are two copies of the stance, which are written
//! alternately. One byte, which is stored last, tells which of them is complete.
//!
//! | cell | content |
//! |---|---|
//! | 0 | a mark: power was not lost |
//! | 1 | the state of the program: it runs, or it hung |
//! | 2 | resets since power-on |
//! | 3 | number of the valid copy, in the lowest bit |
//! | 4 | the rate of the serial line, in the lowest two bits; if it is wrong, the console's autobaud corrects it |
//! | 5 | first copy: frames awake and a flag for rest, consecutive brown-outs, pose (8 bytes), pulses (8 bytes), checksum |
//! | 24 | second copy, with the fields of the first one |

use crate::memory::restart::{Cause, Restart, Stance};
use crate::numbers::rate::BaudRate;

/// The number of cells.
pub const CELL_COUNT: usize = FIRST_COPY_CELL + 2 * CELLS_PER_COPY;

/// Bytes that survive a reset. At power-on each may hold any value.
pub trait Cells {
    /// Reads the byte in a cell; `index` is below [`CELL_COUNT`].
    fn get(&self, index: usize) -> u8;

    /// Stores a byte, in one instruction and in the order of the calls.
    fn set(&self, index: usize, byte: u8);
}

const MARK_CELL: usize = 0;
const STATE_CELL: usize = 1;
const RESET_COUNT_CELL: usize = 2;
const VALID_COPY_CELL: usize = 3;
const RATE_CELL: usize = 4;
const FIRST_COPY_CELL: usize = 5;

/// The number of cells of a copy.
const CELLS_PER_COPY: usize = 19;

/// The value of [`MARK_CELL`] as long as there is power.
const POWERED_MARK: u8 = 0x96;

/// The value of [`STATE_CELL`] while the program runs.
const RUNNING: u8 = 0x5c;

/// The value of [`STATE_CELL`] after the program hung.
const HUNG: u8 = 0xa3;

/// The flag in a copy's first byte that is set while there are no pulses; the other bits count the frames since pulses
/// began.
const RESTING_FLAG: u8 = 0x80;

/// The first byte of a copy that holds no stance.
const EMPTY_STATE: u8 = 0x7f;

/// Returns the cause of the reset and the state from before it, and marks the program as
/// running. `reported_cause` is the cause that the chip reports, or `None` if a boot loader has
/// cleared it. Call it once, before the watchdog starts.
#[inline(never)]
pub fn begin<C: Cells>(cells: &C, reported_cause: Option<Cause>) -> Restart {
    let (state, reset_count) = (cells.get(STATE_CELL), cells.get(RESET_COUNT_CELL));
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
        brown_outs: 0,
        rate: BaudRate::Fastest,
        stance_before: None,
    };
    if has_survived && cause != Cause::Power {
        restart.reset_count = reset_count.saturating_add(1);
        if cause != Cause::External {
            restart.rate = BaudRate::from_number(cells.get(RATE_CELL));
        }
        read_stance(cells, &mut restart);
    } else {
        // By chance RAM may hold a copy that looks valid, which the next run must not find.
        cells.set(FIRST_COPY_CELL, EMPTY_STATE);
        cells.set(FIRST_COPY_CELL + CELLS_PER_COPY, EMPTY_STATE);
    }
    store_rate(cells, restart.rate);
    cells.set(RESET_COUNT_CELL, restart.reset_count);
    cells.set(STATE_CELL, RUNNING);
    cells.set(MARK_CELL, POWERED_MARK);
    restart
}

/// Stores the servos' state, and the number of consecutive resets that a weak supply may have caused.
/// The older copy stays valid until the new one is complete.
#[inline(never)]
pub fn store_stance<C: Cells>(cells: &C, stance: &Stance, brown_outs: u8) {
    let copy_number = !cells.get(VALID_COPY_CELL) & 1;
    let mut copy = CopyCursor::new(cells, copy_number);
    copy.write_byte(stance.frames_awake | if stance.is_resting { RESTING_FLAG } else { 0 });
    copy.write_byte(brown_outs);
    for sweep in &stance.pose.0 {
        copy.write_word(sweep.0 as u16);
    }
    for width in &stance.sent_pulses.0 {
        copy.write_word(width.0);
    }
    copy.write_byte(!copy.sum);
    cells.set(VALID_COPY_CELL, copy_number);
}

/// Stores the rate of the serial line.
pub fn store_rate<C: Cells>(cells: &C, rate: BaudRate) {
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
    for width in &mut stance.sent_pulses.0 {
        width.0 = copy.read_word();
    }
    let checksum = !copy.sum;
    if copy.read_byte() == checksum && state != EMPTY_STATE {
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
