//! What an observer remembers: the servos, the lines, the faults. No part of it asks the
//! core for its intentions.

use lizard_core::numbers::pose::Pulses;

/// Milliseconds of a frame.
const FRAME_MS: u16 = 20;

/// Frames in which servos that were held get their pulses again after a reset.
const TAKING_OVER: u8 = 25;

/// What has been seen so far.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// The width of the last pulse of each servo.
    pub width: [u16; 4],
    /// Whether the servo still is where that pulse put it.
    pub is_placed: [bool; 4],
    /// Whether it may still be there: a servo that waits for its turn after a reset has
    /// not been let go of.
    pub is_there: [bool; 4],
    /// Frames since a reset, up to 200.
    pub since_reset: u8,
    /// Whether it had a pulse in the last frame.
    pub is_on: [bool; 4],
    /// Whether the robot rests: no command has asked for pulses since they ended.
    pub rests: bool,
    /// Whether it has been told to rest since its last frame: that is what a reset
    /// before the next one may take.
    pub is_sent_to_rest: bool,
    /// Frames in a row, main running, without any pulse; up to 200.
    pub silent: u8,
    /// True if main was late for the last frame.
    pub is_late: bool,
    /// Frames since something stopped the robot, up to 200; 0 for nothing, or since a
    /// person acted.
    pub stopped: u8,
    /// Whether the console has said why.
    pub is_told: bool,
    /// Frames since the console said so last.
    pub since_told: u8,
    /// Lines sent and not answered.
    pub owed: i8,
    /// Of those, the ones whose answer is known already.
    pub known: i8,
    /// Frames for which the supply has been too low to write, up to 200.
    pub low: u8,
    /// Frames for which it has been too low to move.
    pub too_low: u8,
    /// Frames since it was too low to write.
    pub since_low: u8,
    /// Frames since it was too low to move.
    pub since_too_low: u8,
    /// Frames for which it has been too low to hold.
    pub far_too_low: u8,
    /// Milliseconds since the last line came, up to 1000.
    pub line_ms: u16,
    /// What `deadman` was set to last.
    pub deadman: u16,
    /// Brown-outs since a person acted.
    pub brown_outs: u8,
    /// Whether three servos that wake pull the supply down.
    pub is_weak: bool,
}

impl Seen {
    /// A robot whose supply is off.
    #[must_use]
    pub fn new() -> Self {
        Self {
            since_reset: 200,
            since_told: 200,
            since_low: 200,
            since_too_low: 200,
            ..Self::default()
        }
    }

    /// Power has come on: nobody knows where the servos are, and the robot may wake.
    pub fn power_on(&mut self) {
        *self = Self {
            is_weak: self.is_weak,
            low: self.low,
            too_low: self.too_low,
            since_low: self.since_low,
            since_too_low: self.since_too_low,
            far_too_low: self.far_too_low,
            ..Self::new()
        };
    }

    /// The processor restarts; servos stay where they are.
    pub fn reset(&mut self) {
        self.is_on = [false; 4];
        self.since_reset = 0;
        self.is_sent_to_rest = false;
        self.silent = 0;
        self.owed = 0;
        self.since_told = 200;
        self.too_low = 0;
        self.far_too_low = 0;
        self.known = 0;
        self.line_ms = 0;
    }

    /// Something stops the robot.
    pub fn stop(&mut self) {
        if self.stopped == 0 {
            self.stopped = 1;
            self.is_told = self.since_told < 20;
        }
    }

    /// A person has ordered a motion, and the robot has taken the order.
    pub fn order(&mut self) {
        // `rest` releases the servos, also right before `stand`.
        if self.is_on == [false; 4] || self.is_sent_to_rest {
            self.is_there = [false; 4];
        }
        self.rests = false;
        self.is_sent_to_rest = false;
        self.silent = 0;
        self.stopped = 0;
        self.brown_outs = 0;
    }

    /// A frame has passed in which main ran or not.
    pub fn frame(&mut self, begun: &Pulses, main_ran: bool) {
        for servo in 0..4 {
            let width = begun.0[servo].0;
            self.is_on[servo] = width > 0;
            if width > 0 {
                self.width[servo] = width;
                self.is_placed[servo] = true;
                self.is_there[servo] = true;
            } else if main_ran {
                self.is_placed[servo] = false;
                self.is_there[servo] &= self.since_reset <= TAKING_OVER && !self.rests;
            }
        }
        if main_ran {
            self.since_reset = self.since_reset.saturating_add(1).min(200);
            self.rests |= self.is_sent_to_rest;
            self.is_sent_to_rest = false;
            self.is_late = false;
            self.silent = if self.is_on == [false; 4] {
                self.silent.saturating_add(1).min(200)
            } else {
                0
            };
        } else {
            self.is_late = true;
        }
        if self.stopped > 0 && main_ran {
            self.stopped = self.stopped.saturating_add(1).min(200);
        }
        self.since_told = self.since_told.saturating_add(1).min(200);
        self.line_ms = (self.line_ms + FRAME_MS).min(1_000);
    }

    /// A frame has passed with the supply below what writing, moving and holding want.
    pub fn supply(&mut self, below: [bool; 3], main_ran: bool) {
        let count = |frames: u8, below: bool| {
            if below {
                frames.saturating_add(1).min(200)
            } else {
                0
            }
        };
        self.low = count(self.low, below[0]);
        self.too_low = count(self.too_low, below[1]);
        self.since_low = count(self.since_low, !below[0]);
        self.since_too_low = count(self.since_too_low, !below[1]);
        // A reading stands for two frames, so the last one may be later than its end.
        self.far_too_low = match below[2] {
            true => count(self.far_too_low, true),
            // Main has still to read it.
            false if !main_ran => self.far_too_low,
            false => self.far_too_low.saturating_sub(2),
        };
    }

    /// Itself, as coarse as tells states apart.
    #[must_use]
    pub fn coarse(&self) -> Self {
        let frames = |frames: u8| match frames {
            0 => 0,
            1..=3 => 1,
            4..=14 => 4,
            15..=70 => 15,
            _ => 71,
        };
        Self {
            width: self.width.map(|width| width >> 11),
            silent: frames(self.silent),
            stopped: frames(self.stopped),
            since_told: self.since_told.min(20) / 20,
            since_reset: u8::from(self.since_reset > TAKING_OVER),
            low: frames(self.low),
            too_low: frames(self.too_low),
            since_low: frames(self.since_low),
            since_too_low: frames(self.since_too_low),
            far_too_low: frames(self.far_too_low),
            line_ms: self.line_ms / 20 * u16::from(self.deadman > 0),
            brown_outs: self.brown_outs.min(9),
            ..self.clone()
        }
    }
}
