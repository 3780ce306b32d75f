//! The supply: measured every frame, and what the robot still does when it is low.
//!
//! Four servos that start at once pull a weak supply down; below 2.7 V the chip resets,
//! and well above that a servo loses its position and an EEPROM write its data. The chip
//! can measure its own supply without any external part: it compares the supply with a
//! reference of about 1.1 V on the chip. The servos' own rail can be measured if a
//! divider connects it to an analogue pin.
//!
//! The reference differs by up to a tenth from chip to chip. robot.toml has its measured
//! value, and the voltages below which the robot reacts.

use lizard_avr::mul_unsigned;

use crate::root::quotient;

/// Steps of the analogue converter.
const FULL_SCALE: u16 = 1024;

/// What the converter has read, 0..=1023; 0 stands for nothing yet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Reading {
    /// The reference, in parts of the supply.
    pub reference: u16,
    /// The divided rail of the servos, in parts of the supply.
    pub rail: u16,
}

lizard_avr::plain! {
    /// Voltages of one supply below which the robot reacts, mV, falling.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Thresholds {
        /// Below: gaits at no more than half their pace, and no EEPROM writes.
        pub slow: u16,
        /// Below: the robot freezes.
        pub stop: u16,
        /// Below: the pulses end.
        pub rest: u16,
    }
}

lizard_avr::plain! {
    /// The supplies, as in robot.toml.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Supplies {
        /// The chip's reference, mV.
        pub reference: u16,
        /// Of the chip's own supply.
        pub board: Thresholds,
        /// The reference times the ratio of the divider through which the servos' rail is
        /// measured, mV; 0 where it is not.
        pub rail_reference: u16,
        /// Of the rail itself.
        pub rail: Thresholds,
    }
}

/// What the supply allows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Everything.
    #[default]
    Good,
    /// Gaits at half their pace.
    Slow,
    /// Standing still.
    Stop,
    /// No pulses.
    Rest,
}

/// A voltage as a quotient, so that comparing it takes no division.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Voltage {
    /// mV times `counts`.
    product: u32,
    counts: u16,
}

/// The supply's level over time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Supply {
    reading: Reading,
    level: Level,
    /// Frames for which another level has been measured.
    frames: u8,
    /// Of these levels the one that is nearest to the present one.
    nearest: Level,
    /// Readings so far, up to as many as a level wants to be believed.
    readings: u8,
}

/// A level is left for a worse one that lasts for as many frames: a servo's start pulls
/// the supply down for a few milliseconds. A reading stands for four frames where the
/// rail is measured, too, so one that has met such a dip changes nothing.
const TO_WORSE: u8 = 6;

/// And for a better one that lasts for a second, by a voltage that much above the
/// threshold.
const TO_BETTER: u8 = 50;
const HYSTERESIS: u16 = 150;

impl Voltage {
    /// The chip's supply.
    pub fn of_board(reading: Reading, supplies: &Supplies) -> Self {
        Self {
            product: mul_unsigned(FULL_SCALE, supplies.reference),
            counts: reading.reference,
        }
    }

    /// The servos' rail.
    pub fn of_rail(reading: Reading, supplies: &Supplies) -> Self {
        Self {
            product: mul_unsigned(reading.rail, supplies.rail_reference),
            counts: reading.reference,
        }
    }

    /// Whether it is below `mv`. An unknown voltage is not.
    pub fn is_below(self, mv: u16) -> bool {
        self.product < mul_unsigned(mv, self.counts)
    }

    /// In hundredths of a volt, rounded down; 0 if unknown.
    pub fn hundredths(self) -> u16 {
        if self.counts == 0 {
            return 0;
        }
        let step = mul_unsigned(self.counts, 10) as u16;
        quotient(self.product, step).min(MOST_HUNDREDTHS)
    }
}

/// No reading of a supply that the chip survives gives more.
const MOST_HUNDREDTHS: u16 = (1 << 13) - 1;

impl Thresholds {
    /// The level of a voltage, `above` the thresholds.
    fn level(&self, voltage: Voltage, above: u16) -> Level {
        if !voltage.is_below(self.slow.wrapping_add(above)) {
            Level::Good
        } else if !voltage.is_below(self.stop.wrapping_add(above)) {
            Level::Slow
        } else if !voltage.is_below(self.rest.wrapping_add(above)) {
            Level::Stop
        } else {
            Level::Rest
        }
    }
}

impl Supplies {
    /// The worse level of both supplies.
    fn level(&self, reading: Reading, above: u16) -> Level {
        let board = self.board.level(Voltage::of_board(reading, self), above);
        if self.rail_reference == 0 {
            return board;
        }
        let rail = Voltage::of_rail(reading, self);
        board.max(self.rail.level(rail, above))
    }
}

