//! The analogue-to-digital converter, whose measurements take several frames.

use crate::control::supply::Reading;
use crate::numbers::supplies::Supplies;

/// The analogue-to-digital converter, which measures one voltage in every second frame.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Converter {
    /// The reading of the actual supplies.
    true_reading: Reading,
    /// True if the servo rail is measured, too.
    has_rail: bool,
    /// The latest measured values.
    last_reading: Reading,
    /// The index of the frame within a round of measurements.
    frame_in_round: u8,
    /// True once every voltage has been measured.
    is_complete: bool,
}

impl Converter {
    /// Creates a converter whose supplies have this reading; `has_rail` is true if the servo rail is measured, too.
    pub fn new(true_reading: Reading, has_rail: bool) -> Self {
        Self {
            true_reading,
            has_rail,
            ..Self::default()
        }
    }

    /// Changes the reading of the actual supplies.
    pub const fn set_true_reading(&mut self, true_reading: Reading) {
        self.true_reading = true_reading;
    }

    /// The reading of the actual supplies.
    pub const fn true_reading(&self) -> Reading {
        self.true_reading
    }

    /// True once every voltage has been measured since the program's start.
    pub const fn is_complete(&self) -> bool {
        self.is_complete
    }

    pub(super) fn reset(self) -> Self {
        Self::new(self.true_reading, self.has_rail)
    }

    /// Advances the converter by a frame. Returns the latest value of each voltage, or the default reading until every
    /// voltage has been measured.
    pub(super) fn advance_frame(&mut self) -> Reading {
        match self.frame_in_round {
            1 => {
                self.last_reading.reference = self.true_reading.reference;
                self.is_complete |= !self.has_rail;
            }
            3 => {
                self.last_reading.rail = self.true_reading.rail;
                self.is_complete = true;
            }
            _ => {}
        }
        let round_frames = if self.has_rail { 4 } else { 2 };
        self.frame_in_round = (self.frame_in_round + 1) % round_frames;
        if self.is_complete {
            self.last_reading
        } else {
            Reading::default()
        }
    }
}

/// Computes the converter's reading if the chip is supplied with `board_mv` and the servo rail with `rail_mv`. The
/// rail is measured through its voltage divider.
pub fn compute_reading(supplies: &Supplies, board_mv: u32, rail_mv: u32) -> Reading {
    let board = u64::from(board_mv);
    let convert = |mv: u64| ((1024 * mv + board / 2) / board.max(1)).min(1023) as u16;
    let reference = u64::from(supplies.reference_mv);
    Reading {
        reference: convert(reference),
        rail: match supplies.rail_reference_mv {
            0 => 0,
            rail_reference => convert(u64::from(rail_mv) * reference / u64::from(rail_reference)),
        },
    }
}
