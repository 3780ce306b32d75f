//! The menu of `lizard` without arguments in a terminal: new owners know what they want
//! to do, but not which command does it.

use std::ffi::OsString;
use std::io::{self, BufRead, IsTerminal, Write};

use super::KNOWN;
use crate::Failure;

/// What may be chosen, and the command line that does it.
const ENTRIES: [(&str, &[&str]); 7] = [
    (
        "Try the console with a simulated robot",
        &["console", "--sim"],
    ),
    (
        "Let the firmware walk on a simulated UNO, with a table and a picture",
        &["sim"],
    ),
    ("Write the firmware to a UNO on USB", &["flash"]),
    ("Drive the robot on USB", &["console"]),
    ("Calibrate the robot on USB, step by step", &["calibrate"]),
    (
        "Make the files to print and the guide, in out/parts",
        &["parts", "out/parts"],
    ),
    ("See all commands", &["--help"]),
];

/// What is to be done.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Choice {
    /// What the command line says.
    Typed,
    /// This command line.
    Chosen(Vec<OsString>),
    /// Nothing.
    Nothing,
}

/// Shows the menu where no command is typed and a person can choose; the first of the words is
/// the program's name.
///
/// # Errors
/// The terminal cannot be read or written.
pub(super) fn chosen(words: &[OsString]) -> Result<Choice, Failure> {
    if words.len() > 1 || !io::stdin().is_terminal() || !io::stdout().is_terminal() {
        return Ok(Choice::Typed);
    }
    let program = super::program();
    let has = |name: &str| program.get_subcommands().any(|sub| sub.get_name() == name);
    Ok(ask(has, &mut io::stdin().lock(), &mut io::stdout())?)
}

/// Asks until an answer means something. The end of the input means nothing is wanted.
fn ask(
    has: impl Fn(&str) -> bool,
    input: &mut impl BufRead,
    out: &mut impl Write,
) -> io::Result<Choice> {
    let is_built = |name: &str| has(name) || name.starts_with('-');
    let entries: Vec<_> = ENTRIES
        .iter()
        .filter(|(_, line)| is_built(line[0]))
        .collect();
    writeln!(out, "What do you want to do?\n")?;
    for (number, (words, line)) in (1..).zip(&entries) {
        writeln!(out, "  {number}  {words}")?;
        writeln!(out, "       lizard {}", line.join(" "))?;
    }
    loop {
        write!(out, "\nA number and Enter, or Enter alone to leave: ")?;
        out.flush()?;
        let mut answer = String::new();
        let read = input.read_line(&mut answer)?;
        if read == 0 {
            // The end of the input leaves the line open.
            writeln!(out)?;
        }
        let answer = answer.trim();
        if read == 0 || answer.is_empty() || answer == "q" {
            return Ok(Choice::Nothing);
        }
        let place = answer.parse::<usize>().ok();
        let entry = place.and_then(|place| entries.get(place.checked_sub(1)?));
        if let Some((_, line)) = entry {
            writeln!(out)?;
            let line = std::iter::once(&"lizard").chain(*line);
            return Ok(Choice::Chosen(line.map(OsString::from).collect()));
        }
        // A user who knows a command may type it here.
        if KNOWN.iter().any(|known| known.name() == answer) && has(answer) {
            return Ok(Choice::Chosen(vec!["lizard".into(), answer.into()]));
        }
        writeln!(
            out,
            "`{}` is none of 1 to {}.",
            answer.escape_debug(),
            entries.len()
        )?;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answered(answers: &str, has: impl Fn(&str) -> bool) -> (Choice, String) {
        let mut out = Vec::new();
        let choice = ask(has, &mut answers.as_bytes(), &mut out).expect("it is written");
        (choice, String::from_utf8(out).expect("text"))
    }

    fn line(words: &[&str]) -> Choice {
        Choice::Chosen(words.iter().map(OsString::from).collect())
    }

    #[test]
    fn a_number_is_the_command_that_stands_below_it() {
        let (choice, shown) = answered("1\n", |_| true);
        assert_eq!(choice, line(&["lizard", "console", "--sim"]));
        assert!(shown.contains(
            "\n  1  Try the console with a simulated robot\n       lizard console --sim\n"
        ));
        assert_eq!(answered("7\n", |_| true).0, line(&["lizard", "--help"]));
        assert_eq!(answered("gaits\n", |_| true).0, line(&["lizard", "gaits"]));
    }

    #[test]
    fn what_is_no_answer_is_asked_again_and_enter_or_the_end_leaves() {
        let (choice, shown) = answered("9\n0\nx\u{1b}[2J\n3\n", |_| true);
        assert_eq!(choice, line(&["lizard", "flash"]));
        assert!(shown.contains("`9` is none of 1 to 7."), "{shown}");
        assert!(!shown.contains('\u{1b}'), "{shown:?}");
        for answers in ["", "\n", "q\n"] {
            assert_eq!(answered(answers, |_| true).0, Choice::Nothing);
        }
    }

    #[test]
    fn a_build_offers_only_what_it_has() {
        let (choice, shown) = answered("1\n", |name| name == "parts");
        assert_eq!(choice, line(&["lizard", "parts", "out/parts"]));
        assert!(!shown.contains("console"), "{shown}");
        assert!(shown.contains("  2  See all commands"), "{shown}");
    }

    #[test]
    fn every_entry_is_a_command_line_that_there_is() {
        for (words, line) in ENTRIES {
            let name = line[0];
            let is_known = KNOWN.iter().any(|known| known.name() == name);
            assert!(is_known || name == "--help", "{words}: {name}");
        }
    }
}