impl Supply {
    /// Nothing measured yet.
    pub const fn new() -> Self {
        Self {
            reading: Reading {
                reference: 0,
                rail: 0,
            },
            level: Level::Good,
            frames: 0,
            nearest: Level::Good,
            readings: 0,
        }
    }

    /// What was measured last.
    pub const fn reading(&self) -> Reading {
        self.reading
    }

    /// What the supply allows.
    pub const fn level(&self) -> Level {
        self.level
    }

    /// Whether the last reading is of that level. If not, it may only be a dip.
    pub const fn is_steady(&self) -> bool {
        self.frames == 0
    }

    /// The same, once it has been measured for as long as another one would have had
    /// to be: until then it is only assumed.
    pub const fn measured(&self) -> Option<Level> {
        if self.readings < TO_WORSE {
            None
        } else {
            Some(self.level)
        }
    }

    /// The voltage of the supply that allows less.
    pub fn worst(&self, supplies: &Supplies) -> Voltage {
        let board = Voltage::of_board(self.reading, supplies);
        let rail = Voltage::of_rail(self.reading, supplies);
        let is_worse = supplies.rail.level(rail, 0) > supplies.board.level(board, 0);
        if supplies.rail_reference != 0 && is_worse {
            rail
        } else {
            board
        }
    }

