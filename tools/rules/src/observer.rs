//! The observer, which records the history that the rules need and checks each event.

use lizard_core::console::word::Effect;
use lizard_core::memory::restart::Cause;

use crate::event::{Event, MS, NEVER, Pulse, Time};
use crate::limits::Limits;
use crate::pulses::{MAX_TIME_TO_REST, Permission, ServoHistory};
use crate::reports::StopReport;
use crate::rule::{Rule, Violation};
use crate::supply::SupplyHistory;

/// An observer that checks a robot's events against the rules.
#[derive(Clone, Debug)]
pub struct Observer {
    /// The robot's limits.
    pub limits: Limits,
    pub(crate) violations: Vec<Violation>,
    pub(crate) now: Time,
    pub(crate) started_at: Time,
    pub(crate) start_cause: Cause,
    /// The time at which the program was last interrupted: RESET was pulled low, or power was lost.
    pub(crate) cut_at: Time,
    /// End of the last disturbance: a stall of the main loop, or blocked interrupts.
    pub(crate) disturbed_until: Time,
    /// Start and end of each recent stall of the main loop.
    pub(crate) stalls: Vec<(Time, Time)>,
    /// The time of the last motion, stop or rest command that was not refused.
    pub(crate) last_motion_command_at: Time,
    /// The time of the last `rest` that was not refused.
    pub(crate) rest_command_at: Time,
    /// The time at which `boot` reported that the robot rests.
    pub(crate) boot_rest_at: Time,
    pub(crate) unanswered_line_count: i32,
    pub(crate) last_command_at: Time,
    /// True if the main loop was late when the last command arrived.
    pub(crate) was_command_delayed: bool,
    /// The `deadman` time; 0 if it is off or not known.
    pub(crate) deadman_time: Time,
    /// The latest time at which the last command may have been read.
    pub(crate) last_command_read_at: Time,
    /// True if the last motion is one that `deadman` ends: a gait other than `stand`, or a routine.
    pub(crate) is_gait_or_routine: bool,
    pub(crate) has_unsaved_settings: bool,
    /// The time of the last change of the servos' settings.
    pub(crate) recalibrated_at: Time,
    /// The number of motions begun since the last reset, minus the number of motions reported as done.
    pub(crate) unfinished_motion_count: i32,
    pub(crate) permission: Permission,
    pub(crate) servos: [ServoHistory; 4],
    /// The servo that woke last, the time of its first pulse, and true if a hang had interrupted its pulses.
    pub(crate) last_wake: (usize, Time, bool),
    pub(crate) is_pulse_end_checked: bool,
    pub(crate) supply: SupplyHistory,
    pub(crate) stop_report: StopReport,
    pub(crate) pending_promises: PendingPromises,
    /// The time of the first of consecutive `rest` commands; `NEVER` after any other command.
    pub(crate) first_rest_at: Time,
    pub(crate) brown_out_times: [Time; 5],
}

/// Promises in the robot's answers that are not due yet.
#[derive(Clone, Debug, Default)]
pub(crate) struct PendingPromises {
    /// Start and end of the time in which every servo must get a pulse, and true for each servo that has got a pulse.
    pub motion: Option<(Time, Time, [bool; 4])>,
    /// Start and end of the time in which no pulse may begin, and the rule that forbids pulses.
    pub no_pulses: Option<(Time, Time, Rule)>,
    /// The time by which a pulse must begin, and the answer to `status` that named no cause for missing pulses.
    pub pulses_after_status: Option<(Time, String)>,
    /// The time before which no byte of the EEPROM may be written.
    pub no_writes_until: Option<Time>,
}

