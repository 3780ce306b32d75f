//! The analogue-to-digital converter (ADC), whose measurements take several frames.

use crate::control::supply::Reading;
use crate::numbers::supplies::Supplies;

/// The analogue-to-digital converter, which measures one voltage in every second frame.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Adc {
    /// The reading of the actual supplies, as an instantaneous measurement would return it.
    true_reading: Reading,
    /// True if the servo rail is also measured.
    measures_rail: bool,
    /// The latest measured values.
    last_reading: Reading,
    /// The index of the frame within a round of measurements.
    frame_in_round: u8,
    /// True once every voltage has been measured.
    is_complete: bool,
}

impl Adc {
    /// Creates an ADC whose supplies have this reading; `measures_rail` is true if the servo rail is also measured.
    pub fn new(true_reading: Reading, measures_rail: bool) -> Self {
        Self {
            true_reading,
            measures_rail,
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

    pub(super) fn after_reset(self) -> Self {
        Self::new(self.true_reading, self.measures_rail)
    }

    /// Advances the ADC by a frame. Returns the latest value of each voltage, or the default reading until every
    /// voltage has been measured.
    pub(super) fn advance_frame(&mut self) -> Reading {
        match self.frame_in_round {
            1 => {
                self.last_reading.reference = self.true_reading.reference;
                self.is_complete |= !self.measures_rail;
            }
            3 => {
                self.last_reading.rail = self.true_reading.rail;
                self.is_complete = true;
            }
            _ => {}
        }
        let round_frames = if self.measures_rail { 4 } else { 2 };
        self.frame_in_round = (self.frame_in_round + 1) % round_frames;
        if self.is_complete {
            self.last_reading
        } else {
            Reading::default()
        }
    }
}

/// Computes the ADC's reading while the chip's supply is `board_mv` and the servo rail is `rail_mv`. The rail is
/// measured through a voltage divider with the ratio `rail_reference_mv / reference_mv`.
pub fn compute_reading(supplies: &Supplies, board_mv: u32, rail_mv: u32) -> Reading {
    let board_mv = u64::from(board_mv);
    let convert = |mv: u64| ((1024 * mv + board_mv / 2) / board_mv.max(1)).min(1023) as u16;
    let reference_mv = u64::from(supplies.reference_mv);
    Reading {
        reference: convert(reference_mv),
        rail: match u64::from(supplies.rail_reference_mv) {
            0 => 0,
            rail_reference_mv => convert(u64::from(rail_mv) * reference_mv / rail_reference_mv),
        },
    }
}
