//! Mistakes in robot.toml: the message that its author reads, and the location in the file.

use std::fmt;

/// A mistake in robot.toml, with its file, line and key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Error {
    /// Name of the file, as given by the caller.
    pub file: String,
    /// Line of the key, counted from 1; `None` if the mistake belongs to no line.
    pub line: Option<usize>,
    /// Full name of the key, such as `servo.A1.pin`; empty if the mistake concerns the whole file.
    pub key: String,
    /// The consequence of the mistake for the robot, without keys and figures; `None` if `problem` states it.
    pub consequence: Option<String>,
    /// The message without file, line, key and consequence.
    pub problem: String,
    /// True if `problem` is a clause with its own subject; false if the key is its subject.
    pub(crate) is_clause: bool,
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
        // The consequence for the robot comes first, because the reader needs it before the location.
        if let Some(consequence) = &self.consequence {
            return write!(f, "{consequence}: {} ({location})", self.problem);
        }
        let separator = if self.key.is_empty() || self.is_clause {
            ":"
        } else {
            ""
        };
        write!(f, "{location}{separator} {}", self.problem)
    }
}

impl std::error::Error for Error {}

/// A mistake at a key whose file and line are not known yet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct UnlocatedError {
    /// Full name of the key; empty if the mistake concerns the whole file.
    pub key: String,
    /// See [`Error::consequence`].
    consequence: Option<String>,
    /// See [`Error::problem`].
    problem: String,
    /// See [`Error::is_clause`].
    is_clause: bool,
}

/// A checked value, or the mistake that was found in it.
pub(crate) type Checked<T> = Result<T, UnlocatedError>;

impl UnlocatedError {
    /// A mistake whose message has the key as its subject, such as `servo.A1.pin is 3; it must be ...`.
    pub fn new(key: impl Into<String>, problem: impl Into<String>) -> Self {
        Self {
            key: key.into(),
            consequence: None,
            problem: problem.into(),
            is_clause: false,
        }
    }

    /// A mistake whose message has its own subject, such as `gait.look: the point ...`.
    pub fn clause(key: impl Into<String>, problem: impl Into<String>) -> Self {
        Self {
            is_clause: true,
            ..Self::new(key, problem)
        }
    }

    /// Adds the consequence for the robot to the mistake, such as `in "walk" the left front leg would lock`.
    pub fn with_consequence(self, consequence: impl Into<String>) -> Self {
        Self {
            consequence: Some(consequence.into()),
            ..self
        }
    }

    /// A mistake in a number outside its range.
    pub fn out_of_range(key: String, value: f64, (min, max): (f64, f64), unit: &str) -> Self {
        let value = format_number(value);
        Self::new(
            key,
            format!("is {value}; it must be within {min} to {max} {unit}"),
        )
    }

    /// Adds file and line to the mistake.
    pub fn in_file(self, file: String, line: Option<usize>) -> Error {
        Error {
            file,
            line,
            key: self.key,
            consequence: self.consequence,
            problem: self.problem,
            is_clause: self.is_clause,
        }
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

/// Returns a hint for a word that is not allowed: the most similar allowed word, otherwise all of them.
pub(crate) fn hint(word: &str, allowed: &[&str]) -> String {
    let nearest = allowed
        .iter()
        .map(|candidate| (levenshtein_distance(word, candidate), candidate))
        .min();
    match nearest {
        // A similar word has at most two wrong letters; a word of two letters may differ only in its case.
        Some((edit_count, candidate))
            if edit_count == 0
                || (edit_count <= 2 && candidate.len() > 2 && edit_count < candidate.len()) =>
        {
            format!("did you mean \"{candidate}\"?")
        }
        _ => format!("allowed are {}", allowed.join(", ")),
    }
}

/// The Levenshtein distance between two words, ignoring case: the number of letters to change, add or remove.
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
