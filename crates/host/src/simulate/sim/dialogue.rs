//! Prints the dialogue between user and robot line by line as it happens.

use std::io::{self, Write};

use super::session::{DialogueLine, Sender};
use crate::shared::escape::escape_controls;

/// Number of printed lines in each run of consecutive `# t=` lines; the remaining lines are only counted.
const MAX_SHOWN_LINES: usize = 3;

/// Prints the lines of a dialogue. A run of consecutive `# t=` lines, which `watch` causes, is shortened to three lines
/// and the number of further lines, unless `shows_all` is true.
#[derive(Debug)]
pub struct DialoguePrinter {
    /// True if runs of `# t=` lines are printed completely.
    shows_all: bool,
    /// Number of lines in the current run of `# t=` lines.
    run_length: usize,
}

impl DialoguePrinter {
    /// Creates a printer that prints all lines if `shows_all` is true, and otherwise shortens runs of `# t=` lines.
    pub fn new(shows_all: bool) -> Self {
        Self {
            shows_all,
            run_length: 0,
        }
    }

    /// Prints a line.
    ///
    /// # Errors
    /// Fails if writing fails.
    pub fn print(&mut self, line: &DialogueLine, out: &mut impl Write) -> io::Result<()> {
        let is_watch_line = line.from == Sender::Robot && line.text.starts_with("# t=");
        if is_watch_line && !self.shows_all {
            self.run_length += 1;
            if self.run_length > MAX_SHOWN_LINES {
                return Ok(());
            }
        } else {
            self.finish(out)?;
        }
        let mark = match line.from {
            Sender::User => ">",
            Sender::Robot => " ",
        };
        let seconds = line.ms / 1000.0;
        let text = escape_controls(&line.text);
        writeln!(out, "{seconds:>9.3} s  {mark} {text}")?;
        out.flush()
    }

    /// Ends a run of `# t=` lines: prints the number of omitted lines, if any.
    ///
    /// # Errors
    /// Fails if writing fails.
    pub fn finish(&mut self, out: &mut impl Write) -> io::Result<()> {
        let hidden_count = std::mem::take(&mut self.run_length).saturating_sub(MAX_SHOWN_LINES);
        if hidden_count > 0 {
            writeln!(
                out,
                "               (hidden lines `# t=`: {hidden_count}; --all prints them)"
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn print_lines(shows_all: bool, lines: &[(Sender, &str)]) -> String {
        let mut out = Vec::new();
        let mut printer = DialoguePrinter::new(shows_all);
        for (from, text) in lines {
            let line = DialogueLine {
                ms: 1500.0,
                from: *from,
                text: (*text).to_owned(),
            };
            let result = printer.print(&line, &mut out);
            result.expect("writing to a vector succeeds");
        }
        let result = printer.finish(&mut out);
        result.expect("writing to a vector succeeds");
        String::from_utf8(out).expect("the output is UTF-8")
    }

    #[test]
    fn only_long_runs_of_watch_lines_are_shortened() {
        let watch_lines = [(Sender::Robot, "# t=1 pose=1,2,3,4"); 5];
        let mut lines = vec![(Sender::User, "watch 1"), (Sender::Robot, "ok watch 1")];
        lines.extend(watch_lines);
        lines.push((Sender::Robot, "# hold"));
        lines.extend(&watch_lines[..3]);
        lines.push((Sender::User, "# t=0"));
        lines.extend(&watch_lines[..4]);
        let shortened_text = print_lines(false, &lines);
        let watch_line_count = shortened_text.matches("# t=1").count();
        assert_eq!(watch_line_count, 9, "{shortened_text}");
        assert!(
            shortened_text
                .contains("(hidden lines `# t=`: 2; --all prints them)\n    1.500 s    # hold")
        );
        assert!(shortened_text.ends_with("(hidden lines `# t=`: 1; --all prints them)\n"));
        assert_eq!(shortened_text.matches("hidden lines").count(), 2);
        let full_text = print_lines(true, &lines);
        assert_eq!(full_text.lines().count(), lines.len());
        assert!(full_text.starts_with("    1.500 s  > watch 1\n    1.500 s    ok watch 1\n"));
    }
}
