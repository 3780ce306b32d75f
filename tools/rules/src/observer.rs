//! An observer who remembers what the rules need, and judges each event by it.

use lizard_core::console::word::Effect;
use lizard_core::memory::restart::Cause;

use crate::event::{Event, MS, NEVER, Time};
use crate::reports::Reports;
use crate::rule::{Broken, Rule};
use crate::servos::{Permission, Servo};
use crate::supply::Supply;

/// Numbers of the robot, and how exactly the apparatus sees it.
#[derive(Clone, Debug)]
pub struct Limits {
    /// The most cycles that a servo's pulse may change in a frame.
    pub leap: [u32; 4],
    /// The shortest and the longest pulse of each servo, cycles.
    pub widths: [(u32, u32); 4],
    /// Below these the supply forbids writing, moving and pulses, mV.
    pub levels: [u32; 3],
    /// The error of the robot's own measurement of the supply, mV: a step of the converter and
    /// two decimals.
    pub exact: u32,
    /// The rest of the frame under way when a line is answered.
    pub frame_left: Time,
    /// The longest time from a fault to its report on the console.
    pub until_told: Time,
    /// True if `boot` ends the pulses.
    pub boots_to_rest: bool,
    /// True if the memory keeps what is written to it.
    pub keeps_memory: bool,
    /// True if a brown-out may clear RAM.
    pub brown_outs_forget: bool,
    /// True if the saved travel is narrower than the one in use.
    pub is_narrowed: bool,
}

impl Default for Limits {
    /// The limits of a robot that is seen exactly, between its frames.
    fn default() -> Self {
        Self {
            leap: [u32::MAX; 4],
            widths: [(1_000, 63_000); 4],
            levels: [0; 3],
            exact: 40,
            frame_left: MS,
            until_told: 60 * MS - 1,
            boots_to_rest: false,
            keeps_memory: true,
            brown_outs_forget: false,
            is_narrowed: false,
        }
    }
}

/// An observer of a robot.
#[derive(Clone, Debug)]
pub struct Observer {
    /// Numbers of the robot.
    pub limits: Limits,
    pub(crate) broken: Vec<Broken>,
    pub(crate) now: Time,
    pub(crate) start: Time,
    pub(crate) cause: Cause,
    pub(crate) cut: Time,
    /// The end of the last disturbance.
    pub(crate) disturbed: Time,
    pub(crate) stalls: Vec<(Time, Time)>,
    /// When the last order came that was not refused.
    pub(crate) ordered: Time,
    /// When the last `rest` came that was not refused.
    pub(crate) sent_to_rest: Time,
    /// When `boot` said that the robot rests.
    pub(crate) booted_to_rest: Time,
    pub(crate) lines: i32,
    pub(crate) last_line: Time,
    pub(crate) last_byte: Time,
    pub(crate) deadman: Time,
    pub(crate) is_unsaved: bool,
    pub(crate) permission: Permission,
    pub(crate) servos: [Servo; 4],
    pub(crate) last_begin: (Time, bool),
    pub(crate) is_silence_judged: bool,
    pub(crate) supply: Supply,
    pub(crate) reports: Reports,
    pub(crate) pending: Pending,
    /// The first of several `rest`.
    pub(crate) rested: Time,
    pub(crate) brown_outs: [Time; 5],
}

/// Promises of answers that are to be kept soon.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pending {
    /// All servos have pulses by then.
    pub moves: Option<(Time, Time, [bool; 4])>,
    /// No servo has pulses in this time.
    pub quiet: Option<(Time, Time, Rule)>,
    /// Pulses by then, or status ought to have told why not.
    pub status: Option<(Time, String)>,
    /// Nothing is written to the memory until then.
    pub unwritten: Option<Time>,
}

