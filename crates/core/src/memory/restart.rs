//! The cause of a reset, and the state of the servos before the reset.
//!
//! A robot that is reset in the middle of a motion need not jump to the neutral pose: the servos are still in their
//! positions, which a few bytes of RAM preserve across the reset ([`crate::memory::retained_ram`]).

use crate::numbers::pose::{Pose, Pulses};
use crate::numbers::rate::BaudRate;
use crate::numbers::units::PulseWidth;

/// The cause of a reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Cause {
    /// Power was switched on.
    Power,
    /// The reset button was pressed, or a computer opened the port.
    External,
    /// The chip's supply was too low for a moment.
    BrownOut,
    /// The watchdog reset the chip, because the program, its clock or its pulses hung.
    Watchdog,
}

impl Cause {
    /// All causes of a reset.
    pub const ALL: [Self; 4] = [Self::Power, Self::External, Self::BrownOut, Self::Watchdog];
}

/// The state of the servos, which must survive a reset so that the next run can resume the pulses without a jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ServoState {
    /// True while the servos get no pulses.
    pub is_resting: bool,
    /// Frames since the servos began to wake, at most [`crate::motion::AWAKE_FRAMES`], after which all servos are
    /// awake.
    pub frames_awake: u8,
    /// The current pose of the servos, or their last pose.
    pub pose: Pose,
    /// The pulses of the last frame, including servos that are not awake yet. The calibration of these pulses may never
    /// have been saved.
    pub sent_pulses: Pulses,
}

/// The information that survived a reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Restart {
    /// The reset's cause.
    pub cause: Cause,
    /// Resets since power-on, at most 255.
    pub reset_count: u8,
    /// True if a weak supply may be the cause: after a brown-out, or after a reset whose cause a boot loader hides.
    pub is_supply_suspected: bool,
    /// Consecutive resets before this one that a weak supply may have caused.
    pub suspected_brown_outs: u8,
    /// The baud rate of the serial port: after a brown-out or a hang the previous rate, otherwise the fastest rate,
    /// because opening the USB port resets the board, and USB uses the fastest rate.
    pub rate: BaudRate,
    /// The state of the servos before the reset; `None` if the state is unknown, and always after [`Cause::Power`].
    pub servo_state_before: Option<ServoState>,
}

impl ServoState {
    /// The state of servos that have never received pulses.
    pub const RESTING: Self = Self {
        is_resting: true,
        frames_awake: 0,
        pose: Pose::NEUTRAL,
        sent_pulses: Pulses([PulseWidth(0); 4]),
    };
}

impl Restart {
    /// The restart after power-on, which no information survives.
    pub const NONE: Self = Self {
        cause: Cause::Power,
        reset_count: 0,
        is_supply_suspected: false,
        suspected_brown_outs: 0,
        rate: BaudRate::Fastest,
        servo_state_before: None,
    };
}
