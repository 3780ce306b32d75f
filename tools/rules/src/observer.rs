//! The observer: records the history that the rules need, and judges each event.

use lizard_core::console::word::Effect;
use lizard_core::memory::restart::Cause;

use crate::event::{Event, MS, NEVER, Pulse, Time};
use crate::reports::Reports;
use crate::rule::{BrokenRule, Rule};
use crate::servos::{Permission, Servo};
use crate::supply::Supply;

/// The robot's limits, and the precision with which the test apparatus observes it.
#[derive(Clone, Debug)]
pub struct Limits {
    /// The largest change of a servo's pulse from one frame to the next, cycles.
    pub leap: [u32; 4],
    /// The shortest and the longest pulse of each servo, cycles.
    pub widths: [(u32, u32); 4],
    /// Levels below which the supply forbids writing, moving and pulses, mV.
    pub levels: [u32; 3],
    /// The largest error of the robot's own measurement of the supply, mV: one step of the
    /// converter, and the rounding to two decimals.
    pub supply_error_mv: u32,
    /// The longest time that remains of the current frame when a line has been answered.
    pub frame_left: Time,
    /// The longest time from a fault to its report on the console.
    pub report_time: Time,
    /// The longest time for which a line of the robot waits behind other lines before it is printed.
    pub queued: Time,
    /// The longest rest that a routine contains as a step; 0 if no routine rests.
    pub longest_rest: Time,
    /// True if the robot's `boot` setting may be `rest`.
    pub boots_to_rest: bool,
    /// True if the EEPROM keeps what is written to it.
    pub keeps_memory: bool,
    /// True if a brown-out may clear RAM.
    pub brown_outs_clear_ram: bool,
    /// True if the saved travel may be narrower than the travel in use.
    pub is_narrowed: bool,
}

impl Default for Limits {
    /// The limits of a robot that is observed exactly, between its frames.
    fn default() -> Self {
        Self {
            leap: [u32::MAX; 4],
            widths: [(1_000, 63_000); 4],
            levels: [0; 3],
            supply_error_mv: 40,
            frame_left: MS,
            report_time: 60 * MS - 1,
            queued: 0,
            longest_rest: 0,
            boots_to_rest: false,
            keeps_memory: true,
            brown_outs_clear_ram: false,
            is_narrowed: false,
        }
    }
}

/// An observer that judges a robot's events by the rules.
#[derive(Clone, Debug)]
pub struct Observer {
    /// The robot's limits.
    pub limits: Limits,
    pub(crate) broken: Vec<BrokenRule>,
    pub(crate) now: Time,
    pub(crate) start: Time,
    pub(crate) cause: Cause,
    pub(crate) cut: Time,
    /// The end of the last disturbance: a stall of main, or blocked interrupts.
    pub(crate) disturbed: Time,
    pub(crate) stalls: Vec<(Time, Time)>,
    /// Time of the last order that was not refused.
    pub(crate) ordered: Time,
    /// Time of the last `rest` that was not refused.
    pub(crate) sent_to_rest: Time,
    /// Time at which `boot` reported that the robot rests.
    pub(crate) booted_to_rest: Time,
    pub(crate) lines: i32,
    pub(crate) last_line: Time,
    pub(crate) last_byte: Time,
    pub(crate) deadman: Time,
    /// The latest time at which the last command may have been read.
    pub(crate) command_read: Time,
    /// True if the last motion is a gait or a routine, which `deadman` ends.
    pub(crate) is_driven: bool,
    pub(crate) is_unsaved: bool,
    /// Number of motions begun since the last reset, less the number reported as done.
    pub(crate) unfinished_motions: i32,
    pub(crate) permission: Permission,
    pub(crate) servos: [Servo; 4],
    pub(crate) last_begin: (usize, Time, bool),
    pub(crate) is_silence_judged: bool,
    pub(crate) supply: Supply,
    pub(crate) reports: Reports,
    pub(crate) pending: Pending,
    /// Time of the first of consecutive `rest` commands; `NEVER` after any other order.
    pub(crate) first_rest_command: Time,
    pub(crate) brown_outs: [Time; 5],
}

/// Promises of the robot's answers that are not due yet.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pending {
    /// Start and end of the time in which each servo must get a pulse; true for each servo that got one.
    pub moves: Option<(Time, Time, [bool; 4])>,
    /// Start and end of the time in which no pulse may begin, and the rule that forbids it.
    pub quiet: Option<(Time, Time, Rule)>,
    /// The time by which there must be a pulse, and the answer to `status` that gave no reason for
    /// a lack of pulses.
    pub status: Option<(Time, String)>,
    /// The time until which no byte of the EEPROM may be written.
    pub unwritten: Option<Time>,
}

