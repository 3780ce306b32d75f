//! Why the program began, and what it did until then.
//!
//! A robot that restarts in mid-step need not fall over: the servos are where they were,
//! and a few bytes of memory that survive a reset say where that is ([`crate::memory::kept`]).

use crate::numbers::pose::{Pose, Pulses};
use crate::numbers::units::Width;

/// What made the program begin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Cause {
    /// Power came on.
    #[default]
    Power,
    /// The reset button, or a computer that opened the port.
    External,
    /// The supply of the chip was too low for a moment.
    BrownOut,
    /// The watchdog: the program, its clock or its pulses hung.
    Watchdog,
}

impl Cause {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Power, Self::External, Self::BrownOut, Self::Watchdog];
}

/// What the servos are doing: all that has to survive a reset for the next program to
/// take them over without a leap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Stance {
    /// Whether there are no pulses.
    pub resting: bool,
    /// Frames since pulses began, up to [`crate::motion::AWAKE`]; servos wake one
    /// after the other.
    pub awake: u8,
    /// The pose.
    pub pose: Pose,
    /// The pulses of the last frame, of servos that sleep, too. They may belong to a
    /// calibration that was never saved.
    pub sent: Pulses,
}

/// What is known at the beginning.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Restart {
    /// Why.
    pub cause: Cause,
    /// How many times since power came on; stays at 255.
    pub count: u8,
    /// Whether it may have been a weak supply: a brown-out, or a reset behind a boot
    /// loader that does not tell one from the other.
    pub may_be_supply: bool,
    /// Restarts in a row before this one that a weak supply may have made.
    pub brown_outs: u8,
    /// What the servos did until then, if that is known. Never after
    /// [`Cause::Power`].
    pub before: Option<Stance>,
}

impl Stance {
    /// No pulses, and none before.
    pub const RESTING: Self = Self {
        resting: true,
        awake: 0,
        pose: Pose::NEUTRAL,
        sent: Pulses([Width(0); 4]),
    };
}

impl Restart {
    /// Power came on, and nothing is known.
    pub const NONE: Self = Self {
        cause: Cause::Power,
        count: 0,
        may_be_supply: false,
        brown_outs: 0,
        before: None,
    };
}
