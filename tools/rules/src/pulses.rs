//! Rules for pulses: the times at which they may begin and must end, and the largest change in their widths.

use lizard_core::console::word::Effect;
use lizard_core::memory::restart::Cause;

use crate::event::{MS, NEVER, Pulse, Time};
use crate::observer::Observer;
use crate::rule::Rule;

/// Longest time between consecutive pulses of a servo that gets a pulse in every frame.
const MAX_PULSE_GAP: Time = 30 * MS;

/// Longest time for which a gait may continue after the `deadman` time.
const MAX_DEADMAN_DELAY: Time = 40 * MS;

/// Longest time in which the pulses change to new settings of the servos.
const MAX_SETTLING_TIME: Time = 1_000 * MS;

/// Largest width difference between consecutive pulses of a servo that stands still, cycles.
const MAX_STEADY_CHANGE: u32 = 16;

/// Longest time from a `rest` command to the end of the last pulse.
pub(crate) const MAX_TIME_TO_REST: Time = 45 * MS;

/// Shortest time from a reset to the `boot` action: 3 s minus about a frame, since the first tick comes early.
const MIN_BOOT_TIME: Time = 2_975 * MS;

/// Shortest time between the first pulses of two waking servos: 0.1 s minus about a frame.
const MIN_WAKE_GAP: Time = 75 * MS;

/// Longest time from the end of the pulses in a hang to the reset: the watchdog's second stage plus a frame.
const MAX_TIME_TO_RESET: Time = 160 * MS;

/// The permission for pulses to begin.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Permission {
    /// True while pulses may begin.
    pub is_granted: bool,
    /// The time at which the permission expires, and true if a command has set this time; `None` if the permission does
    /// not expire.
    expiry: Option<(Time, bool)>,
    /// The earliest time at which `boot` grants the permission; `None` if `boot` does not grant it.
    pub boot_grant_at: Option<Time>,
}

impl Permission {
    pub(crate) fn advance(&mut self, now: Time) {
        if self.boot_grant_at.take_if(|time| *time <= now).is_some() {
            self.is_granted = true;
        }
        if self.expiry.take_if(|(time, _)| *time <= now).is_some() {
            self.is_granted = false;
        }
    }

    /// Cancels an expiry that a command has set. Another event came first, so the robot may not have carried out the
    /// command.
    pub(crate) fn cancel_commanded_expiry(&mut self) {
        self.expiry.take_if(|(_, is_commanded)| *is_commanded);
    }

    pub(crate) fn record_start(&mut self, cause: Cause, time: Time, can_boot_to_rest: bool) {
        self.cancel_commanded_expiry();
        self.is_granted |= cause == Cause::Power;
        let can_boot = cause != Cause::Watchdog && !can_boot_to_rest;
        self.boot_grant_at = can_boot.then_some(time + MIN_BOOT_TIME);
    }

    pub(crate) fn record_motion_command(&mut self, time: Time, effect: Effect, is_certain: bool) {
        self.cancel_commanded_expiry();
        match effect {
            Effect::Rest if is_certain => self.expiry = Some((time + MAX_TIME_TO_REST, true)),
            Effect::Motion => {
                self.is_granted = true;
                self.expiry = None;
            }
            _ => {}
        }
    }

    pub(crate) fn record_boot(&mut self, time: Time, boot_action: &str) {
        if boot_action == "rest" {
            self.schedule_expiry(time);
        } else {
            self.is_granted = true;
        }
    }

    pub(crate) const fn schedule_expiry(&mut self, time: Time) {
        self.expiry = Some((time + MAX_TIME_TO_REST, false));
    }

    pub(crate) const fn has_expiry(&self) -> bool {
        self.expiry.is_some()
    }
}

/// The event since a servo's last complete pulse that selects the rule for the next change of its width.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Interruption {
    /// No event: the slew limit applies.
    Nothing,
    /// A reset that kept the RAM, while the robot had pulses.
    Reset,
    /// A reset while the robot rested.
    ResetInRest,
    /// An event after which the servo's position is unknown.
    Unknown,
}

/// The history of a servo's pulses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ServoHistory {
    /// The start of the last pulse.
    pub last_start: Time,
    /// The end of the last pulse.
    pub last_end: Time,
    /// The width of the last complete pulse, cycles. A complete pulse is neither cut short nor delayed at its end.
    pub last_complete_width: u32,
    /// The start of the last complete pulse.
    pub last_complete_pulse_start: Time,
    pub interruption: Interruption,
    /// True if a hang interrupted the pulses after the last complete pulse.
    pub was_hung: bool,
    /// True if a reset has cleared the servo's position in RAM.
    pub is_position_lost: bool,
    /// True if the servo's settings have changed since its last complete pulse.
    pub is_recalibrated: bool,
    /// The time until which interrupts are blocked, so that pulses may be missing.
    blocked_until: Time,
}