    /// One frame on; true where the level has changed: to what held for all of the
    /// frames that a change takes, so that one reading decides nothing.
    pub fn measure(&mut self, reading: Reading, supplies: &Supplies) -> bool {
        self.reading = reading;
        if reading.reference > 0 && self.readings < TO_WORSE {
            self.readings += 1;
        }
        let worse = supplies.level(reading, 0);
        let (level, frames) = if worse > self.level {
            (worse, TO_WORSE)
        } else if self.level > Level::Good {
            (supplies.level(reading, HYSTERESIS), TO_BETTER)
        } else {
            (self.level, 0)
        };
        // A voltage between the threshold and the one above it changes nothing.
        if level == self.level || (frames == TO_BETTER && level > self.level) {
            self.frames = 0;
            return false;
        }
        let goes_on = self.frames > 0 && (self.nearest > self.level) == (level > self.level);
        self.nearest = match goes_on {
            false => level,
            true if level > self.level => level.min(self.nearest),
            true => level.max(self.nearest),
        };
        self.frames = if goes_on { self.frames + 1 } else { 1 };
        let changed = self.frames >= frames;
        if changed {
            self.frames = 0;
            self.level = self.nearest;
        }
        changed
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    const SUPPLIES: Supplies = Supplies {
        reference: 1100,
        board: Thresholds {
            slow: 4500,
            stop: 4300,
            rest: 4100,
        },
        rail_reference: 0,
        rail: Thresholds {
            slow: 0,
            stop: 0,
            rest: 0,
        },
    };

    const WITH_RAIL: Supplies = Supplies {
        rail_reference: 2200,
        rail: Thresholds {
            slow: 6400,
            stop: 6200,
            rest: 6000,
        },
        ..SUPPLIES
    };

    /// What the converter reads of a board at `volts`, its rail at `rail` volts.
    fn reading(volts: f64, rail: f64) -> Reading {
        Reading {
            reference: (1.1 / volts * 1024.0) as u16,
            rail: (rail / 2.0 / volts * 1024.0) as u16,
        }
    }

    /// Frames until the level changes, and the level.
    fn until_change(supply: &mut Supply, reading: Reading, supplies: &Supplies) -> (usize, Level) {
        for frame in 1..=200 {
            if supply.measure(reading, supplies) {
                return (frame, supply.level());
            }
        }
        (0, supply.level())
    }

    #[test]
    fn a_voltage_is_told_to_two_decimals_for_every_reading() {
        for reference in 1..=1023u16 {
            for mv in [1000, 1080, 1100, 1200] {
                let supplies = Supplies {
                    reference: mv,
                    ..SUPPLIES
                };
                let reading = Reading {
                    reference,
                    rail: 700,
                };
                let exact = 1024.0 * f64::from(mv) / f64::from(reference) / 10.0;
                let told = Voltage::of_board(reading, &supplies).hundredths();
                // More than 81.91 V is no supply.
                let expected = exact.floor().min(8191.0);
                assert_eq!(f64::from(told), expected, "{reference} {mv}");
                let rail = Voltage::of_rail(reading, &WITH_RAIL).hundredths();
                let exact = 700.0 * 2200.0 / f64::from(reference) / 10.0;
                assert_eq!(f64::from(rail), exact.floor().min(8191.0));
            }
        }
        assert_eq!(
            Voltage::of_board(Reading::default(), &SUPPLIES).hundredths(),
            0
        );
    }

    proptest! {
        #[test]
        fn a_voltage_is_below_what_it_is_below(reference in 100u16..1023, mv in 0u16..9000) {
            let voltage = Voltage::of_board(Reading { reference, rail: 0 }, &SUPPLIES);
            let exact = 1024.0 * 1100.0 / f64::from(reference);
            prop_assert_eq!(voltage.is_below(mv), exact < f64::from(mv));
        }
    }

    #[test]
    fn a_falling_supply_slows_then_stops_then_ends_the_pulses_each_after_six_frames() {
        let mut supply = Supply::default();
        assert_eq!(until_change(&mut supply, reading(5.0, 0.0), &SUPPLIES).0, 0);
        for (volts, level) in [
            (4.45, Level::Slow),
            (4.25, Level::Stop),
            (4.05, Level::Rest),
        ] {
            assert_eq!(
                until_change(&mut supply, reading(volts, 0.0), &SUPPLIES),
                (6, level)
            );
        }
        let mut supply = Supply::default();
        let change = until_change(&mut supply, reading(3.9, 0.0), &SUPPLIES);
        assert_eq!(change, (6, Level::Rest), "all at once, if it falls at once");
    }

    #[test]
    fn one_reading_decides_nothing_what_held_for_all_six_frames_counts() {
        for (others, one, level) in [
            (4.45, 3.5, Level::Slow),
            (4.25, 3.5, Level::Stop),
            (3.5, 4.45, Level::Slow),
        ] {
            for odd in 0..6 {
                let mut supply = Supply::default();
                for frame in 0..6 {
                    let volts = if frame == odd { one } else { others };
                    supply.measure(reading(volts, 0.0), &SUPPLIES);
                }
                assert_eq!(supply.level(), level, "{one} V in frame {odd}");
            }
        }
    }

    #[test]
    fn one_reading_does_not_recover_a_supply_either() {
        for odd in 0..50 {
            let mut supply = Supply::default();
            until_change(&mut supply, reading(4.2, 0.0), &SUPPLIES);
            for frame in 0..50 {
                let volts = if frame == odd { 4.5 } else { 5.0 };
                supply.measure(reading(volts, 0.0), &SUPPLIES);
            }
            assert_eq!(supply.level(), Level::Slow, "4.5 V in frame {odd}");
        }
    }

    #[test]
    fn a_short_dip_changes_nothing() {
        let mut supply = Supply::default();
        for _ in 0..100 {
            for volts in [4.0, 4.0, 4.0, 4.0, 4.0, 5.0] {
                assert!(!supply.measure(reading(volts, 0.0), &SUPPLIES));
            }
        }
        assert_eq!(supply.level(), Level::Good);
    }

    #[test]
    fn a_supply_is_good_again_a_second_after_it_has_risen_well_above_the_threshold() {
        let mut supply = Supply::default();
        until_change(&mut supply, reading(4.2, 0.0), &SUPPLIES);
        assert_eq!(supply.level(), Level::Stop);
        // Between the threshold and .15 V more it stays as it is.
        assert_eq!(
            until_change(&mut supply, reading(4.40, 0.0), &SUPPLIES).0,
            0
        );
        let slow = until_change(&mut supply, reading(4.5, 0.0), &SUPPLIES);
        assert_eq!(slow, (50, Level::Slow));
        assert_eq!(until_change(&mut supply, reading(4.6, 0.0), &SUPPLIES).0, 0);
        let good = until_change(&mut supply, reading(4.7, 0.0), &SUPPLIES);
        assert_eq!(good, (50, Level::Good));
    }

    #[test]
    fn a_supply_that_wavers_around_a_threshold_changes_once() {
        let mut supply = Supply::default();
        let mut levels = Vec::new();
        for frame in 0..2000 {
            let volts = if frame % 20 < 10 { 4.47 } else { 4.60 };
            if supply.measure(reading(volts, 0.0), &SUPPLIES) {
                levels.push(supply.level());
            }
        }
        assert_eq!(levels, [Level::Slow]);
    }

    #[test]
    fn the_worse_of_two_supplies_counts_and_is_the_one_that_is_told() {
        let supplies = WITH_RAIL;
        for (board, rail, level, worst) in [
            (5.0, 6.6, Level::Good, 5.0),
            (5.0, 6.3, Level::Slow, 6.3),
            (4.25, 6.3, Level::Stop, 4.25),
            (4.45, 5.0, Level::Rest, 5.0),
        ] {
            let mut supply = Supply::default();
            until_change(&mut supply, reading(board, rail), &supplies);
            assert_eq!(supply.level(), level);
            let told = f64::from(supply.worst(&supplies).hundredths()) / 100.0;
            assert!((told - worst).abs() < 0.05, "{told} {worst}");
        }
    }

    #[test]
    fn what_has_not_been_measured_yet_is_not_low() {
        let supplies = WITH_RAIL;
        let mut supply = Supply::default();
        assert_eq!(
            until_change(&mut supply, Reading::default(), &supplies).0,
            0
        );
    }
}
