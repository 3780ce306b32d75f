//! The rules for pulses: the permission to begin, and the distance from one pulse to the next.

use lizard_core::console::word::Effect;
use lizard_core::memory::restart::Cause;

use crate::event::{MS, NEVER, Pulse, Time};
use crate::observer::Observer;
use crate::rule::Rule;

/// Longest time from one pulse of a servo to its next while the servo gets a pulse in every frame.
const MAX_PULSE_GAP: Time = 30 * MS;

/// Longest time for which a gait may go on after `deadman` has run out.
const MAX_LATE_TIME: Time = 40 * MS;

/// Largest difference of consecutive pulses of a servo that stands still, cycles.
const STEADY_CYCLES: u32 = 16;

/// Longest time from a `rest` order to the end of the last pulse.
const UNTIL_REST: Time = 45 * MS;

/// Shortest time from a reset until `boot` acts: 3 s, less about a frame, since the first tick comes
/// early.
const BOOT_TIME: Time = 2_975 * MS;

/// Shortest time between the first pulses of two servos that wake: 0.1 s, less about a frame.
const MIN_WAKE_GAP: Time = 75 * MS;

/// Longest time from the end of the pulses to the reset after a hang: the watchdog's second stage and a
/// frame.
const UNTIL_RESET: Time = 160 * MS;

/// Permission for pulses to begin.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Permission {
    /// True while pulses may begin.
    pub may: bool,
    /// The time at which the permission ends, and true if an order has set this time; `None` if no end is known.
    end: Option<(Time, bool)>,
    /// The earliest time at which `boot` grants the permission; `None` if `boot` grants none.
    pub boot: Option<Time>,
}

impl Permission {
    pub(crate) fn advance(&mut self, now: Time) {
        if self.boot.take_if(|time| *time <= now).is_some() {
            self.may = true;
        }
        if self.end.take_if(|(time, _)| *time <= now).is_some() {
            self.may = false;
        }
    }

    /// Cancels the end of the permission that an order has set: another event came first, so the robot may not
    /// have carried the order out.
    pub(crate) fn cancel_order(&mut self) {
        self.end.take_if(|(_, is_order)| *is_order);
    }

    pub(crate) fn start(&mut self, cause: Cause, time: Time, boots_to_rest: bool) {
        self.cancel_order();
        self.may |= cause == Cause::Power;
        let can_boot = cause != Cause::Watchdog && !boots_to_rest;
        self.boot = can_boot.then_some(time + BOOT_TIME);
    }

    pub(crate) fn order(&mut self, time: Time, effect: Effect, is_sure: bool) {
        self.cancel_order();
        match effect {
            Effect::Rests if is_sure => self.end = Some((time + UNTIL_REST, true)),
            Effect::Moves => {
                self.may = true;
                self.end = None;
            }
            _ => {}
        }
    }

    pub(crate) fn note_boot(&mut self, time: Time, boot: &str) {
        if boot == "rest" {
            self.end(time);
        } else {
            self.may = true;
        }
    }

    pub(crate) const fn end(&mut self, time: Time) {
        self.end = Some((time + UNTIL_REST, false));
    }

    pub(crate) const fn ends(&self) -> bool {
        self.end.is_some()
    }
}

/// The event since a servo's last whole pulse that decides which leap the next pulse may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Since {
    /// No event: a leap breaks the slew limit.
    Nothing,
    /// A reset that kept the RAM, while the robot had pulses.
    Reset,
    /// A reset while the robot rested.
    ResetInRest,
    /// The servo's position is unknown.
    Unknown,
}

/// A servo's last pulses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Servo {
    /// The start of the last pulse.
    pub at: Time,
    /// The end of the last pulse.
    pub end: Time,
    /// The width of the last whole pulse.
    pub width: u32,
    /// The start of the last whole pulse.
    pub whole_at: Time,
    pub since: Since,
    /// True if a hang interrupted the pulses.
    pub is_hung: bool,
    /// True if the robot has forgotten the servo's position in a reset.
    pub is_lost: bool,
    /// True if the servo's settings have changed since its last whole pulse.
    pub is_calibrated: bool,
    /// The time up to which interrupts are blocked, so that pulses may be missing.
    held_up: Time,
}

