//! A script: timed commands for the robot.

use lizard_robot::to_command;

use super::press::ContactChange;

/// A command and its time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// Milliseconds since power-on.
    pub ms: u64,
    /// The command line without its line end, in lower case: the robot does not distinguish upper and lower case.
    pub command: String,
}

impl Step {
    /// Creates a step with a command at `ms` milliseconds since power-on.
    pub fn new(ms: u64, command: impl Into<String>) -> Self {
        let command = command.into().to_ascii_lowercase();
        Self { ms, command }
    }
}

/// The commands of a run, the changes of the robot's contacts, and the end of the run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Script {
    /// The commands in order of time.
    pub steps: Vec<Step>,
    /// The changes of the robot's contacts, in order of time.
    pub contact_changes: Vec<ContactChange>,
    /// The end of the run, ms since power-on.
    pub end_ms: u64,
}

/// Standing time before the first command of a built-in script, ms.
const STAND_MS: u64 = 1000;
/// Time for `stop`, `status` and `rest` at the end of a built-in script, ms.
const CLOSING_MS: u64 = 2000;

impl Script {
    /// Shortest allowed length of a built-in script, ms.
    pub const MIN_MS: u64 = STAND_MS + CLOSING_MS + 1000;

    /// Creates a script without changes of contacts.
    pub fn new(steps: Vec<Step>, end_ms: u64) -> Self {
        Self {
            steps,
            contact_changes: Vec::new(),
            end_ms,
        }
    }

    /// Creates a script of `ms` milliseconds, at least [`Self::MIN_MS`]: a second of standing, then the gaits one after
    /// another, `stop`, `status` and `rest`.
    pub fn from_gaits(gaits: &[&str], ms: u64) -> Self {
        let gaits_ms = ms - STAND_MS - CLOSING_MS;
        // The last gait gets four parts of the time, and each earlier gait gets five.
        let compute_start_ms = |index: usize| {
            STAND_MS + gaits_ms * 5 * index as u64 / (4 + 5 * (gaits.len() as u64 - 1))
        };
        let gait_steps = gaits.iter().enumerate();
        let gait_steps =
            gait_steps.map(|(index, gait)| Step::new(compute_start_ms(index), to_command(gait)));
        let closing_steps = [
            Step::new(ms - CLOSING_MS, "stop"),
            Step::new(ms - CLOSING_MS / 2 - 200, "status"),
            Step::new(ms - CLOSING_MS / 2, "rest"),
        ];
        Self::new(gait_steps.chain(closing_steps).collect(), ms)
    }

    /// Parses lines of the form `<ms> <command>`. Skips blank lines, lines that begin with `#`, and a byte order mark.
    /// The run ends a second after the last command.
    ///
    /// # Errors
    /// Fails if a line has no time or no command, or if the lines are out of order.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut steps: Vec<Step> = Vec::new();
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        for (index, line) in text.lines().enumerate() {
            let line = line.trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let number = index + 1;
            let (time_text, command) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
            let ms: u64 = time_text.parse().map_err(|_| {
                format!("line {number}: expected a time in whole milliseconds, got `{time_text}`")
            })?;
            let command = command.trim();
            if command.is_empty() {
                return Err(format!(
                    "line {number}: the command after the time is missing"
                ));
            }
            let previous_ms = steps.last().map_or(0, |step| step.ms);
            if ms < previous_ms {
                return Err(format!(
                    "line {number}: {ms} ms is before the previous command's {previous_ms} ms"
                ));
            }
            steps.push(Step::new(ms, command));
        }
        let end_ms = steps.last().map_or(0, |last_step| last_step.ms) + 1000;
        Ok(Self::new(steps, end_ms))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_is_parsed_into_timed_commands() {
        let text = "\u{feff}500 walk\r\n# a comment\n\n 1500\tspeed 50\r\n1500 stop";
        let script = Script::parse(text);
        let steps = [(500, "walk"), (1500, "speed 50"), (1500, "stop")];
        let steps = steps.map(|(ms, command)| Step::new(ms, command));
        assert_eq!(script, Ok(Script::new(steps.to_vec(), 2500)));
    }

    #[test]
    fn an_error_names_its_line() {
        for (text, error) in [
            (
                "100 walk\nsoon stop",
                "line 2: expected a time in whole milliseconds, got `soon`",
            ),
            ("100", "line 1: the command after the time is missing"),
            (
                "100 walk\n\n90 stop",
                "line 3: 90 ms is before the previous command's 100 ms",
            ),
        ] {
            assert_eq!(Script::parse(text), Err(error.to_owned()));
        }
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
        let script = Script::from_gaits(&["arc-left"], 9000);
        assert_eq!(script.steps[0].command, "arc left");
    }
}
