//! The robot's `deadman` setting while a person drives.
//!
//! A robot that is out of range would keep walking. While a person drives it, `deadman` is therefore set: the robot
//! ends a gait by itself if it receives no line for that time. When the gait or the program ends, the robot's own
//! setting is restored.

use std::time::Duration;

use lizard_core::console::word::Word;

/// The `deadman` while a person drives, ms, unless the robot's own is shorter. Users set round numbers; a robot with
/// this value therefore got it from a program that ended without restoring the setting.
pub(super) const DRIVING_DEADMAN_MS: u16 = 901;
/// Interval between the lines that keep the robot walking. It is so short that two of three lines may be lost, even if
/// the robot's own setting is somewhat shorter than [`DRIVING_DEADMAN_MS`].
pub(super) const LINE_INTERVAL: Duration = Duration::from_millis(200);

/// Returns the `deadman` while a person drives a robot with this setting of its own, both in ms.
pub(super) fn limit_deadman_ms(own_ms: u16) -> u16 {
    match own_ms {
        0 => DRIVING_DEADMAN_MS,
        own_ms => own_ms.min(DRIVING_DEADMAN_MS),
    }
}

/// A line that reads or sets `deadman`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DeadmanLine {
    /// Read the robot's own setting.
    Read,
    /// Set `deadman` for driving.
    Set,
    /// Restore the robot's own setting for the next line only.
    RestoreForOneLine,
    /// Restore the robot's own setting.
    Restore,
}

/// The robot's own `deadman`, and its replacement while a person drives.
#[derive(Debug, Default)]
pub(super) struct Deadman {
    /// The robot's own setting, ms; `None` until it is read.
    own_ms: Option<u16>,
    /// The robot's own setting before it was read again, ms. It still applies if the robot reports the value for
    /// driving: a `stop` has dropped the line that restores the setting, or the link has lost this line.
    own_ms_before_read: Option<u16>,
    /// True while `deadman` has its value for driving, is about to get it, or may have it.
    pub(super) is_overridden: bool,
    /// True if the robot has not confirmed a line, and `deadman` may have either value.
    is_unconfirmed: bool,
    /// True from the start of a gait or a routine to its end. A routine may rest in between; the robot then wakes by
    /// itself.
    pub(super) is_gait_under_way: bool,
}

impl Deadman {
    /// The interval of the additional lines while an answer is outstanding, a little less than a third of the setting.
    /// Shorter intervals would fill a link at 9600 baud.
    pub(super) fn extra_line_interval(&self) -> Duration {
        let third_ms = u64::from(limit_deadman_ms(self.own_ms.unwrap_or(0))) / 3;
        LINE_INTERVAL.max(Duration::from_millis(third_ms.saturating_sub(20)))
    }

    /// Returns the lines to send before and after a user's line, and records if they override the setting.
    pub(super) fn plan_lines(
        &mut self,
        line: &str,
    ) -> (&'static [DeadmanLine], &'static [DeadmanLine]) {
        let line = line.to_ascii_lowercase();
        let word = line.split_whitespace().next().unwrap_or_default();
        match word {
            // `cal` shows the setting and `save` stores it; both therefore need the robot's own value. The driving
            // value is set again afterwards, because the robot may have started to walk since its last status.
            "cal" | "save" if self.is_overridden => {
                // The answer that would have reported the robot's own value may be lost.
                let before: &[_] = match self.own_ms.is_none() && self.is_unconfirmed {
                    true => &[DeadmanLine::Read, DeadmanLine::RestoreForOneLine],
                    false => &[DeadmanLine::RestoreForOneLine],
                };
                return (before, &[DeadmanLine::Set]);
            }
            // These lines replace the value for driving. If `load` is refused, the robot keeps its own value.
            "deadman" if self.is_overridden => return (&[], &[DeadmanLine::Set]),
            "load" | "factory" if self.is_overridden => {
                return (
                    &[DeadmanLine::RestoreForOneLine],
                    &[DeadmanLine::Read, DeadmanLine::Set],
                );
            }
            "load" | "factory" => (self.own_ms, self.own_ms_before_read) = (None, None),
            _ => {}
        }
        // Only a gait or a routine makes the robot walk; their names are not among the console's words.
        if word == "stand" || Word::find(word.as_bytes()).is_some() || self.is_driving() {
            return (&[], &[]);
        }
        (self.is_overridden, self.is_unconfirmed) = (true, false);
        match self.own_ms {
            None => (&[DeadmanLine::Read, DeadmanLine::Set], &[]),
            Some(_) => (&[DeadmanLine::Set], &[]),
        }
    }

    /// Returns the text of the line to send; `None` if the robot's own setting is unknown, because the program ends or
    /// the user stops the robot before the robot has reported it, or because the answer to `cal` was lost.
    /// [`DeadmanLine::Restore`] also marks the setting as restored. [`DeadmanLine::Set`] marks it as confirmed if the
    /// robot's own setting is known.
    pub(super) fn apply_line(&mut self, deadman_line: DeadmanLine) -> Option<String> {
        match deadman_line {
            DeadmanLine::Read => {
                self.own_ms_before_read = self.own_ms.take().or(self.own_ms_before_read);
                return Some("cal".to_owned());
            }
            DeadmanLine::Restore => self.is_overridden = false,
            DeadmanLine::Set => self.is_unconfirmed &= self.own_ms.is_none(),
            DeadmanLine::RestoreForOneLine => {}
        }
        let ms = match (deadman_line, self.own_ms?) {
            (DeadmanLine::Set, own_ms) => limit_deadman_ms(own_ms),
            (_, own_ms) => own_ms,
        };
        Some(format!("deadman {ms}"))
    }

    /// True while `deadman` has its value for driving, or is about to get it.
    pub(super) fn is_driving(&self) -> bool {
        self.is_overridden && !self.is_unconfirmed
    }

    /// Records that the robot has not confirmed a line. The value for driving replaces only a known setting.
    pub(super) fn record_unconfirmed(&mut self) {
        self.is_overridden = self.own_ms.or(self.own_ms_before_read).is_some();
        self.is_unconfirmed = true;
    }

    /// True if the robot has not reported its own setting, or if the line with the setting was lost.
    pub(super) fn is_unknown(&self) -> bool {
        self.own_ms.is_none()
    }

    /// Parses a line of the answer to `cal`; returns false if the line cannot belong to that answer.
    pub(super) fn parse_cal_line(&mut self, line: &str) -> bool {
        if let Some(ms) = line
            .strip_prefix("# deadman ")
            .and_then(|ms| ms.parse().ok())
        {
            self.own_ms = match ms {
                DRIVING_DEADMAN_MS => self.own_ms_before_read.or(Some(0)),
                own_ms => Some(own_ms),
            };
        }
        ["# A", "# boot ", "# deadman "]
            .iter()
            .any(|start| line.starts_with(start))
    }

    /// Records the effect of a user's line that the robot has accepted.
    pub(super) fn record_accepted_line(&mut self, line: &str) {
        let line = line.to_ascii_lowercase();
        match line.split_whitespace().collect::<Vec<_>>()[..] {
            ["deadman", ms] => self.own_ms = ms.parse().ok(),
            [word, ..] => self.is_gait_under_way |= Word::find(word.as_bytes()).is_none(),
            [] => {}
        }
    }
}
