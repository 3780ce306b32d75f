//! The safety monitor: checks the supply, the serial port, the pulses and the stack for faults in every frame, and
//! times the `boot` action after power-on.
//!
//! The table of events in [`supervisor`] gives the response to each event. A fault stops the motion and lasts until a
//! command moves the robot again. Only the `boot` action, three seconds after power-on, starts a motion by itself.

use crate::control::fault::{Fault, LedPattern};
use crate::control::supervisor::{self, Event, Response, State};
use crate::control::supply::{Level, Reading, Supply};
use crate::numbers::supplies::Supplies;
use crate::numbers::units::{FRAME_MS, FRAMES_PER_SECOND};

/// The board's health, reported with every frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Health {
    /// The last reading of the supplies.
    pub supply: Reading,
    /// The number of late pulse edges so far.
    pub late_edges: u16,
    /// True unless the stack has grown into the data.
    pub is_stack_intact: bool,
    /// True while the contact that the controller waits for is closed.
    pub is_contact_closed: bool,
}

/// The reaction to a frame's events. Of several reactions, the last one in this list counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reaction {
    /// Do nothing.
    None,
    /// Execute the `boot` setting.
    Boot,
    /// Freeze the pose.
    Freeze,
    /// End the pulses.
    EndPulses,
}

/// The safety monitor: the supply, the time without a command, the fault, and the notices to print.
#[derive(Clone, Debug)]
pub struct Safety {
    supply: Supply,
    fault: Option<Fault>,
    led: LedPattern,
    /// True while the LED is lit.
    is_lit: bool,
    /// The number of late edges that have been handled as faults.
    handled_late_edges: u16,
    /// Milliseconds since the last command, at most 65535.
    silence_ms: u16,
    /// Frames since the program's start. [`FRAMES_TO_BOOT`] means that `boot` has been executed or cancelled.
    boot_timer: u8,
    /// The pending notices, one bit for each [`Notice`].
    notices: u8,
}

/// An unsolicited line. Pending notices are printed in the order of the variants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Notice {
    /// The state of the saved settings at power-on.
    SavedSettings,
    /// The rest pose could not be saved in the EEPROM.
    RestPoseNotSaved,
    /// A fault has occurred.
    Fault,
    /// The supply's level has changed.
    Supply,
    /// The `boot` action starts.
    Boot,
    /// A counted gait or a routine is complete.
    Done,
    /// A step of a routine waits for an input.
    Waiting,
}

/// The number of notices.
const NOTICE_COUNT: u8 = 7;

impl Notice {
    /// Returns the notice whose bit has this index; [`Notice::Waiting`] for an index of 6 or more.
    const fn at(index: u8) -> Self {
        match index {
            0 => Self::SavedSettings,
            1 => Self::RestPoseNotSaved,
            2 => Self::Fault,
            3 => Self::Supply,
            4 => Self::Boot,
            5 => Self::Done,
            _ => Self::Waiting,
        }
    }
}

/// Frames from the start of the program to the `boot` action: three seconds.
const FRAMES_TO_BOOT: u8 = 3 * FRAMES_PER_SECOND as u8;

impl Safety {
    /// Creates the monitor at power-on.
    pub const fn new() -> Self {
        Self {
            supply: Supply::new(),
            fault: None,
            led: LedPattern::new(),
            is_lit: false,
            handled_late_edges: 0,
            silence_ms: 0,
            boot_timer: 0,
            notices: 0,
        }
    }

    /// The last fault; `None` if there has been none, or if an order has moved the robot since.
    pub const fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// The supply, with its current level and reading.
    pub const fn supply(&self) -> &Supply {
        &self.supply
    }

    /// True while the LED is lit.
    pub const fn is_lit(&self) -> bool {
        self.is_lit
    }

    /// True if the supply limits the pace of gaits.
    pub fn is_slow(&self) -> bool {
        self.supply.level() > Level::Good
    }

    /// True if the supply is good enough for writing the EEPROM; false until the supply is measured.
    pub fn allows_writing(&self) -> bool {
        self.supply.measured_level() == Some(Level::Good)
    }

