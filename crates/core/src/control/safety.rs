//! The faults other than an unsafe pose, which are watched in every frame: the supply,
//! the line, the pulses, the stack. And what the robot does by itself after power-on.
//!
//! The table of [`supervisor`] says what each event causes. A fault stops the motion and
//! stays until a command moves the robot again. Nothing here begins a motion by itself,
//! except the one that `boot` asks for, three seconds after the start.

use crate::control::fault::{Fault, Led};
use crate::control::supervisor::{self, Event, Response, State};
use crate::control::supply::{Level, Reading, Supply};
use crate::numbers::supplies::Supplies;
use crate::numbers::units::FRAMES_PER_SECOND;

/// What the board reports with every frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Health {
    /// The supplies.
    pub supply: Reading,
    /// Pulse edges that came late, so far.
    pub late: u16,
    /// Whether the stack has kept off the data.
    pub stack_is_intact: bool,
}

impl Default for Health {
    /// Nothing measured yet, and nothing wrong.
    fn default() -> Self {
        Self {
            supply: Reading::default(),
            late: 0,
            stack_is_intact: true,
        }
    }
}

/// What a frame asks for; of several, the last of this list counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reaction {
    /// Nothing.
    None,
    /// Do what `boot` says.
    Boot,
    /// Freeze.
    Freeze,
    /// End the pulses.
    EndPulses,
}

/// What is watched.
#[derive(Clone, Debug)]
pub struct Safety {
    supply: Supply,
    fault: Option<Fault>,
    led: Led,
    lit: bool,
    /// Late edges that have been reported.
    late: u16,
    /// Milliseconds since the last line, up to 65535.
    silence: u16,
    /// Frames since power-on, up to [`BOOT_AFTER`]: `boot` is done then, or called off.
    boot: u8,
    /// What is still to be said, a bit for each [`Notice`].
    notices: u8,
}

/// A line that is written without being asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Notice {
    /// What was found in the memory at power-on.
    Memory,
    /// The memory has not kept the pose of a rest.
    NotKept,
    /// A fault.
    Fault,
    /// The supply's level has changed.
    Supply,
    /// `boot` begins.
    Boot,
}

/// How many notices there are.
const NOTICES: u8 = 5;

impl Notice {
    /// The notice at a place of the order in which they are written.
    const fn at(place: u8) -> Self {
        match place {
            0 => Self::Memory,
            1 => Self::NotKept,
            2 => Self::Fault,
            3 => Self::Supply,
            _ => Self::Boot,
        }
    }
}

/// Milliseconds of a frame.
const FRAME_MS: u16 = 1000 / FRAMES_PER_SECOND;

/// Frames from power-on to `boot`, three seconds.
const BOOT_AFTER: u8 = 3 * FRAMES_PER_SECOND as u8;

impl Default for Safety {
    fn default() -> Self {
        Self::new()
    }
}

impl Safety {
    /// At power-on.
    pub const fn new() -> Self {
        Self {
            supply: Supply::new(),
            fault: None,
            led: Led::new(),
            lit: false,
            late: 0,
            silence: 0,
            boot: 0,
            notices: 0,
        }
    }

    /// The fault that stopped the robot last, unless it has been told to move since.
    pub const fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// The supply.
    pub const fn supply(&self) -> &Supply {
        &self.supply
    }

    /// Whether the LED is lit.
    pub const fn is_lit(&self) -> bool {
        self.lit
    }

    /// Whether the supply allows gaits no more than half their pace.
    pub fn is_slow(&self) -> bool {
        self.supply.level() > Level::Good
    }

    /// Whether the supply allows to write the memory. Not before it was measured.
    pub fn allows_writing(&self) -> bool {
        self.supply.measured() == Some(Level::Good)
    }

    /// Whether it does so at this moment: not while it dips.
    pub fn allows_writing_now(&self) -> bool {
        self.allows_writing() && self.supply.is_steady()
    }

    /// What follows from an event.
    #[inline(never)]
    pub fn response(&self, event: Event, state: State) -> Response {
        supervisor::response(event, self.supply.measured(), state)
    }

    /// One frame on. A gait ends after `deadman` milliseconds without a line (0:
    /// never), and no sooner.
    pub fn frame(
        &mut self,
        health: &Health,
        supplies: &Supplies,
        state: State,
        deadman: u16,
    ) -> Reaction {
        let mut reaction = Reaction::None;
        self.silence = self.silence.saturating_add(FRAME_MS);
        if self.boot < BOOT_AFTER {
            self.boot += 1;
            if self.boot == BOOT_AFTER
                && self.fault.is_none()
                && self.response(Event::Boot, state) == Response::Obey
            {
                self.silence = 0;
                reaction = Reaction::Boot;
            }
        }
        // The line came at some time in the first of these frames.
        if deadman != 0 && self.silence.saturating_sub(FRAME_MS) >= deadman {
            reaction = reaction.max(self.meet(Event::Silence, state));
        }
        if self.supply.measure(health.supply, supplies) {
            self.notify(Notice::Supply);
            reaction = reaction.max(match self.supply.level() {
                Level::Good | Level::Slow => Reaction::None,
                Level::Stop => self.meet(Event::TooLow, state),
                Level::Rest => self.meet(Event::Empty, state),
            });
        }
        if health.late != self.late {
            self.late = health.late;
            reaction = reaction.max(self.meet(Event::LateEdge, state));
        }
        if !health.stack_is_intact && self.fault != Some(Fault::Stack) {
            reaction = reaction.max(self.meet(Event::Stack, state));
        }
        reaction
    }

    /// Something has gone wrong: tells it, as the table says.
    #[inline(never)]
    fn meet(&mut self, event: Event, state: State) -> Reaction {
        match self.response(event, state) {
            Response::Freeze(fault) => {
                self.fail(fault);
                Reaction::Freeze
            }
            Response::EndPulses(fault) => {
                self.fail(fault);
                Reaction::EndPulses
            }
            _ => Reaction::None,
        }
    }

    /// The LED's part of a frame; `guard` says whether the guard holds the robot.
    pub fn beat(&mut self, guard: bool) {
        let fault = if guard {
            Some(Fault::Guard)
        } else {
            self.fault
        };
        self.lit = self.led.frame(fault);
    }

    /// A fault, from now on.
    #[inline(never)]
    pub fn fail(&mut self, fault: Fault) {
        self.fault = Some(fault);
        self.notify(Notice::Fault);
    }

    /// The robot has been told to move.
    pub fn clear(&mut self) {
        self.fault = None;
    }

    /// A byte has come, so a computer is connected, and `boot` is cancelled.
    pub fn byte_came(&mut self) {
        self.boot = BOOT_AFTER;
    }

    /// A line has come.
    pub fn line_came(&mut self) {
        self.silence = 0;
    }

    /// Has something written.
    pub fn notify(&mut self, notice: Notice) {
        self.notices |= 1 << notice as u8;
    }

    /// What is to be written next, if anything.
    pub const fn notice(&self) -> Option<Notice> {
        let mut place = 0;
        while place < NOTICES {
            if self.notices & (1 << place) != 0 {
                return Some(Notice::at(place));
            }
            place += 1;
        }
        None
    }

    /// It has been written.
    pub fn written(&mut self, notice: Notice) {
        self.notices &= !(1 << notice as u8);
    }
}

#[cfg(test)]
mod tests;
