//! Sections that are whole and say what cannot be: a number at a time, each beside the
//! nearest one that can be.

use std::vec::Vec;

use super::*;
use crate::adjustment::Reach;
use crate::sample::Sample;
use crate::section::{Header, seal};

const WAVE: u16 = size_of::<Wave>() as u16;

/// A section of the odd robot, of which numbers are changed.
struct Changed(Vec<u8>);

impl Changed {
    fn new() -> Self {
        let mut content = Sample::odd().content.clone();
        // Room for a name that is too long, and for a curve at the end.
        content.names.resize(LONGEST_NAME + 10, b'a');
        Self(content.section())
    }

    /// With a copy of a curve behind everything else.
    fn with_last(mut self, curve: u16) -> Self {
        let from = usize::from(self.get(curve));
        self.0.extend_from_within(from..from + size_of::<Table>());
        let length = self.length();
        self.put(offset_of!(Header, length) as u16, length)
    }

    fn length(&self) -> u16 {
        self.0.len() as u16
    }

    fn get(&self, at: u16) -> u16 {
        let at = usize::from(at);
        u16::from_le_bytes([self.0[at], self.0[at + 1]])
    }

    fn put(mut self, at: u16, word: u16) -> Self {
        self.0[usize::from(at)..][..2].copy_from_slice(&word.to_le_bytes());
        self
    }

    fn put_byte(mut self, at: u16, byte: u8) -> Self {
        self.0[usize::from(at)] = byte;
        self
    }

    /// True if it is a robot's.
    fn opens(&self) -> bool {
        let mut section = self.0.clone();
        seal(&mut section);
        match Robot::open(Region::new(&section)) {
            Ok(_) => true,
            Err(damage) => {
                assert_eq!(damage, Damage::Impossible);
                false
            }
        }
    }
}

/// Whether the odd robot's section is one with this word in that place.
fn opens_with(at: u16, word: u16) -> bool {
    Changed::new().put(at, word).opens()
}

/// The place of a part, and that of its count.
fn part(part: Part) -> [u16; 2] {
    let at = place!(parts) + part as u16 * size_of::<Place>() as u16;
    [at, at + 2]
}

#[test]
fn no_part_and_no_curve_ends_behind_the_section() {
    let right = Changed::new();
    assert!(right.opens());
    for of in [Part::Gaits, Part::Waves, Part::Names, Part::Rows] {
        let [at, count] = part(of);
        assert!(!opens_with(at, right.length() + 1), "{of:?}");
        assert!(!opens_with(at, 0xffff), "{of:?}");
        assert!(!opens_with(count, 0xffff), "{of:?}");
    }
    let [names, count] = part(Part::Names);
    let last = right.length() - right.get(count);
    assert!(opens_with(names, last));
    assert!(!opens_with(names, last + 1));
    // So many waves that their bytes are no number of sixteen bits.
    assert!(!opens_with(
        part(Part::Waves)[1],
        (0x1_0000 / u32::from(WAVE)) as u16
    ));
    for curve in 0..2 * CURVES as u16 {
        let at = place!(curves) + 2 * curve;
        if right.get(at) == 0 {
            continue;
        }
        let longer = || Changed::new().with_last(at);
        let last = right.length();
        assert!(longer().put(at, last).opens(), "{curve}");
        assert!(!longer().put(at, last + 1).opens(), "{curve}");
    }
}

#[test]
fn maps_have_no_more_rows_than_there_are() {
    let [_, rows] = part(Part::Rows);
    let first = place!(maps) + offset_of!(MapHead, rows) as u16;
    for map in 0..4 {
        let rows_of = first + map * size_of::<MapHead>() as u16;
        let mut changed = Changed::new();
        assert_eq!(changed.get(rows), 0, "it has no maps");
        assert!(!Changed::new().put_byte(rows_of, 1).opens(), "{map}");
        changed = changed.put_byte(rows_of, 3);
        // Nothing else is behind the rows' beginning.
        let length = changed.length();
        changed = changed.put(part(Part::Rows)[0], length - 6);
        assert!(changed.put(rows, 3).opens(), "{map}");
    }
}

#[test]
fn a_pin_is_free_used_once_and_not_the_rails() {
    // D0 and D1 are the serial line, D13 is the LED.
    let is_free = |pin: u8| (2..=12).contains(&pin) || (14..=19).contains(&pin);
    let others = |servo: u16| {
        let pins = Sample::odd().content.pins;
        (0..4)
            .filter(move |other| *other != usize::from(servo))
            .map(move |other| pins[other])
    };
    for rail in [0, 14, 19] {
        for servo in 0..4 {
            for pin in 0..=u8::MAX {
                let changed = Changed::new().put(place!(rail), rail);
                let opens = changed.put_byte(place!(pins) + servo, pin).opens();
                let used = others(servo).chain([rail as u8]).any(|other| other == pin);
                let all_free = others(servo).all(|other| u16::from(other) != rail);
                let wanted = is_free(pin) && !used && all_free;
                assert_eq!(opens, wanted, "A{} on {pin}, the rail on {rail}", servo + 1);
            }
        }
    }
    let pins = Sample::odd().content.pins;
    for rail in 0..=u8::MAX {
        let measures = (14..=19).contains(&rail) && !pins.contains(&rail);
        assert_eq!(
            opens_with(place!(rail), rail.into()),
            rail == 0 || measures,
            "{rail}"
        );
    }
}