    /// True if the EEPROM may be written now: the supply is good enough, and there is no dip.
    pub fn allows_writing_now(&self) -> bool {
        self.allows_writing() && self.supply.is_steady()
    }

    /// Looks up the supervisor's response to an event.
    #[inline(never)]
    pub fn response(&self, event: Event, state: State) -> Response {
        supervisor::response(event, self.supply.measured_level(), state)
    }

    /// Checks a frame's health and returns the reaction. A gait ends after `deadman_ms` milliseconds without a command,
    /// and no sooner; 0 means never.
    pub fn check_frame(
        &mut self,
        health: &Health,
        supplies: &Supplies,
        state: State,
        deadman_ms: u16,
    ) -> Reaction {
        let mut reaction = Reaction::None;
        self.silence_ms = self.silence_ms.saturating_add(FRAME_MS);
        if self.boot_timer < FRAMES_TO_BOOT {
            self.boot_timer += 1;
            if self.boot_timer == FRAMES_TO_BOOT
                && self.fault.is_none()
                && self.response(Event::BootDue, state) == Response::Obey
            {
                self.silence_ms = 0;
                reaction = Reaction::Boot;
            }
        }
        // The last command may have arrived at the end of the first counted frame, so one frame is subtracted.
        if deadman_ms != 0 && self.silence_ms.saturating_sub(FRAME_MS) >= deadman_ms {
            reaction = reaction.max(self.react_to(Event::Silence, state));
        }
        if self.supply.add_reading(health.supply, supplies) {
            self.notify(Notice::Supply);
            reaction = reaction.max(match self.supply.level() {
                Level::Good | Level::Slow => Reaction::None,
                Level::Stop => self.react_to(Event::SupplyTooLowToMove, state),
                Level::Rest => self.react_to(Event::SupplyTooLowToHold, state),
            });
        }
        if health.late_edges != self.handled_late_edges {
            self.handled_late_edges = health.late_edges;
            reaction = reaction.max(self.react_to(Event::LateEdge, state));
        }
        if !health.is_stack_intact && self.fault != Some(Fault::Stack) {
            reaction = reaction.max(self.react_to(Event::StackOverflow, state));
        }
        reaction
    }

    /// Records the fault that the table of events gives for `event`, if any, and returns the reaction.
    #[inline(never)]
    fn react_to(&mut self, event: Event, state: State) -> Reaction {
        match self.response(event, state) {
            Response::Freeze(fault) => {
                self.record_fault(fault);
                Reaction::Freeze
            }
            Response::EndPulses(fault) => {
                self.record_fault(fault);
                Reaction::EndPulses
            }
            _ => Reaction::None,
        }
    }

    /// Advances the LED by a frame. `is_held` is true while the guard holds the robot.
    pub fn advance_led(&mut self, is_held: bool) {
        let fault = if is_held {
            Some(Fault::Guard)
        } else {
            self.fault
        };
        self.is_lit = self.led.advance(fault);
    }

    /// Records a fault and requests its notice.
    #[inline(never)]
    pub fn record_fault(&mut self, fault: Fault) {
        self.fault = Some(fault);
        self.notify(Notice::Fault);
    }

    /// Clears the fault; called when an order moves the robot.
    pub fn clear_fault(&mut self) {
        self.fault = None;
    }

    /// Records that a byte was received. Cancels `boot`, because a computer is connected.
    pub fn record_byte(&mut self) {
        self.boot_timer = FRAMES_TO_BOOT;
    }

    /// Records that a command was received.
    pub fn record_command(&mut self) {
        self.silence_ms = 0;
    }

    /// Requests that a notice be printed.
    pub fn notify(&mut self, notice: Notice) {
        self.notices |= 1 << notice as u8;
    }

    /// The notice to print next, if any.
    pub const fn next_notice(&self) -> Option<Notice> {
        let mut index = 0;
        while index < NOTICE_COUNT {
            if self.notices & (1 << index) != 0 {
                return Some(Notice::at(index));
            }
            index += 1;
        }
        None
    }

    /// Removes a notice that has been printed, or is no longer true, from the pending notices.
    pub fn clear_notice(&mut self, notice: Notice) {
        self.notices &= !(1 << notice as u8);
    }
}

#[cfg(test)]
mod tests;
