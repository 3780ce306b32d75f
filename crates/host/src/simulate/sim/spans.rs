//! The commands of a run and the time spans in which each was in effect.

use lizard_core::console::word::{Effect, Word};

use super::script::Script;

/// A time span in which one command is in effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Span {
    /// The command in effect.
    pub command: String,
    /// Time since power-on at which the command was sent, s.
    pub from: f64,
    /// Time since power-on at which the next command was sent or the run ended, s.
    pub to: f64,
}

/// True if a command starts or ends a motion or changes its speed. A word that the console does not know counts as the
/// name of a gait.
fn changes_motion(command: &str) -> bool {
    let word = command.split_whitespace().next().unwrap_or_default();
    Word::find(word.as_bytes())
        .is_none_or(|word| !matches!(word.effect(), Effect::None | Effect::Calibrates))
}

/// The initial `stand` and the commands that changed the motion, in order of time. After a refused command, the
/// previous command stays in effect.
pub fn command_spans(script: &Script, answers: &[Option<String>]) -> Vec<Span> {
    let mut starts = vec![(0.0, "stand")];
    for (step, answer) in script.steps.iter().zip(answers) {
        let is_refused = answer
            .as_ref()
            .is_some_and(|answer| answer.starts_with("err"));
        if !is_refused && changes_motion(&step.command) {
            starts.push((step.ms as f64 / 1000.0, step.command.as_str()));
        }
    }
    let end = script.end_ms as f64 / 1000.0;
    let ends = starts.iter().skip(1).map(|(from, _)| *from).chain([end]);
    starts
        .iter()
        .zip(ends)
        .map(|((from, command), to)| Span {
            command: (*command).to_owned(),
            from: *from,
            to,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_command_and_one_without_motion_leave_the_previous_command_in_effect() {
        let script = Script::parse("1000 walk\n2000 pose 0 0 0 0\n3000 watch 5\n4000 rest")
            .expect("the script is valid");
        let answers = ["ok walk", "err 4 beyond travel", "ok watch 5", "ok rest"];
        let spans = command_spans(&script, &answers.map(|answer| Some(answer.to_owned())));
        let span_tuples: Vec<(&str, f64, f64)> = spans
            .iter()
            .map(|span| (span.command.as_str(), span.from, span.to))
            .collect();
        assert_eq!(
            span_tuples,
            [("stand", 0.0, 1.0), ("walk", 1.0, 4.0), ("rest", 4.0, 5.0)]
        );
    }
}
