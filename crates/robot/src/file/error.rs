//! Errors in robot.toml: the message for the file's author, and the location in the file.

use std::fmt;
use std::path::Path;

/// An error in robot.toml, with its file, line and key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Error {
    /// Name of the file, as given by the caller.
    pub file: String,
    /// Line of the key, counted from 1; `None` if the error is not on a particular line.
    pub line: Option<usize>,
    /// Full name of the key, such as `servo.A1.pin`; empty if the error concerns the whole file.
    pub key: String,
    /// The consequence for the robot, without keys or numbers; `None` if `problem` states the consequence.
    pub consequence: Option<String>,
    /// The message without file, line, key and consequence.
    pub problem: String,
    /// True if `problem` has its own subject, false if the key is the subject.
    pub(crate) has_own_subject: bool,
}

impl Error {
    /// Sets the file's name.
    #[must_use]
    pub fn in_file(mut self, path: &Path) -> Self {
        self.file = path.display().to_string();
        self
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let mut location = self.file.clone();
        if let Some(line) = self.line {
            location += &format!(":{line}");
        }
        if !self.key.is_empty() {
            location += &format!(": {}", self.key);
        }
        // The consequence for the robot comes first, because the author needs it before the location.
        if let Some(consequence) = &self.consequence {
            return write!(f, "{consequence}: {} ({location})", self.problem);
        }
        let separator = if self.key.is_empty() || self.has_own_subject {
            ":"
        } else {
            ""
        };
        write!(f, "{location}{separator} {}", self.problem)
    }
}

impl std::error::Error for Error {}

/// The result of reading and checking a value. An error has no line until its key is found in the text.
pub(crate) type ReadResult<T> = Result<T, Error>;

impl Error {
    /// Creates an error in robot.toml whose message has the key as its subject, such as `servo.A1.pin is 3; it must be
    /// ...`. The key is empty if the error concerns the whole file.
    pub(crate) fn new(key: impl Into<String>, problem: impl Into<String>) -> Self {
        Self {
            file: "robot.toml".to_string(),
            line: None,
            key: key.into(),
            consequence: None,
            problem: problem.into(),
            has_own_subject: false,
        }
    }

    /// Creates an error whose message has its own subject, such as `gait.look: the point ...`.
    pub(crate) fn with_own_subject(key: impl Into<String>, problem: impl Into<String>) -> Self {
        Self {
            has_own_subject: true,
            ..Self::new(key, problem)
        }
    }

    /// Creates an error whose message begins with the consequence for the robot, such as `in the neutral pose the left
    /// front leg would lock`.
    pub(crate) fn with_consequence(
        key: impl Into<String>,
        consequence: String,
        problem: impl Into<String>,
    ) -> Self {
        Self {
            consequence: Some(consequence),
            ..Self::with_own_subject(key, problem)
        }
    }

    /// Creates the error for a gait with a consequence for the robot, such as `the left front leg would lock`.
    pub(crate) fn in_gait(name: &str, consequence: &str, problem: impl Into<String>) -> Self {
        let consequence = format!("in \"{name}\" {consequence}");
        Self::with_consequence(format!("gait.{name}"), consequence, problem)
    }

    /// Creates the error for a number outside its range.
    pub(crate) fn out_of_range(
        key: impl Into<String>,
        value: f64,
        (min, max): (f64, f64),
        unit: &str,
    ) -> Self {
        let value = format_number(value);
        Self::new(
            key,
            format!("is {value}; it must be between {min} and {max} {unit}"),
        )
    }
}

/// Formats a number with the fewest digits that identify it, or with an exponent if it would otherwise have many zeros.
pub(crate) fn format_number(value: f64) -> String {
    if value != 0.0 && !(1e-6..1e9).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

/// Returns a suggestion for a word that is not allowed: the most similar allowed word, or all allowed words.
pub(crate) fn suggest(word: &str, allowed: &[&str]) -> String {
    let closest = allowed
        .iter()
        .map(|candidate| (levenshtein_distance(word, candidate), candidate))
        .min();
    match closest {
        // A similar word has at most two wrong letters; a word of two letters may differ only in its case.
        Some((edit_count, candidate))
            if edit_count == 0
                || (edit_count <= 2 && candidate.len() > 2 && edit_count < candidate.len()) =>
        {
            format!("did you mean \"{candidate}\"?")
        }
        _ => format!("allowed: {}", allowed.join(", ")),
    }
}

/// Computes the Levenshtein distance between two words, ignoring case: the number of letters to change, add or remove.
fn levenshtein_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.to_lowercase().chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.to_lowercase().chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for j in 0..b.len() {
            let substitution_cost = diagonal + usize::from(letter != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = substitution_cost.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
