//! Writes the identified values into the text of a robot.toml.

use lizard_robot::{Robot, edit};

use crate::outcome::{Identified, KeyResult};
use crate::trouble::Trouble;

impl Identified {
    /// Writes the keys with a new value into the text of the robot's file, each with a comment; all other bytes stay
    /// unchanged.
    ///
    /// # Errors
    /// Fails if the text has no place for a key, or if the robot with the new values is refused.
    pub fn text(&self, text: &str) -> Result<String, Trouble> {
        let mut new = text.to_owned();
        let mut names: Vec<&str> = self.moved().map(|found| found.key.name).collect();
        names.dedup();
        for name in names {
            let of_key = self.keys.iter().filter(|found| found.key.name == name);
            new = with_key(&new, &of_key.collect::<Vec<_>>())
                .map_err(|error| Trouble::Text(error.to_string()))?;
        }
        Robot::parse(&new).map_err(|error| Trouble::Refused(error.to_string()))?;
        Ok(new)
    }
}

/// Writes the value of a key, which is one number or a list, with a comment about the numbers that moved.
fn with_key(text: &str, numbers: &[&KeyResult]) -> Result<String, edit::NoSuchKey> {
    let name = numbers[0].key.name;
    let values: Vec<f64> = numbers.iter().map(|found| found.written()).collect();
    let new = match numbers[0].key.list_index {
        Some(_) => edit::with_numbers(text, name, &values)?,
        None => edit::with_number(text, name, values[0])?,
    };
    let moved = numbers.iter().filter(|found| found.is_moved());
    let words: Vec<String> = moved.map(|found| found.comment()).collect();
    edit::with_comment(&new, name, "measured:", &words.join("; "))
}

impl KeyResult {
    fn is_moved(&self) -> bool {
        self.verdict == crate::Verdict::Moved
    }

    /// The value for the new file, rounded if it moved.
    fn written(&self) -> f64 {
        if !self.is_moved() {
            return self.before;
        }
        let scale = 10f64.powi(self.digits() as i32);
        (self.after * scale).round() / scale
    }

    fn comment(&self) -> String {
        let digits = self.digits();
        let place = match self.key.list_index {
            Some(index) => format!("[{index}] "),
            None => String::new(),
        };
        format!(
            "{place}{:.digits$} +- {:.digits$}, was {:?}",
            self.after, self.error, self.before
        )
    }
}