#[test]
fn gaits_have_names_and_waves_that_there_are_and_the_first_of_at_least_one_stands() {
    let right = Changed::new();
    let [gaits, count] = part(Part::Gaits).map(|at| right.get(at));
    let names = right.get(part(Part::Names)[1]);
    let waves = right.get(part(Part::Waves)[1]);
    let at_count = part(Part::Gaits)[1];
    assert!(opens_with(at_count, 1) && !opens_with(at_count, 0));
    for gait in 0..count {
        let field = |offset: usize| gaits + gait * size_of::<Gait>() as u16 + offset as u16;
        let start = field(offset_of!(Gait, name_start));
        let length = field(offset_of!(Gait, name_length));
        assert!(!opens_with(length, 0), "{gait}");
        let named = |from: u16, letters: u16| Changed::new().put(start, from).put(length, letters);
        assert!(
            named(names - 1, 1).opens() && !named(names, 1).opens(),
            "{gait}"
        );
        assert!(!named(names + 1, 1).opens(), "{gait}");
        let longest = LONGEST_NAME as u16;
        assert!(
            named(0, longest).opens() && !named(0, longest + 1).opens(),
            "{gait}"
        );
        for channel in 0..4 {
            let at = field(offset_of!(Gait, channels) + channel * size_of::<Channel>());
            assert!(
                opens_with(at, waves - 1) && !opens_with(at, waves),
                "{gait}"
            );
            let gain = at + offset_of!(Channel, gain) as u16;
            assert_eq!(opens_with(gain, 1), gait != 0, "{gait}");
        }
    }
}

#[test]
fn a_servo_bears_the_pulses_of_its_travel_and_the_gaits_do_not_leave_it() {
    for servo in 0..4 {
        let opens = |change: &dyn Fn(&mut Calibration)| {
            let mut content = Sample::odd().content.clone();
            let calibration = &mut content.calibration[servo];
            calibration.gain = 11_395;
            (calibration.min, calibration.max) = (Sweep(-9_000), Sweep(9_000));
            change(calibration);
            Changed(content.section()).opens()
        };
        assert!(opens(&|_| {}));
        for least in [7_999, 8_000] {
            // The shortest pulse is that of the clockwise end.
            let at_end = |calibration: &mut Calibration| {
                let short = calibration.neutral.0 - calibration.pulse(calibration.min);
                calibration.neutral.0 = least + short;
            };
            assert!(opens(&at_end), "{servo} {least}");
        }
        let too_short = |calibration: &mut Calibration| {
            let short = calibration.neutral.0 - calibration.pulse(calibration.min);
            calibration.neutral.0 = 7_998 + short;
        };
        assert!(!opens(&too_short), "{servo}");
        for (most, bears) in [(40_001, true), (40_002, false)] {
            let at_end = |calibration: &mut Calibration| {
                let long = calibration.pulse(calibration.max) - calibration.neutral.0;
                calibration.neutral.0 = most - long;
            };
            assert_eq!(opens(&at_end), bears, "{servo} {most}");
        }
        // The neutral angle is within the travel, even if no gait needs it.
        for (travel, has_neutral) in [([0, 900], true), ([1, 900], false), ([-900, -1], false)] {
            let mut content = Sample::odd().content.clone();
            let [min, max] = travel.map(Sweep);
            let calibration = &mut content.calibration[servo];
            (calibration.min, calibration.max) = (min, max);
            content.reach[servo] = Reach { min, max };
            assert_eq!(
                Changed(content.section()).opens(),
                has_neutral,
                "{travel:?}"
            );
        }
        let reach = Sample::odd().content.reach[servo];
        for (beyond, within) in [(0, true), (1, false)] {
            assert_eq!(opens(&|servo| servo.min.0 = reach.min.0 + beyond), within);
            assert_eq!(opens(&|servo| servo.max.0 = reach.max.0 - beyond), within);
        }
    }
}

#[test]
fn loops_have_numbers_with_which_the_guard_can_compute() {
    for end in 0..2u16 {
        let bars = place!(ends) + end * size_of::<Bars>() as u16;
        for range in Bars::RANGES {
            let at = bars + range.at;
            assert!(!opens_with(at, range.most + 1), "{end}: {at}");
            assert!(!opens_with(at, range.least.wrapping_sub(1)), "{end}: {at}");
        }
        // Couplers of different lengths, and no curve that says how far they lean.
        let skew = place!(curves) + 2 * ((end + 1) * CURVES as u16 - 1);
        assert!(!opens_with(skew, 0), "{end}");
    }
}

#[test]
fn the_guard_accepts_the_neutral_pose() {
    for change in 0..3 {
        let mut content = Sample::odd().content.clone();
        assert!(Changed(content.section()).opens());
        match change {
            0 => content.limits.leg.0 = i16::MAX,
            1 => content.limits.type1.0 = i16::MAX,
            _ => content.limits.type2.0 = i16::MAX,
        }
        assert!(!Changed(content.section()).opens(), "{change}");
    }
}
