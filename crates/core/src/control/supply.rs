//! The supply voltage, which is measured in every frame and converted to a level that limits the robot.
//!
//! Four servos that start at once pull a weak supply down. Below 2.7 V the chip resets; even well above 2.7 V, a servo
//! may lose its position, and a write to the EEPROM may store a wrong byte. The chip measures its own supply without an
//! external part, by comparing the supply with a reference of about 1.1 V on the chip. The servo rail can be
//! measured, too, if a voltage divider connects it to an analogue pin.
//!
//! The reference differs by up to a tenth from chip to chip. robot.toml has its measured value, and the voltages below
//! which the robot reacts.

use lizard_avr::mul_unsigned;

use crate::numbers::integer_math::saturating_div;
use crate::numbers::supplies::{Supplies, Thresholds};

/// The number of steps of the analogue-to-digital converter.
const FULL_SCALE: u16 = 1024;

/// Readings of the analogue-to-digital converter, each 0..=1023; 0 before the first measurement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Reading {
    /// The chip's reference voltage, in 1/1024 of the supply.
    pub reference: u16,
    /// The voltage of the servo rail after the voltage divider, in 1/1024 of the supply.
    pub rail: u16,
}

/// The level of a supply, which determines the allowed actions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Everything is allowed.
    #[default]
    Good,
    /// Gaits are limited to [`slow_pace`](crate::numbers::robot::Robot::slow_pace), and the EEPROM is not written.
    Slow,
    /// The robot may only stand still.
    Stop,
    /// The servos get no pulses.
    Rest,
}

/// A voltage as a quotient of two integers, so that a comparison requires no division.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Voltage {
    /// The voltage in mV, times `counts`.
    product: u32,
    /// The converter's reading of the reference; 0 if the voltage is unknown.
    counts: u16,
}

/// The supply's level over time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Supply {
    reading: Reading,
    level: Level,
    /// The number of consecutive frames whose readings are all at a worse level, or all at a better level, than the
    /// current one.
    frames_at_other_level: u8,
    /// The level nearest to the current one in these frames.
    nearest_other_level: Level,
    /// The number of valid readings so far, at most [`FRAMES_TO_WORSEN`].
    reading_count: u8,
}

/// Frames for which a worse level must last before it counts: a servo's start pulls the supply down for a few
/// milliseconds. If the rail is measured, too, up to four frames have the same reading, so a single dip changes
/// nothing.
const FRAMES_TO_WORSEN: u8 = 6;

/// Frames for which a better level must last before it counts: 1 s.
const FRAMES_TO_IMPROVE: u8 = 50;

/// The hysteresis: the voltage by which a better level's threshold must be exceeded before that level counts, mV.
pub const HYSTERESIS_MV: u16 = 150;

impl Voltage {
    /// Returns the voltage of the chip's supply.
    pub fn for_board(reading: Reading, supplies: &Supplies) -> Self {
        Self {
            product: mul_unsigned(FULL_SCALE, supplies.reference_mv),
            counts: reading.reference,
        }
    }

    /// Returns the voltage of the servo rail.
    pub fn for_rail(reading: Reading, supplies: &Supplies) -> Self {
        Self {
            product: mul_unsigned(reading.rail, supplies.rail_reference_mv),
            counts: reading.reference,
        }
    }

    /// True if the voltage is below `mv`; false if it is unknown.
    pub fn is_below(self, mv: u16) -> bool {
        self.product < mul_unsigned(mv, self.counts)
    }

    /// The voltage in hundredths of a volt, rounded down; 0 if it is unknown.
    pub fn centivolts(self) -> u16 {
        if self.counts == 0 {
            return 0;
        }
        let divisor = mul_unsigned(self.counts, 10) as u16;
        saturating_div(self.product, divisor).min(MAX_CENTIVOLTS)
    }
}

/// The largest voltage, hundredths of a volt: more than any supply that the chip survives.
const MAX_CENTIVOLTS: u16 = (1 << 13) - 1;

