//! A robot's gaits as stored in its section: waveforms, channels and names.

use lizard_avr::Flash;

/// The number of samples of a waveform.
pub const SAMPLES_PER_WAVE: usize = 64;

/// The largest length of a gait's name, bytes. The answer to `status` with such a name still fits into a line of the
/// console.
pub const MAX_NAME_BYTES: usize = 48;

/// The largest number of gaits, because an index is a byte.
pub const MAX_GAITS: usize = 255;

/// The largest number of waveforms, because an index is a byte.
pub const MAX_WAVES: usize = 255;

/// The samples of a waveform over one cycle, in 1/65536 turn at a gain of 1.
pub type Wave = [i16; SAMPLES_PER_WAVE];

/// A gait's name, which is also its console command, read byte by byte from flash: one or more words separated by
/// single blanks.
#[derive(Clone, Copy)]
pub struct GaitName<'a> {
    names: Flash<'a, [u8]>,
    /// The index of the next byte in `names`.
    position: u16,
    /// The number of unread bytes.
    remaining: u8,
}

impl<'a> GaitName<'a> {
    /// Creates the name of `length` bytes that begins at index `start` of `names`, the names of all gaits.
    pub fn new(start: u16, length: u16, names: Flash<'a, [u8]>) -> Self {
        Self {
            names,
            position: start,
            remaining: length.min(MAX_NAME_BYTES as u16) as u8,
        }
    }

    /// The number of unread bytes.
    pub const fn remaining(&self) -> u8 {
        self.remaining
    }
}

impl Iterator for GaitName<'_> {
    type Item = u8;

    fn next(&mut self) -> Option<u8> {
        self.remaining = self.remaining.checked_sub(1)?;
        let byte = self.names.get(usize::from(self.position))?.load();
        self.position += 1;
        Some(byte)
    }
}

lizard_avr::pod! {
    /// The motion of one servo in a gait.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Channel {
        /// The index of the waveform.
        pub wave: u16,
        /// The servo's phase minus the gait's phase, 1/65536 cycle.
        pub offset: u16,
        /// The factor of the waveform, Q14; a positive sweep is counter-clockwise.
        pub gain: i16,
    }
}

lizard_avr::pod! {
    /// A gait or a routine, which is a sequence of gaits and rests. A routine has the same fields, but its gains are 0.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Gait {
        /// The change of the phase per frame at full pace, 1/2^24 cycle; negative if the waveforms are read backwards,
        /// 0 for a routine.
        pub increment: i32,
        /// The channels of the four servos. A routine stores other numbers in the four offsets: the address of its
        /// first [`Step`] in the section, the number of steps, the number of rounds (0 if endless), and the index of
        /// the step at which each round after the first begins.
        pub channels: [Channel; 4],
        /// The index of the name's first byte in the names of all gaits.
        pub name_start: u16,
        /// The name's length, at most [`MAX_NAME_BYTES`].
        pub name_length: u16,
    }
}

lizard_avr::pod! {
    /// A step of a routine.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Step {
        /// The kind of step, one of the constants of [`Step`].
        pub kind: u8,
        /// The index of the gait, or the byte of the [`Input`] for [`Step::UNTIL`].
        pub gait: u8,
        /// The duration, in cycles of the gait or in frames; [`Step::ENDLESS`] if only a contact ends the step.
        pub count: u16,
    }
}

impl Step {
    /// Runs a gait for `count` cycles.
    pub const CYCLES: u8 = 0;

    /// Runs a gait for `count` frames, including the move to the gait.
    pub const FRAMES: u8 = 1;

    /// Stops the pulses for `count` frames, at least one.
    pub const REST: u8 = 2;

    /// Waits without motion until the contact in the preceding [`Step::UNTIL`] record closes.
    pub const WAIT: u8 = 3;

    /// A record before a step, with a contact that ends the step even before its count is complete.
    pub const UNTIL: u8 = 4;

    /// The `count` of a step that only its contact ends.
    pub const ENDLESS: u16 = u16::MAX;
}

/// An input: a contact between a pin and ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input(u8);

impl Input {
    /// No input.
    pub const NONE: Self = Self(0);

    /// The bit that is set for the obstacle switch on the robot's nose and cleared for a button.
    const NOSE: u8 = 0x80;

    /// Creates a button at the pin with this Arduino number; 14 to 19 are A0 to A5.
    pub const fn button(pin: u8) -> Self {
        Self(pin)
    }

    /// Creates the obstacle switch on the robot's nose, at the pin with this Arduino number.
    pub const fn nose(pin: u8) -> Self {
        Self(pin | Self::NOSE)
    }

    /// Returns the input of a record of the kind [`Step::UNTIL`].
    pub const fn from_step(step: &Step) -> Self {
        Self(step.gait)
    }

    /// The byte with which a record stores this input.
    pub const fn byte(self) -> u8 {
        self.0
    }

    /// True for the obstacle switch on the robot's nose.
    pub const fn is_nose(self) -> bool {
        self.0 & Self::NOSE != 0
    }

    /// The Arduino number of the pin; 0 if there is no input.
    pub const fn pin(self) -> u8 {
        self.0 & !Self::NOSE
    }
}

/// The index of a gait or a routine in the section, which contains first the gaits in the order of robot.toml, then the
/// routines. Index 0 is `stand`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GaitId(u8);

impl GaitId {
    /// The gait that holds the neutral pose.
    pub const STAND: Self = Self(0);

    /// Iterates over the ids of all `count` gaits and routines in their order.
    pub fn all(count: usize) -> impl Iterator<Item = Self> {
        (0..count as u8).map(Self)
    }

    /// Returns the id of the gait at an index.
    pub const fn at(index: u8) -> Self {
        Self(index)
    }

    /// The gait's index.
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// Returns the next id, or `None` after the last of `count` gaits.
    pub fn next(self, count: usize) -> Option<Self> {
        (self.index() + 1 < count).then(|| Self(self.0 + 1))
    }
}

impl Gait {
    /// Creates a routine without a name. `first_step` is the index of its first step among the steps of all routines;
    /// in a section, the address of this step replaces the index.
    #[cfg(any(test, feature = "host"))]
    pub const fn routine(first_step: u16, step_count: u16, round_count: u16) -> Self {
        let mut routine = Self::STILL;
        routine.channels[0].offset = first_step;
        routine.channels[1].offset = step_count;
        routine.channels[2].offset = round_count;
        routine
    }

    /// True if this is a routine.
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
    use crate::sample::{GAIT_NAMES, Sample};

    #[test]
    fn gait_names_and_ids_have_the_same_order() {
        let robot = Sample::asymmetric();
        let ids: Vec<GaitId> = GaitId::all(robot.gait_count()).collect();
        assert_eq!(ids.len(), GAIT_NAMES.len());
        assert_eq!(ids[0], GaitId::STAND);
        for (index, id) in ids.iter().enumerate() {
            assert_eq!(id.index(), index);
            assert_eq!(id.next(robot.gait_count()), ids.get(index + 1).copied());
            let name = robot.gait_name(*id);
            assert_eq!(usize::from(name.remaining()), GAIT_NAMES[index].len());
            assert!(name.eq(GAIT_NAMES[index].bytes()));
        }
    }
}