impl ServoHistory {
    pub(crate) const UNKNOWN: Self = Self {
        last_start: NEVER,
        last_end: NEVER,
        last_complete_width: 0,
        last_complete_pulse_start: NEVER,
        interruption: Interruption::Unknown,
        was_hung: false,
        is_position_lost: false,
        is_recalibrated: false,
        blocked_until: NEVER,
    };

    /// Records that interrupts are blocked until a time, so that pulses may be missing.
    pub(crate) fn record_blocked_interrupts(&mut self, until: Time) {
        self.blocked_until = until;
        if self.interruption == Interruption::Nothing {
            self.interruption = Interruption::Unknown;
        }
    }

    /// Forgets a reset: after a `rest` command, the reset's rule for the next pulse no longer applies.
    pub(crate) fn forget_reset(&mut self) {
        if self.interruption == Interruption::Reset {
            self.interruption = Interruption::Unknown;
        }
    }

    /// Records a restart. `has_hung` is true if the program hung before the restart, `keeps_position` if the robot
    /// keeps the servo's position in RAM, `is_rest_pose_saved` if the EEPROM contains the servo's current rest pose.
    pub(crate) fn record_restart(
        &mut self,
        has_hung: bool,
        were_pulses_permitted: bool,
        keeps_position: bool,
        is_rest_pose_saved: bool,
    ) {
        self.was_hung |= has_hung;
        self.interruption = match self.interruption {
            Interruption::Nothing if !were_pulses_permitted && is_rest_pose_saved => {
                Interruption::ResetInRest
            }
            Interruption::Nothing if were_pulses_permitted && keeps_position => Interruption::Reset,
            Interruption::ResetInRest => Interruption::ResetInRest,
            Interruption::Reset if keeps_position => Interruption::Reset,
            _ => Interruption::Unknown,
        };
    }
}

impl Observer {
    /// Checks a pulse's width, its permission and its difference from the servo's previous pulses.
    pub(crate) fn check_pulse(&mut self, pulse: Pulse) {
        let now = self.now;
        let servo = self.servos[pulse.servo];
        let name = format_args!("A{}", pulse.servo + 1);
        let (min, max) = self.limits.width_ranges[pulse.servo];
        let is_short = pulse.width < min && !pulse.is_cut;
        // Blocked interrupts delay a falling edge, at most until the next slot.
        let is_long = pulse.width > max && !pulse.is_end_late || pulse.width > 65_000;
        if is_short || is_long {
            let observation = format!("{name} gets a pulse of {} cycles", pulse.width);
            self.record_violation(Rule::PulseWidth, observation);
        }
        let is_first = now - servo.last_start > MAX_PULSE_GAP;
        if is_first {
            self.check_first_pulse(pulse);
        }
        self.check_pulse_promises(pulse.servo);
        let change = pulse.width.abs_diff(servo.last_complete_width);
        let is_complete = !pulse.is_cut && !pulse.is_end_late;
        // Without a reset, the first pulse after a rest repeats the last one, even with new settings.
        let is_comparable = servo.last_complete_pulse_start > NEVER
            && (servo.interruption == Interruption::Nothing || !servo.is_recalibrated);
        if is_complete && is_comparable && change > self.limits.max_change_cycles[pulse.servo] {
            let observation = format!(
                "{name} gets pulses of {} and then {} cycles",
                servo.last_complete_width, pulse.width
            );
            let rule = match servo.interruption {
                Interruption::Nothing => Some(Rule::SlewLimit),
                Interruption::Reset => Some(Rule::NoStepByReset),
                Interruption::ResetInRest => Some(Rule::WakesInRestPose),
                Interruption::Unknown => None,
            };
            if let Some(rule) = rule {
                self.record_violation(rule, observation);
            }
        }
        if is_complete && !is_first && change > MAX_STEADY_CHANGE {
            self.check_deadman(pulse.servo);
        }
        let servo = &mut self.servos[pulse.servo];
        servo.last_start = now;
        servo.last_end = now + Time::from(pulse.width);
        if is_complete {
            *servo = ServoHistory {
                last_complete_width: pulse.width,
                last_complete_pulse_start: now,
                interruption: match servo.blocked_until > now {
                    true => Interruption::Unknown,
                    false => Interruption::Nothing,
                },
                was_hung: false,
                is_position_lost: false,
                is_recalibrated: false,
                ..*servo
            };
        }
        self.is_pulse_end_checked = false;
    }

