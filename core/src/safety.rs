//! What may go wrong beside a pose, watched every frame: the supply, the line, the
//! pulses, the stack. And what the robot does unasked after power-on.
//!
//! A fault stops the motion and is kept until somebody tells the robot to move
//! again. Nothing here ever begins a motion by itself, but for the one that
//! `boot` asks for, three seconds after power-on.

use crate::fault::{Fault, Led};
use crate::supply::{Level, Reading, Supplies, Supply};
use crate::units::FRAMES_PER_SECOND;

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
pub enum Order {
    /// Nothing.
    None,
    /// Do what `boot` says.
    Boot,
    /// Freeze.
    Stop,
    /// End the pulses.
    Rest,
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
    /// Frames until `boot`; 0 once it is done or called off.
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
    /// A fault.
    Fault,
    /// The supply's level has changed.
    Supply,
    /// `boot` begins.
    Boot,
}

/// In the order in which they are written.
const NOTICES: [Notice; 4] = [Notice::Memory, Notice::Fault, Notice::Supply, Notice::Boot];

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
            lit: true,
            late: 0,
            silence: 0,
            boot: BOOT_AFTER,
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

    /// Whether the supply allows a motion.
    pub fn allows_motion(&self) -> bool {
        self.supply.level() < Level::Stop
    }

    /// Whether the supply allows to write the memory.
    pub fn allows_writing(&self) -> bool {
        self.supply.level() == Level::Good
    }

    /// One frame on. `walks` says whether a gait other than `stand` is under way,
    /// which ends after `deadman` milliseconds without a line (0: never).
    pub fn frame(
        &mut self,
        health: &Health,
        supplies: &Supplies,
        walks: bool,
        deadman: u16,
    ) -> Order {
        let mut order = Order::None;
        self.silence = self.silence.saturating_add(FRAME_MS);
        if self.boot > 0 {
            self.boot -= 1;
            if self.boot == 0 && self.fault.is_none() && self.allows_motion() {
                self.silence = 0;
                order = Order::Boot;
            }
        }
        if walks && deadman != 0 && self.silence >= deadman {
            order = order.max(self.fail(Fault::Link));
        }
        if self.supply.measure(health.supply, supplies) {
            self.notify(Notice::Supply);
            match self.supply.level() {
                Level::Good | Level::Slow => {}
                Level::Stop => order = order.max(self.fail(Fault::Supply)),
                Level::Rest => {
                    self.fail(Fault::Supply);
                    order = Order::Rest;
                }
            }
        }
        if health.late != self.late {
            self.late = health.late;
            order = order.max(self.fail(Fault::Late));
        }
        if !health.stack_is_intact && self.fault != Some(Fault::Stack) {
            order = order.max(self.fail(Fault::Stack));
        }
        order
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
    pub fn fail(&mut self, fault: Fault) -> Order {
        self.fault = Some(fault);
        self.notify(Notice::Fault);
        Order::Stop
    }

    /// The robot has been told to move.
    pub fn clear(&mut self) {
        self.fault = None;
    }

    /// A byte has come: somebody is there, and `boot` is called off.
    pub fn byte_came(&mut self) {
        self.boot = 0;
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
        while place < NOTICES.len() {
            if self.notices & (1 << place) != 0 {
                return Some(NOTICES[place]);
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
