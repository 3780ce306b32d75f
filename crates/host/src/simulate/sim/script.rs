//! A script: timed commands for the robot.

use lizard_robot::to_command;

use super::press::ContactChange;

/// A command and its time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// Milliseconds since power-on.
    pub ms: u64,
    /// The command line without its line end.
    pub command: String,
}

impl Step {
    /// Creates a step with a command at `ms` milliseconds since power-on.
    pub fn new(ms: u64, command: impl Into<String>) -> Self {
        let command = command.into();
        Self { ms, command }
    }
}

/// The commands of a run, the changes of the robot's contacts, and the end of the run.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Script {
    /// The commands in order of time.
    pub steps: Vec<Step>,
    /// The changes of the robot's contacts, in order of time.
    pub contacts: Vec<ContactChange>,
    /// The end of the run, ms since power-on.
    pub end_ms: u64,
}

/// An error in a line of a script. Line numbers start at 1.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ScriptError {
    /// The line does not begin with a time.
    #[error("line {0}: expected a time in whole milliseconds, got `{1}`")]
    NoTime(usize, String),
    /// No command follows the time.
    #[error("line {0}: the command after the time is missing")]
    NoCommand(usize),
    /// The line's time is before the previous command's time.
    #[error("line {line}: {ms} ms is before the previous command's {previous_ms} ms")]
    OutOfOrder {
        /// The line number.
        line: usize,
        /// The line's time, ms.
        ms: u64,
        /// The previous command's time, ms.
        previous_ms: u64,
    },
}

/// Standing time before the first command of a built-in script, ms.
const STAND_MS: u64 = 1000;
/// Time for `stop`, `status` and `rest` at the end of a built-in script, ms.
const CLOSING_MS: u64 = 2000;

impl Script {
    /// Shortest allowed length of a built-in script, ms.
    pub const MIN_MS: u64 = STAND_MS + CLOSING_MS + 1000;

    /// Creates a script of `ms` milliseconds, at least [`Self::MIN_MS`]: a second of standing, then the gaits one after
    /// another, `stop`, `status` and `rest`.
    pub fn from_gaits(gaits: &[&str], ms: u64) -> Self {
        let gaits_ms = ms - STAND_MS - CLOSING_MS;
        // The last gait gets four parts of the time, and each earlier gait gets five.
        let compute_start = |index: usize| {
            STAND_MS + gaits_ms * 5 * index as u64 / (4 + 5 * (gaits.len() as u64 - 1))
        };
        let mut steps: Vec<Step> = gaits
            .iter()
            .enumerate()
            .map(|(index, gait)| Step::new(compute_start(index), to_command(gait)))
            .collect();
        steps.push(Step::new(ms - CLOSING_MS, "stop"));
        steps.push(Step::new(ms - CLOSING_MS / 2 - 200, "status"));
        steps.push(Step::new(ms - CLOSING_MS / 2, "rest"));
        Self {
            steps,
            end_ms: ms,
            ..Self::default()
        }
    }

    /// Parses lines of the form `<ms> <command>`. Skips blank lines, lines that begin with `#`, and a byte order mark.
    /// The run ends a second after the last command.
    ///
    /// # Errors
    /// Fails if a line has no time or no command, or if the lines are out of order.
    pub fn parse(text: &str) -> Result<Self, ScriptError> {
        let mut steps: Vec<Step> = Vec::new();
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        for (index, line) in text.lines().enumerate() {
            let line = line.trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let line_number = index + 1;
            let (time_text, command) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
            let ms = time_text
                .parse()
                .map_err(|_| ScriptError::NoTime(line_number, time_text.to_owned()))?;
            let command = command.trim();
            if command.is_empty() {
                return Err(ScriptError::NoCommand(line_number));
            }
            if let Some(previous_step) = steps.last().filter(|step| step.ms > ms) {
                return Err(ScriptError::OutOfOrder {
                    line: line_number,
                    ms,
                    previous_ms: previous_step.ms,
                });
            }
            steps.push(Step::new(ms, command));
        }
        let end_ms = steps.last().map_or(0, |last_step| last_step.ms) + 1000;
        Ok(Self {
            steps,
            end_ms,
            ..Self::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_is_parsed_into_timed_commands() {
        let text = "\u{feff}500 walk\r\n# a comment\n\n 1500\tspeed 50\r\n1500 stop";
        let script = Script::parse(text);
        let steps = vec![
            Step::new(500, "walk"),
            Step::new(1500, "speed 50"),
            Step::new(1500, "stop"),
        ];
        assert_eq!(
            script,
            Ok(Script {
                steps,
                end_ms: 2500,
                ..Script::default()
            })
        );
    }

    #[test]
    fn an_error_names_its_line() {
        let parse_error = |text| {
            Script::parse(text)
                .expect_err("the script must be refused")
                .to_string()
        };
        assert_eq!(
            parse_error("100 walk\nsoon stop"),
            "line 2: expected a time in whole milliseconds, got `soon`"
        );
        assert_eq!(
            parse_error("100"),
            "line 1: the command after the time is missing"
        );
        assert_eq!(
            parse_error("100 walk\n\n90 stop"),
            "line 3: 90 ms is before the previous command's 100 ms"
        );
    }

    #[test]
    fn built_in_scripts_are_in_order_and_end_in_time() {
        for script in [
            Script::from_gaits(&["walk", "left"], Script::MIN_MS),
            Script::from_gaits(&["arc-left"], 9000),
            Script::from_gaits(&[], 9000),
        ] {
            assert!(script.steps.is_sorted_by_key(|step| step.ms));
            assert!(script.steps.iter().all(|step| step.ms < script.end_ms));
        }
        assert_eq!(
            Script::from_gaits(&["arc-left"], 9000).steps[0].command,
            "arc left"
        );
    }
}