impl Observer {
    /// Returns an observer of a robot whose power is still off.
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            violations: Vec::new(),
            now: NEVER,
            started_at: NEVER,
            start_cause: Cause::Power,
            cut_at: NEVER,
            disturbed_until: NEVER,
            stalls: Vec::new(),
            last_motion_command_at: NEVER,
            rest_command_at: NEVER,
            boot_rest_at: NEVER,
            unanswered_line_count: 0,
            last_command_at: NEVER,
            was_command_delayed: false,
            deadman_time: 0,
            last_command_read_at: NEVER,
            is_gait_or_routine: false,
            has_unsaved_settings: false,
            recalibrated_at: NEVER,
            unfinished_motion_count: 0,
            permission: Permission::default(),
            servos: [ServoHistory::UNKNOWN; 4],
            last_wake: (0, NEVER, false),
            is_pulse_end_checked: true,
            supply: SupplyHistory::default(),
            stop_report: StopReport::default(),
            pending_promises: PendingPromises::default(),
            first_rest_at: NEVER,
            brown_out_times: [NEVER; 5],
        }
    }

    /// Observes the pulses of a frame and the frame's end. `widths` are the pulse widths of A1 to A4 in cycles, 0 for
    /// no pulse.
    pub fn observe_frame(&mut self, start: Time, widths: [u16; 4]) {
        let servo_widths = widths.into_iter().enumerate();
        for (servo, width) in servo_widths.filter(|(_, width)| *width > 0) {
            let pulse = Pulse::exact(servo, width.into());
            // These times are a millisecond late: A1's pulse begins 4 ms after the tick, and each further servo's pulse
            // one slot of 4 ms later.
            self.observe(start + (5 + 4 * servo as Time) * MS, Event::Pulse(pulse));
        }
        self.observe(start + 20 * MS, Event::TimePasses);
    }

    /// Observes a command if it moves, freezes or rests the robot. `is_accepted` is as in [`Event::MotionCommand`].
    pub fn observe_command(&mut self, time: Time, effect: Effect, is_accepted: Option<bool>) {
        if matches!(effect, Effect::Motion | Effect::Freeze | Effect::Rest) {
            let command = Event::MotionCommand {
                effect,
                is_accepted,
            };
            self.observe(time, command);
        }
    }

    /// Returns `Ok` if no rule was violated since the last call, and forgets all violations.
    ///
    /// # Errors
    /// Returns the first violation.
    pub fn take_verdict(&mut self) -> Result<(), Violation> {
        let mut violations = self.take_violations().into_iter();
        violations.next().map_or(Ok(()), Err)
    }

    /// Returns all violations since the last call, and forgets them.
    pub fn take_violations(&mut self) -> Vec<Violation> {
        std::mem::take(&mut self.violations)
    }

    /// Records a violation.
    pub(crate) fn record_violation(&mut self, rule: Rule, observation: impl Into<String>) {
        self.violations.push(Violation::new(rule, observation));
    }

    /// True while the robot has not answered every line.
    pub const fn has_unanswered_lines(&self) -> bool {
        self.unanswered_line_count > 0
    }

    /// True while the robot has no permission to begin pulses.
    pub const fn must_rest(&self) -> bool {
        !self.permission.is_granted
    }

    /// Returns the time at which a fault stopped the robot; `None` without a fault, or if a command has ended the stop.
    pub const fn stop_time(&self) -> Option<Time> {
        self.stop_report.stopped_at
    }

    /// True from a stop until the console reports it.
    pub const fn is_stop_unreported(&self) -> bool {
        self.stop_report.stopped_at.is_some() && !self.stop_report.is_reported
    }

    /// True if the supply was below a level at any time in the last `duration`. `level_index` is an index of
    /// [`Limits::levels_mv`].
    pub fn was_supply_low(&self, level_index: usize, duration: Time) -> bool {
        let mv = self.limits.levels_mv[level_index];
        let since = self.now - duration;
        self.supply.time_below(mv, since, self.now + 1) > 0
    }

    /// Returns the time until the last pending promise is due; `None` if no promise is pending.
    pub fn time_until_promises_due(&self) -> Option<Time> {
        let promises = &self.pending_promises;
        let pulses_after_status = promises.pulses_after_status.as_ref();
        let ends = [
            promises.motion.map(|(_, until, _)| until),
            promises.no_pulses.map(|(_, until, _)| until),
            pulses_after_status.map(|(until, _)| *until),
            promises.no_writes_until,
        ];
        ends.into_iter().flatten().max().map(|end| end - self.now)
    }

    /// Drops all pending promises.
    pub fn drop_pending_promises(&mut self) {
        self.pending_promises = PendingPromises::default();
    }

    /// Returns the time since the last reset.
    pub const fn time_since_start(&self) -> Time {
        self.now - self.started_at
    }

    /// True if a cause outside the firmware may have ended the pulses since the time `since`: a reset, a stall, blocked
    /// interrupts or a low supply.
    pub(crate) fn was_disturbed_since(&self, since: Time) -> bool {
        let rest_mv = self.limits.levels_mv[2] + self.limits.supply_error_mv;
        self.started_at >= since
            || self.cut_at >= since
            || self.disturbed_until > since
            || self.supply.time_below(rest_mv, since - 400 * MS, self.now) > 0
    }

    /// True if a pulse has begun since a time.
    pub fn has_pulsed_since(&self, time: Time) -> bool {
        self.servos.iter().any(|servo| servo.last_start >= time)
    }

    /// True if a pulse has begun since the robot was told to rest, or since the last reset.
    pub fn has_pulsed_since_rest(&self) -> bool {
        let rest_at = self.rest_command_at.max(self.boot_rest_at);
        self.has_pulsed_since(self.started_at.max(rest_at + MAX_TIME_TO_REST))
    }

    /// True if no stall has delayed the main loop since a time. After a stall, the loop is late for about a frame.
    pub(crate) fn was_main_punctual_since(&self, time: Time) -> bool {
        self.disturbed_until + 25 * MS <= time
    }

    /// Records an event and checks it against the rules.
    pub fn observe(&mut self, time: Time, event: Event<'_>) {
        self.advance(time);
        match event {
            Event::TimePasses => {}
            Event::ProgramStart(cause) => self.record_program_start(cause),
            Event::ProgramCut => self.cut_at = time,
            Event::MainStalled(until) => {
                self.disturbed_until = self.disturbed_until.max(until);
                self.stalls.retain(|(_, end)| time - end < 300 * MS);
                self.stalls.push((time, until));
                self.cancel_promises();
            }
            Event::InterruptsBlocked(until) => {
                self.disturbed_until = self.disturbed_until.max(until);
                self.cancel_promises();
                for servo in &mut self.servos {
                    servo.record_blocked_interrupts(until);
                }
            }
            Event::SupplyMv(mv) => self.supply.record(time, mv, self.limits.min_good_mv()),
            Event::ByteReceived => self.permission.boot_grant_at = None,
            Event::LineReceived { is_command } => {
                self.unanswered_line_count += 1;
                if is_command {
                    self.was_command_delayed = !self.was_main_punctual_since(time);
                    self.last_command_at = time;
                    self.last_command_read_at = time;
                }
            }
            Event::MotionCommand {
                effect,
                is_accepted,
            } => self.record_motion_command(effect, is_accepted),
            Event::CalibrationChanged { is_saved } => {
                self.has_unsaved_settings = !is_saved;
                if !is_saved {
                    self.recalibrated_at = time;
                    for servo in &mut self.servos {
                        servo.is_recalibrated = true;
                    }
                }
            }
            Event::Answer {
                line,
                effect,
                sent_at,
                answer,
            } => self.check_answer(line, effect, sent_at, answer),
            Event::Unanswered(sent_at, line) => {
                if !self.was_disturbed_since(sent_at - MS) {
                    self.record_violation(Rule::AnswersAgain, format!("no answer to {line}"));
                }
            }
            Event::LinePrinted(first_byte_at, line) => self.check_printed_line(first_byte_at, line),
            Event::Pulse(pulse) => self.check_pulse(pulse),
            Event::ByteWritten => self.check_eeprom_write(),
            Event::Fault => self.stop_report.record_stop(time),
        }
    }

    /// Advances the time, and checks every promise that was due by now.
    fn advance(&mut self, time: Time) {
        self.now = self.now.max(time);
        self.permission.advance(self.now);
        self.check_end_of_pulses();
        self.check_due_promises();
        let stop_mv = self.limits.levels_mv[1].saturating_sub(self.limits.supply_error_mv);
        let low_since = self.now - 280 * MS;
        let is_undisturbed = low_since > self.started_at && self.disturbed_until < low_since;
        if self.stop_report.stopped_at.is_none()
            && is_undisturbed
            && self.supply.has_been_low_since(stop_mv, low_since)
        {
            self.stop_report.record_stop(self.now);
        }
    }

    fn cancel_promises(&mut self) {
        self.permission.cancel_commanded_expiry();
        self.pending_promises.motion = None;
        self.pending_promises.no_pulses = None;
        self.pending_promises.pulses_after_status = None;
    }

    fn record_program_start(&mut self, cause: Cause) {
        let now = self.now;
        // The program counts as hung if a disturbance came shortly before it stopped. In a brown-out, which may last
        // long, it stopped when the brown-out began.
        let ran_until = match cause {
            Cause::BrownOut => self.cut_at.max(self.started_at),
            _ => now,
        };
        let has_hung = cause == Cause::Watchdog || self.disturbed_until > ran_until - 300 * MS;
        self.check_reset(cause);
        for servo in 0..4 {
            let is_rest_pose_saved = self.must_rest_pose_be_saved(servo);
            let keeps_position = cause != Cause::Power && !self.limits.can_saved_travel_be_narrower;
            let is_ram_lost = match cause {
                Cause::BrownOut => self.limits.can_brown_outs_clear_ram && !has_hung,
                cause => cause == Cause::Power,
            };
            self.servos[servo].is_position_lost |= is_ram_lost;
            self.servos[servo].record_restart(
                has_hung,
                self.permission.is_granted,
                keeps_position,
                is_rest_pose_saved,
            );
        }
        self.started_at = now;
        self.start_cause = cause;
        self.unanswered_line_count = 0;
        self.last_command_at = now;
        self.was_command_delayed = false;
        self.deadman_time = 0;
        self.is_gait_or_routine = false;
        self.first_rest_at = NEVER;
        self.unfinished_motion_count = 0;
        self.permission
            .record_start(cause, now, self.limits.can_boot_to_rest);
        let survives = |(.., rule): &(Time, Time, Rule)| {
            *rule == Rule::RestEndsPulses && cause != Cause::Power
        };
        self.pending_promises = PendingPromises {
            no_pulses: self.pending_promises.no_pulses.filter(survives),
            ..PendingPromises::default()
        };
        self.stop_report.record_start(cause, now);
    }

    /// Returns the total duration, up to `time`, of the stalls of the main loop that end after `time` minus 300 ms.
    pub(crate) fn stalled_time_before(&self, time: Time) -> Time {
        let recent = self.stalls.iter().filter(|(_, end)| *end > time - 300 * MS);
        recent.map(|(start, end)| end.min(&time) - start).sum()
    }

    fn check_reset(&mut self, cause: Cause) {
        let now = self.now;
        if cause == Cause::Watchdog {
            let stalled_time = self.stalled_time_before(now);
            // 100 ms is the first stage of the watchdog minus the frame in which the main loop last fed it. The
            // pulses end after the first stage, and the reset follows after the second stage.
            if stalled_time < 100 * MS {
                let observation = format!("main was stalled for only {} ms", stalled_time / MS);
                self.record_violation(Rule::NoNeedlessReset, observation);
            }
        }
        if cause == Cause::Power {
            // The robot's count of brown-outs is lost, too.
            self.brown_out_times = [NEVER; 5];
        }
        if cause == Cause::BrownOut {
            let first_brown_out = self.brown_out_times[0];
            if first_brown_out > now - 4_000 * MS && self.last_motion_command_at < first_brown_out {
                let ms = (now - first_brown_out) / MS;
                self.record_violation(Rule::BrownOutsEnd, format!("six brown-outs in {ms} ms"));
            }
            self.brown_out_times.rotate_left(1);
            self.brown_out_times[4] = now;
        }
    }

    fn record_motion_command(&mut self, effect: Effect, is_accepted: Option<bool>) {
        self.pending_promises.motion = None;
        if is_accepted == Some(false) {
            return;
        }
        self.last_motion_command_at = self.now;
        self.pending_promises = PendingPromises::default();
        if effect == Effect::Rest {
            self.rest_command_at = self.now;
            for servo in &mut self.servos {
                servo.forget_reset();
            }
        } else {
            self.first_rest_at = NEVER;
        }
        if effect == Effect::Motion {
            self.stop_report
                .record_motion_command(is_accepted.is_some());
            self.unfinished_motion_count += 1;
        }
        let is_certain = is_accepted.is_some() && self.disturbed_until <= self.now;
        self.permission
            .record_motion_command(self.now, effect, is_certain);
    }
}