impl Thresholds {
    /// Returns the level of a voltage, with all thresholds raised by `raise_mv`.
    fn level(&self, voltage: Voltage, raise_mv: u16) -> Level {
        if !voltage.is_below(self.slow_mv.wrapping_add(raise_mv)) {
            Level::Good
        } else if !voltage.is_below(self.stop_mv.wrapping_add(raise_mv)) {
            Level::Slow
        } else if !voltage.is_below(self.rest_mv.wrapping_add(raise_mv)) {
            Level::Stop
        } else {
            Level::Rest
        }
    }
}

impl Supplies {
    /// Returns the worse of the levels of the chip's supply and of the rail, with all thresholds raised by `raise_mv`.
    fn level(&self, reading: Reading, raise_mv: u16) -> Level {
        let board_level = self
            .board
            .level(Voltage::for_board(reading, self), raise_mv);
        if self.rail_reference_mv == 0 {
            return board_level;
        }
        let rail_voltage = Voltage::for_rail(reading, self);
        board_level.max(self.rail.level(rail_voltage, raise_mv))
    }
}

impl Supply {
    /// Creates a supply that has not been measured yet.
    pub const fn new() -> Self {
        Self {
            reading: Reading {
                reference: 0,
                rail: 0,
            },
            level: Level::Good,
            frames_at_other_level: 0,
            nearest_other_level: Level::Good,
            reading_count: 0,
        }
    }

    /// The last reading.
    pub const fn reading(&self) -> Reading {
        self.reading
    }

    /// The current level.
    pub const fn level(&self) -> Level {
        self.level
    }

    /// True if the last reading is at the current level; false in a dip, and before the level changes.
    pub const fn is_steady(&self) -> bool {
        self.frames_at_other_level == 0
    }

    /// The current level; `None` until enough frames have measured the supply.
    pub const fn measured_level(&self) -> Option<Level> {
        if self.reading_count < FRAMES_TO_WORSEN {
            None
        } else {
            Some(self.level)
        }
    }

    /// The voltage of the chip's supply or of the servo rail, whichever restricts the robot more.
    pub fn limiting_voltage(&self, supplies: &Supplies) -> Voltage {
        let board_voltage = Voltage::for_board(self.reading, supplies);
        let rail_voltage = Voltage::for_rail(self.reading, supplies);
        let is_worse =
            supplies.rail.level(rail_voltage, 0) > supplies.board.level(board_voltage, 0);
        if supplies.rail_reference_mv != 0 && is_worse {
            rail_voltage
        } else {
            board_voltage
        }
    }

    /// Adds a frame's reading. Returns true if the level has changed, which takes several frames.
    pub fn add_reading(&mut self, reading: Reading, supplies: &Supplies) -> bool {
        self.reading = reading;
        if reading.reference > 0 && self.reading_count < FRAMES_TO_WORSEN {
            self.reading_count += 1;
        }
        let reading_level = supplies.level(reading, 0);
        let (new_level, frames_needed) = if reading_level > self.level {
            (reading_level, FRAMES_TO_WORSEN)
        } else if self.level > Level::Good {
            (supplies.level(reading, HYSTERESIS_MV), FRAMES_TO_IMPROVE)
        } else {
            (self.level, 0)
        };
        // A voltage between a threshold and the same threshold raised by the hysteresis changes nothing.
        if new_level == self.level || (frames_needed == FRAMES_TO_IMPROVE && new_level > self.level)
        {
            self.frames_at_other_level = 0;
            return false;
        }
        let is_same_direction = self.frames_at_other_level > 0
            && (self.nearest_other_level > self.level) == (new_level > self.level);
        self.nearest_other_level = match is_same_direction {
            false => new_level,
            true if new_level > self.level => new_level.min(self.nearest_other_level),
            true => new_level.max(self.nearest_other_level),
        };
        self.frames_at_other_level = if is_same_direction {
            self.frames_at_other_level + 1
        } else {
            1
        };
        let has_changed = self.frames_at_other_level >= frames_needed;
        if has_changed {
            self.frames_at_other_level = 0;
            self.level = self.nearest_other_level;
        }
        has_changed
    }
}

#[cfg(test)]
mod tests;