    /// Checks a pulse that moves a servo: the last command must not be older than `deadman` allows.
    fn check_deadman(&mut self, servo: usize) {
        let silence = self.now - self.last_command_read_at;
        // New settings move a servo even while the robot stands still.
        let may_settle = self.now - self.recalibrated_at < MAX_SETTLING_TIME;
        // An answer that is still missing may be that of a line that changes `deadman`.
        if self.is_gait_or_routine
            && self.deadman_time > 0
            && !self.has_unanswered_lines()
            && !may_settle
            && self.was_main_punctual_since(self.last_command_read_at)
            && silence > self.deadman_time + MAX_DEADMAN_DELAY
        {
            let (silence_ms, deadman_ms) = (silence / MS, self.deadman_time / MS);
            let observation = format!(
                "deadman {deadman_ms}, but A{} moves after {silence_ms} ms without a command",
                servo + 1
            );
            self.record_violation(Rule::DeadmanNotLate, observation);
        }
    }

    /// Checks a servo's first pulse after a pause.
    fn check_first_pulse(&mut self, pulse: Pulse) {
        let now = self.now;
        let servo = self.servos[pulse.servo];
        let name = format!("A{}", pulse.servo + 1);
        if !self.permission.is_granted {
            self.record_violation(Rule::PulsesPermitted, format!("{name} gets a pulse"));
        }
        // The frame after a hang is completed even if a `rest` command arrives within it.
        let hung_until = self.started_at.max(servo.last_complete_pulse_start);
        let has_rested =
            self.rest_command_at > hung_until && now - self.rest_command_at > MAX_TIME_TO_REST;
        let is_after_hang = servo.was_hung
            && !servo.is_position_lost
            && servo.last_complete_pulse_start > NEVER
            && now - servo.last_complete_pulse_start < 1_000 * MS
            && !has_rested;
        let has_no_command = self.last_motion_command_at < servo.last_complete_pulse_start;
        let change = pulse.width.abs_diff(servo.last_complete_width);
        if is_after_hang
            && has_no_command
            && !pulse.is_cut
            && change > self.limits.max_change_cycles[pulse.servo]
        {
            let observation = format!(
                "{name} gets pulses of {} cycles before and {} cycles after",
                servo.last_complete_width, pulse.width
            );
            self.record_violation(Rule::HeldAfterHang, observation);
        }
        let (last_servo, last_wake_at, was_after_hang) = self.last_wake;
        let is_soon = now - last_wake_at < MIN_WAKE_GAP;
        let was_blocked =
            servo.blocked_until > servo.last_start && now - servo.last_start <= 2 * MAX_PULSE_GAP;
        if is_soon && pulse.servo == last_servo || was_blocked {
            // The servo has missed a frame or two; this is not a wake-up.
            return;
        }
        if is_soon && !(is_after_hang && was_after_hang) {
            let ms = (now - last_wake_at) / MS;
            let observation = format!("{name} wakes {ms} ms after another servo");
            self.record_violation(Rule::WakeOneByOne, observation);
        }
        self.last_wake = (pulse.servo, now, is_after_hang);
    }

    /// Checks the end of all pulses: without another cause, the program hung, and a reset must follow.
    pub(crate) fn check_end_of_pulses(&mut self) {
        let ends = self.servos.map(|servo| servo.last_end);
        let end = ends.into_iter().fold(NEVER, Time::max);
        let max_pause = MAX_TIME_TO_RESET + self.limits.max_routine_rest;
        if self.is_pulse_end_checked || self.now - end < max_pause {
            return;
        }
        self.is_pulse_end_checked = true;
        let error_mv = self.limits.supply_error_mv;
        let [_, stop_mv, rest_mv] = self.limits.levels_mv.map(|mv| mv + error_mv);
        let has_reason = self.rest_command_at > end - 400 * MS
            || self.cut_at > end - 25 * MS
            || self.started_at > end - 25 * MS
            || self.boot_rest_at > end - 60 * MS
            || self.supply.time_below(rest_mv, end - 600 * MS, end) > 0
            // A rest during a routine does not end if the supply forbids motions or if no line arrives.
            || self.supply.time_below(stop_mv, end, end + self.limits.max_routine_rest) > 0
            || self.stop_report.reported_at.is_some_and(|time| time > end);
        if !has_reason {
            let ms = (self.now - end) / MS;
            let observation = format!("no pulses for {ms} ms, and no reset");
            self.record_violation(Rule::ResetAfterHang, observation);
        }
    }
}
