//! The cause of a reset, and the servos' state from before it.
//!
//! A robot that is reset in the middle of a step need not fall over: the servos are where they were, and a few bytes of
//! RAM that survive a reset hold their positions ([`crate::memory::retained_ram`]).

use crate::numbers::pose::{Pose, Pulses};
use crate::numbers::rate::BaudRate;
use crate::numbers::units::PulseWidth;

/// The cause of a reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Cause {
    /// Power was switched on.
    #[default]
    Power,
    /// The reset button, or a computer that opened the port.
    External,
    /// The supply of the chip was too low for a moment.
    BrownOut,
    /// The watchdog, because the program, its clock or its pulses hung.
    Watchdog,
}

impl Cause {
    /// All causes.
    pub const ALL: [Self; 4] = [Self::Power, Self::External, Self::BrownOut, Self::Watchdog];
}

/// The state of the servos that has to survive a reset, so that the next run can take the servos over without a jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Stance {
    /// True while the servos get no pulses.
    pub is_resting: bool,
    /// Frames since the pulses began, up to [`crate::motion::AWAKE_FRAMES`], when all servos have been woken one after
    /// the other.
    pub frames_awake: u8,
    /// The pose that the servos hold or last held.
    pub pose: Pose,
    /// The pulses of the last frame, including those of servos that have not been woken yet. They may come from a
    /// calibration that was never saved.
    pub sent_pulses: Pulses,
}

/// The information that survived a reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Restart {
    /// The reset's cause.
    pub cause: Cause,
    /// Resets since power-on, at most 255.
    pub reset_count: u8,
    /// True if a weak supply may be the cause: a brown-out, or a reset whose cause a boot
    /// loader hides.
    pub is_supply_suspected: bool,
    /// Consecutive resets before this one that a weak supply may have caused.
    pub brown_outs: u8,
    /// The rate of the serial line: after a brown-out or a hang, the rate before it; otherwise the fastest rate,
    /// because opening the USB port resets the board, and USB uses the fastest rate.
    pub rate: BaudRate,
    /// The servos' state before the reset; `None` if it is unknown, and always after
    /// [`Cause::Power`].
    pub stance_before: Option<Stance>,
}

impl Stance {
    /// Servos that have never had pulses.
    pub const RESTING: Self = Self {
        is_resting: true,
        frames_awake: 0,
        pose: Pose::NEUTRAL,
        sent_pulses: Pulses([PulseWidth(0); 4]),
    };
}

impl Restart {
    /// The state after power-on, when nothing survives.
    pub const NONE: Self = Self {
        cause: Cause::Power,
        reset_count: 0,
        is_supply_suspected: false,
        brown_outs: 0,
        rate: BaudRate::Fastest,
        stance_before: None,
    };
}