impl Servo {
    pub(crate) const UNKNOWN: Self = Self {
        at: NEVER,
        end: NEVER,
        width: 0,
        whole_at: NEVER,
        since: Since::Unknown,
        is_hung: false,
        is_lost: false,
        is_calibrated: false,
        held_up: NEVER,
    };

    /// Notes that pulses may be missing up to a time, since interrupts are blocked.
    pub(crate) fn miss_pulses(&mut self, until: Time) {
        self.held_up = until;
        if self.since == Since::Nothing {
            self.since = Since::Unknown;
        }
    }

    /// Drops the rule that a reset sets for the next pulse, since an order to rest replaces it.
    pub(crate) fn forget_pulse(&mut self) {
        if self.since == Since::Reset {
            self.since = Since::Unknown;
        }
    }

    /// Notes a restart. The arguments are true if the program hung before the restart; if pulses were allowed; if
    /// the robot takes over the servo's position from RAM; and if the rest pose in the EEPROM is still valid.
    pub(crate) fn restart(
        &mut self,
        is_hung: bool,
        was_allowed: bool,
        takes_over: bool,
        outlasts_rest: bool,
    ) {
        self.is_hung |= is_hung;
        self.since = match self.since {
            Since::Nothing if !was_allowed && outlasts_rest => Since::ResetInRest,
            Since::Nothing | Since::Reset if was_allowed && takes_over => Since::Reset,
            Since::ResetInRest => Since::ResetInRest,
            Since::Reset if takes_over => Since::Reset,
            _ => Since::Unknown,
        };
    }
}

impl Observer {
    /// Judges a pulse by its width, its permission and the servo's previous pulses.
    pub(crate) fn pulse(&mut self, pulse: Pulse) {
        let now = self.now;
        let servo = self.servos[pulse.servo];
        let name = format_args!("A{}", pulse.servo + 1);
        let (min, max) = self.limits.widths[pulse.servo];
        let is_short = pulse.width < min && !pulse.is_cut;
        // A falling edge that is held up comes late, at worst with the next slot.
        let is_long = pulse.width > max && !pulse.is_held_up || pulse.width > 65_000;
        if is_short || is_long {
            let seen = format!("{name} gets {} cycles", pulse.width);
            self.fail(Rule::Travel, seen);
        }
        let is_first = now - servo.at > MAX_PULSE_GAP;
        if is_first {
            self.judge_first_pulse(pulse);
        }
        self.judge_expected_pulse(pulse.servo);
        let leap = pulse.width.abs_diff(servo.width);
        let is_whole = !pulse.is_cut && !pulse.is_held_up;
        let is_known = servo.whole_at > NEVER && !(is_first && servo.is_calibrated);
        if is_whole && is_known && leap > self.limits.leap[pulse.servo] {
            let seen = format!("{name} has {} cycles and then {}", servo.width, pulse.width);
            match servo.since {
                Since::Nothing => self.fail(Rule::Leap, seen),
                Since::Reset => self.fail(Rule::LeapByReset, seen),
                Since::ResetInRest => self.fail(Rule::RestPose, seen),
                Since::Unknown => {}
            }
        }
        if is_whole && !is_first && leap > STEADY_CYCLES {
            self.judge_silence(pulse.servo);
        }
        let servo = &mut self.servos[pulse.servo];
        servo.at = now;
        servo.end = now + Time::from(pulse.width);
        if is_whole {
            *servo = Servo {
                width: pulse.width,
                whole_at: now,
                since: if servo.held_up > now {
                    Since::Unknown
                } else {
                    Since::Nothing
                },
                is_hung: false,
                is_lost: false,
                is_calibrated: false,
                ..*servo
            };
        }
        self.is_silence_judged = false;
    }

