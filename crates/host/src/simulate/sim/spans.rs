//! The commands of a run and their time spans.

use lizard_core::console::word::{Effect, Word};

use super::script::Script;

/// The time span of a command's effect, serialized with the keys `command`, `from` and `to`.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Span {
    /// The command that begins the span.
    pub command: String,
    /// Time when the command was sent, s since power-on.
    #[serde(rename = "from")]
    pub start_s: f64,
    /// Time when the next command was sent or the run ended, s since power-on.
    #[serde(rename = "to")]
    pub end_s: f64,
}

impl Span {
    /// Creates the span of a command.
    pub fn new(command: &str, start_s: f64, end_s: f64) -> Self {
        let command = command.to_owned();
        Self {
            command,
            start_s,
            end_s,
        }
    }
}

/// True if an answer refuses its command. A lost answer, `None`, counts as no refusal.
pub fn is_refused(answer: &Option<String>) -> bool {
    matches!(answer, Some(answer) if answer.starts_with("err"))
}

/// True if a command starts or ends a motion or changes its speed. A word that is not a console word counts as a gait's
/// name.
fn changes_motion(command: &str) -> bool {
    let word = command.split_whitespace().next().unwrap_or_default();
    Word::find(word.as_bytes())
        .is_none_or(|word| !matches!(word.effect(), Effect::None | Effect::CalibrationChange))
}

/// Lists, in order of time, the span of the initial `stand` and the spans of the commands that changed the motion.
/// After a refused command, the previous command stays in effect.
pub fn list_command_spans(script: &Script, answers: &[Option<String>]) -> Vec<Span> {
    let mut starts = vec![(0.0, "stand")];
    for (step, answer) in script.steps.iter().zip(answers) {
        let is_within_run = step.ms <= script.end_ms;
        if is_within_run && !is_refused(answer) && changes_motion(&step.command) {
            starts.push((step.ms as f64 / 1000.0, step.command.as_str()));
        }
    }
    let end_s = script.end_ms as f64 / 1000.0;
    let ends = starts.iter().skip(1).map(|(start_s, _)| *start_s);
    let spans = starts.iter().zip(ends.chain([end_s]));
    spans
        .map(|((start_s, command), end_s)| Span::new(command, *start_s, end_s))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_command_and_a_command_without_motion_have_no_span() {
        let script = Script::parse("1000 Walk\n2000 pose 0 0 0 0\n3000 WATCH 5\n4000 rest")
            .expect("the script is valid");
        let answers = ["ok walk", "err 4 beyond travel", "ok watch 5", "ok rest"];
        let spans = list_command_spans(&script, &answers.map(|answer| Some(answer.to_owned())));
        let expected = [("stand", 0.0, 1.0), ("walk", 1.0, 4.0), ("rest", 4.0, 5.0)];
        let expected = expected.map(|(command, start_s, end_s)| Span::new(command, start_s, end_s));
        assert_eq!(spans, expected);
    }

    #[test]
    fn a_command_after_the_end_of_the_run_has_no_span() {
        let mut script = Script::parse("1000 walk\n20000 stop").expect("the script is valid");
        script.end_ms = 5000;
        let spans = list_command_spans(&script, &[Some("ok walk".to_owned()), None]);
        let expected = [Span::new("stand", 0.0, 1.0), Span::new("walk", 1.0, 5.0)];
        assert_eq!(spans, expected);
    }
}
