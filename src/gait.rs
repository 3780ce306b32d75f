//! A gait: four sweeps as a function of one phase.
//!
//! Feet are not lifted; each leg swings and drags its pad. What makes the
//! robot go is the shape of the swing and the order of the legs, so a gait is
//! a waveform read at four offsets with four gains. Waveforms are tables of
//! 128 samples in flash, computed and checked by the build script; between
//! samples a straight line is within 0.1 deg of the real curve.

use lizard_avr::mul;

use crate::pose::Pose;
use crate::robot::{GAIT_COUNT, GAITS, WAVES};
use crate::units::phase16;

/// What one servo does in a gait.
#[derive(Clone, Copy, Debug)]
pub struct Channel {
    /// Which waveform.
    pub wave: u8,
    /// How far the servo's reading is ahead of the phase, 1/65536 cycle.
    pub offset: u16,
    /// Factor of the waveform, Q14.
    pub gain: i16,
}

/// A gait's name, padded with blanks: also its console command.
pub type Name = [u8; 12];

/// One gait.
#[derive(Clone, Copy, Debug)]
pub struct Gait {
    /// Console command.
    pub name: Name,
    /// Phase in 1/2^24 cycle for each frame at full pace; negative where the
    /// table is read backwards.
    pub increment: i32,
    /// The four servos.
    pub channels: [Channel; 4],
}

/// A gait of `robot.toml`, by its place in the file. Place 0 is `stand`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GaitId(u8);

impl GaitId {
    /// The gait that holds the neutral pose.
    pub const STAND: Self = Self(0);

    /// All gaits, in the order of `robot.toml`.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..GAIT_COUNT as u8).map(Self)
    }

    /// The gait's channels and pace, fetched from flash.
    pub fn load(self) -> Gait {
        GAITS.at(usize::from(self.0)).load()
    }

    /// The next gait in the file, if there is one.
    pub fn next(self) -> Option<Self> {
        (usize::from(self.0) + 1 < GAIT_COUNT).then(|| Self(self.0 + 1))
    }
}

impl Gait {
    /// Where the servos stand at `phase` (1/2^24 cycle).
    pub fn pose(&self, phase: u32) -> Pose {
        let mut pose = Pose::NEUTRAL;
        for (sweep, channel) in pose.0.iter_mut().zip(&self.channels) {
            *sweep = channel.sweep(phase16(phase));
        }
        pose
    }

    /// The phase one frame later, at `pace` (1024 is the gait's own).
    pub const fn advance(&self, phase: u32, pace: u16) -> u32 {
        let step = (self.increment * pace as i32) >> 10;
        phase.wrapping_add(step as u32) & (crate::units::CYCLE - 1)
    }
}

impl Channel {
    /// The sweep at a phase of 1/65536 cycle.
    fn sweep(&self, phase: u16) -> i16 {
        if self.gain == 0 {
            return 0;
        }
        let wave = WAVES.at(usize::from(self.wave));
        let at = phase.wrapping_add(self.offset);
        let (index, fraction) = ((at >> 9) as u8, (at >> 1) as u8);
        let here = wave.at(usize::from(index)).load();
        let next = wave.at(usize::from((index + 1) & 0x7f)).load();
        let rise = (mul(next - here, i16::from(fraction)) + 128) >> 8;
        let value = here + rise as i16;
        (mul(value, self.gain).wrapping_add(1 << 13) >> 14) as i16
    }
}