impl Observer {
    /// An observer of a robot whose power is still off.
    #[must_use]
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            broken: Vec::new(),
            now: NEVER,
            start: NEVER,
            cause: Cause::Power,
            cut: NEVER,
            disturbed: NEVER,
            stalls: Vec::new(),
            ordered: NEVER,
            sent_to_rest: NEVER,
            booted_to_rest: NEVER,
            lines: 0,
            last_line: NEVER,
            last_byte: NEVER,
            deadman: 0,
            is_unsaved: false,
            permission: Permission::default(),
            servos: [Servo::UNKNOWN; 4],
            last_begin: (NEVER, false),
            is_silence_judged: true,
            supply: Supply::default(),
            reports: Reports::default(),
            pending: Pending::default(),
            rested: NEVER,
            brown_outs: [NEVER; 5],
        }
    }

    /// Takes the first rule that was broken since the last call.
    ///
    /// # Errors
    /// The broken rule.
    pub fn verdict(&mut self) -> Result<(), Broken> {
        let mut broken = std::mem::take(&mut self.broken);
        if broken.is_empty() {
            Ok(())
        } else {
            Err(broken.swap_remove(0))
        }
    }

    /// Takes every broken rule.
    pub fn take_broken(&mut self) -> Vec<Broken> {
        std::mem::take(&mut self.broken)
    }

    pub(crate) fn fail(&mut self, rule: Rule, seen: impl Into<String>) {
        self.broken.push(Broken::new(rule, seen));
    }

    /// True while lines wait for their answers.
    #[must_use]
    pub const fn owes_answers(&self) -> bool {
        self.lines > 0
    }

    /// True while nothing allows pulses.
    #[must_use]
    pub const fn rests(&self) -> bool {
        !self.permission.may
    }

    /// Since when a fault stops the robot.
    #[must_use]
    pub const fn stopped_since(&self) -> Option<Time> {
        self.reports.stopped
    }

    /// True while a stop is not on the console.
    #[must_use]
    pub const fn is_untold(&self) -> bool {
        self.reports.stopped.is_some() && !self.reports.is_told
    }

    /// True if the supply was below a level, 0 for writing to 2 for pulses, within this time.
    #[must_use]
    pub fn was_low(&self, level: usize, within: Time) -> bool {
        let mv = self.limits.levels[level];
        self.supply.low_for(mv, self.now - within, self.now + 1) > 0
    }

    /// The time in which the last promise of an answer is to be kept.
    #[must_use]
    pub fn due_in(&self) -> Option<Time> {
        let pending = &self.pending;
        let ends = [
            pending.moves.map(|(_, until, _)| until),
            pending.quiet.map(|(_, until, _)| until),
            pending.status.as_ref().map(|(until, _)| *until),
            pending.unwritten,
        ];
        ends.into_iter().flatten().max().map(|end| end - self.now)
    }

    /// Forgets promises of answers whose time has not come.
    pub fn drop_pending(&mut self) {
        self.pending = Pending::default();
    }

    /// True since this long without a reset.
    #[must_use]
    pub const fn runs_for(&self) -> Time {
        self.now - self.start
    }

    /// True if anything but the robot itself may have ended pulses since then.
    pub(crate) fn is_troubled(&self, since: Time) -> bool {
        let rest = self.limits.levels[2] + self.limits.exact;
        self.start >= since
            || self.cut >= since
            || self.disturbed > since
            || self.supply.low_for(rest, since - 400 * MS, self.now) > 0
    }

    /// Judges an event.
    pub fn observe(&mut self, at: Time, event: Event<'_>) {
        self.advance(at);
        match event {
            Event::Pass => {}
            Event::Start(cause) => self.program_starts(cause),
            Event::Cut => self.cut = at,
            Event::Stalled(until) => {
                self.disturbed = self.disturbed.max(until);
                self.stalls.retain(|(_, end)| at - end < 300 * MS);
                self.stalls.push((at, until));
                self.is_disturbed();
            }
            Event::HeldUp(until) => {
                self.disturbed = self.disturbed.max(until);
                self.is_disturbed();
                for servo in &mut self.servos {
                    servo.miss_pulses(until);
                }
            }
            Event::Supply(mv) => {
                let poor = self.limits.levels[0] + crate::supply::WELL_ABOVE;
                self.supply.set(at, mv, poor);
            }
            Event::Byte => {
                self.last_byte = at;
                self.permission.boot = None;
            }
            Event::Line => {
                self.lines += 1;
                self.last_line = at;
            }
            Event::Order { effect, done } => self.order(effect, done),
            Event::Calibrated { saved } => {
                self.is_unsaved = !saved;
                if !saved {
                    for servo in &mut self.servos {
                        servo.is_calibrated = true;
                    }
                }
            }
            Event::Answer {
                line,
                effect,
                asked,
                text,
            } => self.answer(line, effect, asked, text),
            Event::Unanswered(asked, line) => {
                if !self.is_troubled(asked - MS) {
                    self.fail(Rule::Answered, format!("no answer to {line}"));
                }
            }
            Event::Said(since, line) => self.said(since, line),
            Event::Pulse(pulse) => self.pulse(pulse),
            Event::Written => self.written(),
            Event::Fault => self.reports.stop(at),
        }
    }

    /// Time passes: what was due by now is judged.
    fn advance(&mut self, at: Time) {
        self.now = self.now.max(at);
        self.permission.advance(self.now);
        self.check_silence();
        self.check_pending();
        let stop = self.limits.levels[1].saturating_sub(self.limits.exact);
        let low = self.now - 280 * MS;
        let calm = low > self.start && self.disturbed < low;
        if self.reports.stopped.is_none() && calm && self.supply.is_low_since(stop, low) {
            self.reports.stop(self.now);
        }
    }

    fn is_disturbed(&mut self) {
        self.permission.cancel_order();
        self.pending.moves = None;
        self.pending.quiet = None;
        self.pending.status = None;
    }

    fn program_starts(&mut self, cause: Cause) {
        let at = self.now;
        let is_hung = cause == Cause::Watchdog || self.disturbed > at - 300 * MS;
        self.check_reset(cause);
        for servo in 0..4 {
            let rests = self.outlasts_a_rest(servo);
            let takes_over = cause != Cause::Power && !self.limits.is_narrowed;
            let is_lost = match cause {
                Cause::BrownOut => self.limits.brown_outs_forget && !is_hung,
                cause => cause == Cause::Power,
            };
            self.servos[servo].is_lost |= is_lost;
            self.servos[servo].restart(is_hung, self.permission.may, takes_over, rests);
        }
        self.start = at;
        self.cause = cause;
        self.lines = 0;
        self.last_line = at;
        self.deadman = 0;
        self.rested = NEVER;
        self.permission.start(cause, at, self.limits.boots_to_rest);
        let keeps = matches!(self.pending.quiet, Some((.., Rule::RestEnds)));
        let quiet = self
            .pending
            .quiet
            .filter(|_| keeps && cause != Cause::Power);
        self.pending = Pending {
            quiet,
            ..Pending::default()
        };
        self.reports.start(cause, at);
    }

    /// For how long main was stalled in the last 300 ms; several short stalls may add up.
    pub(crate) fn stalled(&self, at: Time) -> Time {
        let recent = self.stalls.iter().filter(|(_, end)| *end > at - 300 * MS);
        recent.map(|(start, end)| end.min(&at) - start).sum()
    }

    fn check_reset(&mut self, cause: Cause) {
        let at = self.now;
        if cause == Cause::Watchdog {
            let stalled = self.stalled(at);
            // The watchdog's first stage, less the frame in which it was fed. That stage
            // ends the pulses, and then the reset is waited for.
            if stalled < 100 * MS {
                let ms = stalled / MS;
                self.fail(Rule::NeedlessReset, format!("stalled for {ms} ms"));
            }
        }
        if cause == Cause::BrownOut {
            let first = self.brown_outs[0];
            if first > at - 4_000 * MS && self.ordered < first {
                let ms = (at - first) / MS;
                self.fail(Rule::BrownOuts, format!("six of them in {ms} ms"));
            }
            self.brown_outs.rotate_left(1);
            self.brown_outs[4] = at;
        }
    }

    fn order(&mut self, effect: Effect, done: Option<bool>) {
        self.pending.moves = None;
        if done == Some(false) {
            return;
        }
        self.ordered = self.now;
        self.pending = Pending::default();
        let is_rest = effect == Effect::Rests;
        if is_rest {
            self.sent_to_rest = self.now;
            for servo in &mut self.servos {
                servo.released();
            }
        } else {
            self.rested = NEVER;
        }
        if effect == Effect::Moves {
            self.reports.order();
        }
        let calm = self.disturbed <= self.now;
        self.permission
            .order(self.now, effect, done.is_some() && calm);
    }
}
