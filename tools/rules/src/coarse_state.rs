//! The observer's coarse state. It is equal for equivalent states, so the model checker explores only one of them.

use lizard_core::memory::restart::Cause;

use crate::event::{MS, NEVER, Time};
use crate::observer::Observer;
use crate::pulses::Interruption;

/// The part of an observer's state on which later verdicts depend, rounded. Ages are in frames, rounded down to the
/// start of their class.
#[derive(Debug, PartialEq, Eq, Hash)]
pub struct CoarseState {
    servos: [CoarseServo; 4],
    /// The age of the last pulse of any servo.
    last_pulse_age: u8,
    /// The frames since the last command; 0 without `deadman`.
    frames_since_command: Time,
    is_gait_or_routine: bool,
    deadman_time: Time,
    unanswered_line_count: i32,
    are_pulses_permitted: bool,
    does_permission_expire: bool,
    can_boot_permit_pulses: bool,
    has_just_started: bool,
    has_just_received_motion_command: bool,
    was_recently_disturbed: bool,
    /// For each supply level, the age of the supply's last crossing; negative unless the supply is now below the level.
    supply_crossing_ages: [i16; 3],
    /// The age of the stop; `None` if no fault has stopped the robot.
    stop_age: Option<u8>,
    is_stop_reported: bool,
    was_stop_recently_reported: bool,
    recent_brown_out_count: usize,
    start_cause: Cause,
}

/// The part of a servo's history that belongs to the coarse state.
#[derive(Debug, PartialEq, Eq, Hash)]
struct CoarseServo {
    /// The width of the last complete pulse, in classes of 128 us.
    width_class: u32,
    has_pulses: bool,
    interruption: Interruption,
    was_hung: bool,
    is_position_lost: bool,
}

/// Rounds an age down to the start of its class, in frames.
const fn rounded_age_frames(age: Time) -> u8 {
    match age / (20 * MS) {
        ..=0 => 0,
        1..=3 => 1,
        4..=14 => 4,
        15..=70 => 15,
        _ => 71,
    }
}

impl Observer {
    /// Returns the coarse state, which is the same for equivalent states.
    pub fn coarse_state(&self) -> CoarseState {
        let rounded_age = |time: Time| rounded_age_frames(self.now.saturating_sub(time));
        let rounded_signed_age = |age: Time| match age > 0 {
            true => i16::from(rounded_age_frames(age)),
            false => -i16::from(rounded_age_frames(-age)) - 1,
        };
        let is_within_ms = |time: Time, ms: Time| self.now - time < ms * MS;
        let last_pulse_starts = self.servos.iter().map(|servo| servo.last_start);
        let crossing_times = self
            .supply
            .signed_times_since_crossing(self.limits.levels_mv, self.now);
        let recent_brown_outs = self
            .brown_out_times
            .iter()
            .filter(|time| is_within_ms(**time, 4_000) && **time > self.last_motion_command_at);
        CoarseState {
            servos: self.servos.map(|servo| CoarseServo {
                width_class: servo.last_complete_width >> 11,
                has_pulses: is_within_ms(servo.last_start, 30),
                interruption: servo.interruption,
                was_hung: servo.was_hung,
                is_position_lost: servo.is_position_lost,
            }),
            last_pulse_age: rounded_age(last_pulse_starts.fold(NEVER, Time::max)),
            frames_since_command: match self.deadman_time > 0 {
                true => (self.now - self.last_command_at) / (20 * MS),
                false => 0,
            },
            is_gait_or_routine: self.is_gait_or_routine,
            deadman_time: self.deadman_time,
            unanswered_line_count: self.unanswered_line_count,
            are_pulses_permitted: self.permission.is_granted,
            does_permission_expire: self.permission.has_expiry(),
            can_boot_permit_pulses: self.permission.boot_grant_at.is_some(),
            has_just_started: is_within_ms(self.started_at, 500),
            has_just_received_motion_command: is_within_ms(self.last_motion_command_at, 45),
            was_recently_disturbed: is_within_ms(self.disturbed_until, 300),
            supply_crossing_ages: crossing_times.map(rounded_signed_age),
            stop_age: self.stop_report.stopped_at.map(rounded_age),
            is_stop_reported: self.stop_report.is_reported,
            was_stop_recently_reported: self
                .stop_report
                .reported_at
                .is_some_and(|time| is_within_ms(time, 400)),
            recent_brown_out_count: recent_brown_outs.count(),
            start_cause: self.start_cause,
        }
    }
}
