//! The results of the lines of a script: the program that called this one has to learn
//! that a line was refused.

use super::session::{Said, Unanswered};
use crate::Failure;

/// A count of the lines that came to nothing.
#[derive(Debug, Default)]
pub struct Refusals {
    sent: usize,
    refused: usize,
    /// The line that waits for its answer.
    last: String,
    /// The first line that came to nothing, and what was said to it.
    first: Option<(String, String)>,
}

impl Refusals {
    /// Takes note of what was said.
    pub fn hear(&mut self, said: &Said) {
        match said {
            Said::Sent(line) => {
                self.sent += 1;
                self.last.clone_from(line);
            }
            Said::Answer(answer) if answer.starts_with("err ") => self.count(answer),
            _ => {}
        }
    }

    /// Counts a line that was not answered in time; the program's own questions are no lines.
    pub fn count_silence(&mut self, unanswered: &Unanswered) {
        if let Unanswered::Line(_) = unanswered {
            self.count("no answer");
        }
    }

    fn count(&mut self, why: &str) {
        self.refused += 1;
        let line = self.last.clone();
        self.first.get_or_insert_with(|| (line, why.to_owned()));
    }

    /// Succeeds if the robot accepted all lines.
    ///
    /// # Errors
    /// One was not; the sentence has the first such.
    pub fn verdict(&self) -> Result<(), Failure> {
        let Some((line, why)) = &self.first else {
            return Ok(());
        };
        Err(Failure::Impossible(format!(
            "the robot did not take {} of {} lines, the first `{line}`: {why}",
            self.refused, self.sent
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sent(line: &str) -> Said {
        Said::Sent(line.to_owned())
    }

    fn answer(line: &str) -> Said {
        Said::Answer(line.to_owned())
    }

    #[test]
    fn lines_that_are_all_taken_are_no_failure() {
        let mut refusals = Refusals::default();
        for said in [
            sent("walk"),
            answer("ok walk"),
            Said::Note("# err 1".to_owned()),
        ] {
            refusals.hear(&said);
        }
        refusals.verdict().expect("all were taken");
    }

    #[test]
    fn the_first_line_that_was_not_taken_is_named_and_all_are_counted() {
        let mut refusals = Refusals::default();
        for said in [
            sent("walk"),
            answer("ok walk"),
            sent("fly"),
            answer("err 1 no"),
            sent("swim"),
            answer("err 2 no"),
            sent("stop"),
        ] {
            refusals.hear(&said);
        }
        refusals.count_silence(&Unanswered::Program);
        refusals.count_silence(&Unanswered::Line("stop".to_owned()));
        let words = refusals
            .verdict()
            .expect_err("three were not taken")
            .to_string();
        assert_eq!(
            words,
            "the robot did not take 3 of 4 lines, the first `fly`: err 1 no"
        );
    }
}
