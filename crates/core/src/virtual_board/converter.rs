//! The analogue-to-digital converter, and the time that its measurements take.

use crate::control::supply::Reading;
use crate::numbers::supplies::Supplies;

/// The analogue-to-digital converter; it measures one voltage in every second frame.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Converter {
    /// The actual supplies.
    actual: Reading,
    /// True if the servos' rail is measured too.
    has_rail: bool,
    last_reading: Reading,
    /// The number of the frame within a round of measurements.
    frames: u8,
    is_complete: bool,
}

impl Converter {
    /// A converter with these actual supplies, with or without the servos' rail.
    pub fn new(truth: Reading, has_rail: bool) -> Self {
        Self {
            actual: truth,
            has_rail,
            ..Self::default()
        }
    }

    /// Changes the actual supplies.
    pub const fn set(&mut self, truth: Reading) {
        self.actual = truth;
    }

    /// The actual supplies.
    pub const fn actual(&self) -> Reading {
        self.actual
    }

    /// True once every voltage has been measured since the program began.
    pub const fn is_complete(&self) -> bool {
        self.is_complete
    }

    pub(super) fn reset(self) -> Self {
        Self::new(self.actual, self.has_rail)
    }

    /// Advances by a frame. Returns the latest value of each voltage, or the default until every voltage has been
    /// measured once.
    pub(super) fn next(&mut self) -> Reading {
        match self.frames {
            1 => {
                self.last_reading.reference = self.actual.reference;
                self.is_complete |= !self.has_rail;
            }
            3 => {
                self.last_reading.rail = self.actual.rail;
                self.is_complete = true;
            }
            _ => {}
        }
        let period = if self.has_rail { 4 } else { 2 };
        self.frames = (self.frames + 1) % period;
        if self.is_complete {
            self.last_reading
        } else {
            Reading::default()
        }
    }
}

/// Returns the converter's reading if the supplies have the voltages `board` and `rail`, in mV. The rail is measured
/// through its divider.
pub fn compute_reading(supplies: &Supplies, board: u32, rail: u32) -> Reading {
    let board = u64::from(board);
    let reading_of = |mv: u64| ((1024 * mv + board / 2) / board.max(1)).min(1023) as u16;
    let reference = u64::from(supplies.reference);
    Reading {
        reference: reading_of(reference),
        rail: match supplies.rail_reference {
            0 => 0,
            rail_reference => reading_of(u64::from(rail) * reference / u64::from(rail_reference)),
        },
    }
}
