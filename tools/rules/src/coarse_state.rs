//! The observer's coarse state. It is equal for equivalent states, so the model checker explores only one of them.

use std::fmt;

use crate::event::{MS, Time};
use crate::observer::Observer;

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
    /// Returns a value whose `Debug` output is the same for equivalent states.
    pub fn coarse_state(&self) -> impl fmt::Debug + use<> {
        let rounded_age = |time: Time| rounded_age_frames(self.now.saturating_sub(time));
        let rounded_signed_age = |age: i64| match age > 0 {
            true => i16::from(rounded_age_frames(age)),
            false => -i16::from(rounded_age_frames(-age)) - 1,
        };
        let servos = self.servos.map(|servo| {
            let has_pulses = self.now - servo.last_start < 30 * MS;
            (
                servo.last_complete_width >> 11, // in classes of 128 us
                has_pulses,
                servo.interruption,
                servo.was_hung,
                servo.is_position_lost,
            )
        });
        let last_pulse_at = self.servos.iter().map(|servo| servo.last_start).max();
        let last_pulse_age = last_pulse_at.map(rounded_age);
        let frames_since_command = match self.deadman_time > 0 {
            true => (self.now - self.last_command_at) / (20 * MS),
            false => 0,
        };
        let is_within_ms = |time: Time, ms: Time| self.now - time < ms * MS;
        let recent_brown_outs = self
            .brown_out_times
            .iter()
            .filter(|time| is_within_ms(**time, 4_000) && **time > self.last_motion_command_at);
        (
            (
                servos,
                last_pulse_age,
                (frames_since_command, self.is_gait_or_routine),
                self.deadman_time,
                self.unanswered_line_count,
            ),
            (
                self.permission.is_granted,
                self.permission.has_expiry(),
                self.permission.boot_grant_at.is_some(),
            ),
            (
                is_within_ms(self.started_at, 500),
                is_within_ms(self.last_motion_command_at, 45),
                is_within_ms(self.disturbed_until, 300),
            ),
            self.supply
                .signed_times_since_crossing(self.limits.levels_mv, self.now)
                .map(rounded_signed_age),
            (
                self.reports.stopped_at.map(rounded_age),
                self.reports.is_reported,
                self.reports
                    .reported_at
                    .is_some_and(|time| is_within_ms(time, 400)),
            ),
            (recent_brown_outs.count(), self.start_cause),
        )
    }
}
