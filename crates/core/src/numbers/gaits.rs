//! The gaits of a robot as its section has them: waveforms, channels, names.

use lizard_avr::Flash;

/// Samples of a waveform.
pub const SAMPLES: usize = 64;

/// The longest name of a gait, with which `status` still fits a line of the console.
pub const MAX_NAME_BYTES: usize = 48;

/// The most gaits that a robot may have: a byte numbers them.
pub const MAX_GAITS: usize = 255;

/// The most waveforms that gaits may share: a byte numbers them.
pub const MAX_WAVES: usize = 255;

/// Samples over a cycle, 1/65536 turn at a gain of 1.
pub type Wave = [i16; SAMPLES];

/// A gait's name, byte by byte from flash, its words with a blank in between: also
/// its console command.
#[derive(Clone, Copy)]
pub struct Name<'a> {
    names: Flash<'a, [u8]>,
    at: u16,
    left: u8,
}

impl<'a> Name<'a> {
    /// The name that begins at `start` among the names of a robot's gaits.
    pub fn of(start: u16, length: u16, names: Flash<'a, [u8]>) -> Self {
        Self {
            names,
            at: start,
            left: length.min(MAX_NAME_BYTES as u16) as u8,
        }
    }

    /// The number of bytes that are still to be read.
    pub const fn length(&self) -> u8 {
        self.left
    }
}

impl Iterator for Name<'_> {
    type Item = u8;

    fn next(&mut self) -> Option<u8> {
        self.left = self.left.checked_sub(1)?;
        let byte = self.names.get(usize::from(self.at))?.load();
        self.at += 1;
        Some(byte)
    }
}

lizard_avr::plain! {
    /// The motion of one servo in a gait.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Channel {
        /// The number of the waveform.
        pub wave: u16,
        /// The lead of the servo's phase over that of the gait, 1/65536 cycle.
        pub offset: u16,
        /// The factor of the waveform, Q14, counter-clockwise positive.
        pub gain: i16,
    }
}

lizard_avr::plain! {
    /// A gait, or a routine, whose record has the same fields and no gain.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Gait {
        /// Phase in 1/2^24 cycle for each frame at full pace; negative where the
        /// table is read backwards. 0 for a routine.
        pub increment: i32,
        /// The channels of the four servos. In a routine the first offset is the address of the
        /// first [`Step`] in the section, the second the number of steps, the third the number
        /// of rounds, 0 without end, and the fourth the number of the step at which each round
        /// but the first begins.
        pub channels: [Channel; 4],
        /// The index of the name's first byte among the names of the robot.
        pub name_start: u16,
        /// The name's length, at most [`MAX_NAME_BYTES`].
        pub name_length: u16,
    }
}

lizard_avr::plain! {
    /// A step of a routine.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Step {
        /// The kind of step, one of the constants of [`Step`].
        pub kind: u8,
        /// The index of the gait; of [`Step::UNTIL`] the [`Input`].
        pub gait: u8,
        /// The duration in cycles of the gait or in frames; [`Step::ENDLESS`] frames do not end.
        pub count: u16,
    }
}

impl Step {
    /// A gait for so many cycles.
    pub const CYCLES: u8 = 0;

    /// A gait for so many frames, the move to it included.
    pub const FRAMES: u8 = 1;

    /// No pulses for so many frames, at least one.
    pub const REST: u8 = 2;

    /// The robot stands still until the contact of the record before this one closes.
    pub const WAIT: u8 = 3;

    /// A record in front of a step: a contact that ends it, before its count or time is over.
    pub const UNTIL: u8 = 4;

    /// The frames of a step that only its contact ends.
    pub const ENDLESS: u16 = u16::MAX;
}

/// An input: a contact between a pin and ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input(u8);

impl Input {
    /// No input.
    pub const NONE: Self = Self(0);

    /// The bit by which the nose is told from the button.
    const NOSE: u8 = 0x80;

    /// The button at the pin with this Arduino number; 14 to 19 are A0 to A5.
    pub const fn button(pin: u8) -> Self {
        Self(pin)
    }

    /// The obstacle switch at the pin with this Arduino number.
    pub const fn nose(pin: u8) -> Self {
        Self(pin | Self::NOSE)
    }

    /// The input of a record of the kind [`Step::UNTIL`].
    pub const fn of(step: &Step) -> Self {
        Self(step.gait)
    }

    /// The byte of a record.
    pub const fn byte(self) -> u8 {
        self.0
    }

    /// True for the obstacle switch.
    pub const fn is_nose(self) -> bool {
        self.0 & Self::NOSE != 0
    }

    /// The Arduino number of the pin, 0 if there is no input.
    pub const fn pin(self) -> u8 {
        self.0 & !Self::NOSE
    }
}

/// A gait or a routine by its index in the section: the gaits in the order of robot.toml, then
/// the routines. Index 0 is `stand`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GaitId(u8);

impl GaitId {
    /// The gait that holds the neutral pose.
    pub const STAND: Self = Self(0);

    /// All gaits of a robot that has `count` of them, in their order.
    pub fn all(count: usize) -> impl Iterator<Item = Self> {
        (0..count as u8).map(Self)
    }

    /// The gait at an index.
    pub const fn at(index: u8) -> Self {
        Self(index)
    }

    /// The gait's index.
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The next of `count` gaits, if there is one.
    pub fn next(self, count: usize) -> Option<Self> {
        (self.index() + 1 < count).then(|| Self(self.0 + 1))
    }
}

impl Gait {
    /// A routine without a name.
    #[cfg(any(test, feature = "host"))]
    pub const fn routine(first: u16, steps: u16, rounds: u16) -> Self {
        let mut routine = Self::STILL;
        routine.channels[0].offset = first;
        routine.channels[1].offset = steps;
        routine.channels[2].offset = rounds;
        routine
    }

    /// True for a routine.
    pub const fn is_routine(&self) -> bool {
        self.increment == 0
    }

    /// A gait that does not move.
    pub const STILL: Self = Self {
        name_start: 0,
        name_length: 0,
        increment: 0,
        channels: [Channel {
            wave: 0,
            offset: 0,
            gain: 0,
        }; 4],
    };
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;
    use crate::sample::{GAITS, Sample};

    #[test]
    fn names_and_numbers_of_gaits_go_together() {
        let robot = Sample::odd();
        let ids: Vec<GaitId> = GaitId::all(robot.gait_count()).collect();
        assert_eq!(ids.len(), GAITS.len());
        assert_eq!(ids[0], GaitId::STAND);
        for (index, id) in ids.iter().enumerate() {
            assert_eq!(id.index(), index);
            assert_eq!(id.next(robot.gait_count()), ids.get(index + 1).copied());
            let name = robot.name(*id);
            assert_eq!(usize::from(name.length()), GAITS[index].len());
            assert!(name.eq(GAITS[index].bytes()));
        }
    }
}
