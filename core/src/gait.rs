//! A gait: four sweeps as a function of one phase.
//!
//! Feet are not lifted; each leg swings and drags its pad. What makes the
//! robot go is the shape of the swing and the order of the legs, so a gait is
//! a waveform read at four offsets with four gains. Waveforms are tables of
//! 128 samples in flash; between samples a straight line is within 0.1 deg of
//! the real curve, which whoever makes the tables has checked.

use lizard_avr::{Flash, mul};

use crate::pose::Pose;
use crate::robot::Robot;
use crate::units::{CYCLE, Sweep, phase16};

/// Samples of a waveform.
pub const SAMPLES: usize = 128;

/// The longest name of a gait: with it, `status` still is one line of the console.
pub const LONGEST_NAME: usize = 48;

/// The most gaits that a robot may have: a byte numbers them.
pub const MOST_GAITS: usize = 255;

/// The most waveforms that gaits may share: a byte numbers them.
pub const MOST_WAVES: usize = 255;

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
    /// The name of a gait among the names of its robot.
    pub const fn of(gait: &Gait, names: Flash<'a, [u8]>) -> Self {
        Self {
            names,
            at: gait.name_start,
            left: gait.name_length,
        }
    }

    /// Bytes that are left of it.
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

/// What one servo does in a gait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Which waveform.
    pub wave: u8,
    /// How far the servo's reading is ahead of the phase, 1/65536 cycle.
    pub offset: u16,
    /// Factor of the waveform, Q14, counter-clockwise positive.
    pub gain: i16,
}

/// One gait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gait {
    /// Where its name begins in [`Robot::names`].
    pub name_start: u16,
    /// The name's length, at most [`LONGEST_NAME`].
    pub name_length: u8,
    /// Phase in 1/2^24 cycle for each frame at full pace; negative where the
    /// table is read backwards.
    pub increment: i32,
    /// The four servos.
    pub channels: [Channel; 4],
}

/// A gait by its place in robot.toml. Place 0 is `stand`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GaitId(u8);

impl GaitId {
    /// The gait that holds the neutral pose.
    pub const STAND: Self = Self(0);

    /// All gaits of a robot, in their order.
    pub fn all<R: Robot>(robot: &R) -> impl Iterator<Item = Self> + use<R> {
        (0..robot.gaits().len() as u8).map(Self)
    }

    /// Its place.
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The next gait of a robot, if there is one.
    pub fn next<R: Robot>(self, robot: &R) -> Option<Self> {
        (self.index() + 1 < robot.gaits().len()).then(|| Self(self.0 + 1))
    }
}

impl Gait {
    /// A gait that does nothing.
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

    /// Where the servos stand at `phase` (1/2^24 cycle).
    pub fn pose<R: Robot>(&self, robot: &R, phase: u32) -> Pose {
        let mut pose = Pose::NEUTRAL;
        for (sweep, channel) in pose.0.iter_mut().zip(&self.channels) {
            if let Some(wave) = robot.waves().get(usize::from(channel.wave)) {
                *sweep = channel.sweep(wave, phase16(phase));
            }
        }
        pose
    }

    /// The phase one frame later, at `pace` (1024 is the gait's own).
    pub const fn advance(&self, phase: u32, pace: u16) -> u32 {
        let step = (self.increment * pace as i32) >> 10;
        phase.wrapping_add(step as u32) & (CYCLE - 1)
    }
}

impl Channel {
    /// The sweep at a phase of 1/65536 cycle.
    pub fn sweep(&self, wave: Flash<Wave>, phase: u16) -> Sweep {
        if self.gain == 0 {
            return Sweep(0);
        }
        let at = phase.wrapping_add(self.offset);
        let (index, fraction) = ((at >> 9) as u8, (at >> 1) as u8);
        let here = wave.at(usize::from(index)).load();
        let next = wave.at(usize::from((index + 1) & 0x7f)).load();
        let rise = (mul(next.wrapping_sub(here), i16::from(fraction)) + 128) >> 8;
        let value = here.wrapping_add(rise as i16);
        Sweep((mul(value, self.gain).wrapping_add(1 << 13) >> 14) as i16)
    }
}