impl Observer {
    /// An observer of a robot whose power is still off.
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
            command_read: NEVER,
            is_driven: false,
            is_unsaved: false,
            unfinished_motions: 0,
            permission: Permission::default(),
            servos: [Servo::UNKNOWN; 4],
            last_begin: (0, NEVER, false),
            is_silence_judged: true,
            supply: Supply::default(),
            reports: Reports::default(),
            pending: Pending::default(),
            first_rest_command: NEVER,
            brown_outs: [NEVER; 5],
        }
    }

    /// Observes a frame's pulses and its end; `widths` are the pulse widths of A1 to A4 in cycles, 0 for no pulse.
    pub fn observe_frame(&mut self, start: Time, widths: [u16; 4]) {
        for (servo, width) in widths
            .into_iter()
            .enumerate()
            .filter(|(_, width)| *width > 0)
        {
            let pulse = Pulse {
                servo,
                width: width.into(),
                is_cut: false,
                is_held_up: false,
            };
            // Nominal times, to about a millisecond: A1's pulse begins 4 ms after the tick, each further servo's
            // pulse one slot of 4 ms later.
            self.observe(start + (5 + 4 * servo as Time) * MS, Event::Pulse(pulse));
        }
        self.observe(start + 20 * MS, Event::Pass);
    }

    /// Returns `Ok` if no rule was broken since the last call; forgets all broken rules.
    ///
    /// # Errors
    /// Returns the rule that was broken first.
    pub fn verdict(&mut self) -> Result<(), BrokenRule> {
        let mut broken = std::mem::take(&mut self.broken);
        if broken.is_empty() {
            Ok(())
        } else {
            Err(broken.swap_remove(0))
        }
    }

    /// Returns all rules that were broken since the last call, and forgets them.
    pub fn take_broken(&mut self) -> Vec<BrokenRule> {
        std::mem::take(&mut self.broken)
    }

    pub(crate) fn fail(&mut self, rule: Rule, seen: impl Into<String>) {
        self.broken.push(BrokenRule::new(rule, seen));
    }

    /// True while the robot has not answered every line.
    pub const fn has_unanswered_lines(&self) -> bool {
        self.lines > 0
    }

    /// True while the robot has no permission to begin pulses.
    pub const fn rests(&self) -> bool {
        !self.permission.may
    }

    /// The time at which a fault stopped the robot; `None` if no fault did, or if an order has ended the stop.
    pub const fn stopped_since(&self) -> Option<Time> {
        self.reports.stopped
    }

    /// True from a stop until the console reports it.
    pub const fn is_unreported(&self) -> bool {
        self.reports.stopped.is_some() && !self.reports.is_reported
    }

    /// True if the supply was below a level within the last `within` cycles. `level` is 0 for writing, 1 for moving,
    /// 2 for pulses.
    pub fn was_low(&self, level: usize, within: Time) -> bool {
        let mv = self.limits.levels[level];
        self.supply.time_below(mv, self.now - within, self.now + 1) > 0
    }

    /// The time until the last pending promise is due; `None` if no promise is pending.
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

    /// Drops all pending promises.
    pub fn drop_pending(&mut self) {
        self.pending = Pending::default();
    }

    /// The time since the last reset.
    pub const fn runs_for(&self) -> Time {
        self.now - self.start
    }

    /// True if a cause outside the firmware may have ended the pulses since this time: a reset, a stall, blocked
    /// interrupts or a low supply.
    pub(crate) fn is_troubled(&self, since: Time) -> bool {
        let rest_mv = self.limits.levels[2] + self.limits.supply_error_mv;
        self.start >= since
            || self.cut >= since
            || self.disturbed > since
            || self.supply.time_below(rest_mv, since - 400 * MS, self.now) > 0
    }

    /// Judges an event.
    pub fn observe(&mut self, time: Time, event: Event<'_>) {
        self.advance(time);
        match event {
            Event::Pass => {}
            Event::Start(cause) => self.note_program_start(cause),
            Event::Cut => self.cut = time,
            Event::Stalled(until) => {
                self.disturbed = self.disturbed.max(until);
                self.stalls.retain(|(_, end)| time - end < 300 * MS);
                self.stalls.push((time, until));
                self.cancel_promises();
            }
            Event::HeldUp(until) => {
                self.disturbed = self.disturbed.max(until);
                self.cancel_promises();
                for servo in &mut self.servos {
                    servo.miss_pulses(until);
                }
            }
            Event::Supply(mv) => {
                let poor_below_mv = self.limits.levels[0] + crate::supply::GOOD_ABOVE;
                self.supply.set(time, mv, poor_below_mv);
            }
            Event::Byte => {
                self.last_byte = time;
                self.permission.boot = None;
            }
            Event::Line { is_command } => {
                self.lines += 1;
                if is_command {
                    self.last_line = time;
                    self.command_read = time;
                }
            }
            Event::Order { effect, done } => self.note_order(effect, done),
            Event::Calibrated { is_saved } => {
                self.is_unsaved = !is_saved;
                if !is_saved {
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
            Event::Printed(since, line) => self.judge_line(since, line),
            Event::Pulse(pulse) => self.pulse(pulse),
            Event::Written => self.judge_write(),
            Event::Fault => self.reports.stop(time),
        }
    }

    /// Advances the time, and judges every promise that was due by now.
    fn advance(&mut self, time: Time) {
        self.now = self.now.max(time);
        self.permission.advance(self.now);
        self.check_silence();
        self.check_pending();
        let stop_mv = self.limits.levels[1].saturating_sub(self.limits.supply_error_mv);
        let low_since = self.now - 280 * MS;
        let is_calm = low_since > self.start && self.disturbed < low_since;
        if self.reports.stopped.is_none() && is_calm && self.supply.is_low_since(stop_mv, low_since)
        {
            self.reports.stop(self.now);
        }
    }

    fn cancel_promises(&mut self) {
        self.permission.cancel_order();
        self.pending.moves = None;
        self.pending.quiet = None;
        self.pending.status = None;
    }

    fn note_program_start(&mut self, cause: Cause) {
        let now = self.now;
        // A brown-out may last long, and the program may have hung before it.
        let ran_until = if cause == Cause::BrownOut {
            self.cut.max(self.start)
        } else {
            now
        };
        let is_hung = cause == Cause::Watchdog || self.disturbed > ran_until - 300 * MS;
        self.check_reset(cause);
        for servo in 0..4 {
            let outlasts_rest = self.must_keep_rest_pose(servo);
            let takes_over = cause != Cause::Power && !self.limits.is_narrowed;
            let is_lost = match cause {
                Cause::BrownOut => self.limits.brown_outs_clear_ram && !is_hung,
                cause => cause == Cause::Power,
            };
            self.servos[servo].is_lost |= is_lost;
            self.servos[servo].restart(is_hung, self.permission.may, takes_over, outlasts_rest);
        }
        self.start = now;
        self.cause = cause;
        self.lines = 0;
        self.last_line = now;
        self.deadman = 0;
        self.is_driven = false;
        self.first_rest_command = NEVER;
        self.unfinished_motions = 0;
        self.permission.start(cause, now, self.limits.boots_to_rest);
        let is_rest_promised = matches!(self.pending.quiet, Some((.., Rule::RestEnds)));
        let quiet = self
            .pending
            .quiet
            .filter(|_| is_rest_promised && cause != Cause::Power);
        self.pending = Pending {
            quiet,
            ..Pending::default()
        };
        self.reports.start(cause, now);
    }

    /// The total time for which main was stalled in the 300 ms before `time`.
    pub(crate) fn stalled(&self, time: Time) -> Time {
        let recent = self.stalls.iter().filter(|(_, end)| *end > time - 300 * MS);
        recent.map(|(start, end)| end.min(&time) - start).sum()
    }

    fn check_reset(&mut self, cause: Cause) {
        let now = self.now;
        if cause == Cause::Watchdog {
            let stalled_time = self.stalled(now);
            // The watchdog's first stage, less the frame in which the watchdog was fed. At the end of
            // the first stage the pulses end; the reset follows in the second stage.
            if stalled_time < 100 * MS {
                let ms = stalled_time / MS;
                self.fail(Rule::NeedlessReset, format!("stalled for {ms} ms"));
            }
        }
        if cause == Cause::BrownOut {
            let first_brown_out = self.brown_outs[0];
            if first_brown_out > now - 4_000 * MS && self.ordered < first_brown_out {
                let ms = (now - first_brown_out) / MS;
                self.fail(Rule::BrownOuts, format!("six of them in {ms} ms"));
            }
            self.brown_outs.rotate_left(1);
            self.brown_outs[4] = now;
        }
    }

    fn note_order(&mut self, effect: Effect, done: Option<bool>) {
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
                servo.forget_pulse();
            }
        } else {
            self.first_rest_command = NEVER;
        }
        if effect == Effect::Moves {
            self.reports.order(done.is_some());
            self.unfinished_motions += 1;
        }
        let is_calm = self.disturbed <= self.now;
        self.permission
            .order(self.now, effect, done.is_some() && is_calm);
    }
}