    /// Judges a pulse that moves a servo: the last command must not be older than `deadman` allows.
    fn judge_silence(&mut self, servo: usize) {
        let silence = self.now - self.command_read;
        // For about a frame after a stall, main is late.
        let is_calm = self.disturbed + 25 * MS <= self.command_read;
        if self.is_driven && self.deadman > 0 && is_calm && silence > self.deadman + MAX_LATE_TIME {
            let (silence_ms, deadman_ms) = (silence / MS, self.deadman / MS);
            let seen = format!(
                "deadman {deadman_ms}, A{} moves after {silence_ms} ms",
                servo + 1
            );
            self.fail(Rule::Silenced, seen);
        }
    }

    /// Judges a servo's first pulse after a pause.
    fn judge_first_pulse(&mut self, pulse: Pulse) {
        let now = self.now;
        let servo = self.servos[pulse.servo];
        let name = format!("A{}", pulse.servo + 1);
        if !self.permission.may {
            self.fail(Rule::Begins, format!("{name} begins"));
        }
        // The frame that has begun is completed even if an order to rest comes in it.
        let hung_until = self.start.max(servo.whole_at);
        let is_rest_over = self.sent_to_rest > hung_until && now - self.sent_to_rest > UNTIL_REST;
        let is_after_hang = servo.is_hung
            && !servo.is_lost
            && servo.whole_at > NEVER
            && now - servo.whole_at < 1_000 * MS
            && !is_rest_over;
        let is_unordered = self.ordered < servo.whole_at;
        let leap = pulse.width.abs_diff(servo.width);
        if is_after_hang && is_unordered && !pulse.is_cut && leap > self.limits.leap[pulse.servo] {
            let seen = format!(
                "{name} had {} cycles before and {} after",
                servo.width, pulse.width
            );
            self.fail(Rule::Held, seen);
        }
        let (last_servo, last_time, was_after_hang) = self.last_begin;
        let is_soon = now - last_time < MIN_WAKE_GAP;
        let has_missed = servo.held_up > servo.at && now - servo.at <= 2 * MAX_PULSE_GAP;
        if is_soon && pulse.servo == last_servo || has_missed {
            // A late pulse has cost the servo a frame or two; this is no new wake-up.
            return;
        }
        if is_soon && !(is_after_hang && was_after_hang) {
            let ms = (now - last_time) / MS;
            self.fail(Rule::OneByOne, format!("{name}, {ms} ms after another"));
        }
        self.last_begin = (pulse.servo, now, is_after_hang);
    }

    /// Judges an unexplained end of all pulses: the program hung, so a reset must follow.
    pub(crate) fn check_silence(&mut self) {
        let Some(end) = self.servos.iter().map(|servo| servo.end).max() else {
            return;
        };
        if self.is_silence_judged || self.now - end < UNTIL_RESET + self.limits.longest_rest {
            return;
        }
        self.is_silence_judged = true;
        let [_, stop_mv, rest_mv] = self
            .limits
            .levels
            .map(|mv| mv + self.limits.supply_error_mv);
        let has_reason = self.sent_to_rest > end - 400 * MS
            || self.cut > end - 25 * MS
            || self.start > end - 25 * MS
            || self.booted_to_rest > end - 60 * MS
            || self.supply.time_below(rest_mv, end - 600 * MS, end) > 0
            // A rest within a routine is final if the supply forbids to move on, or if no line arrives.
            || self.supply.time_below(stop_mv, end, end + self.limits.longest_rest) > 0
            || self.reports.reported_at > end;
        if !has_reason {
            let ms = (self.now - end) / MS;
            self.fail(
                Rule::Silence,
                format!("no pulses for {ms} ms, and no reset"),
            );
        }
    }
}
