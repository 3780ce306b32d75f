//! Writes the identified values into a robot.toml.

use lizard_robot::{Robot, edit};

use crate::error::IdentifyError;
use crate::outcome::{Identification, KeyResult};

impl Identification {
    /// Writes the changed keys, each with a comment, into the text of robot.toml. All other bytes stay unchanged.
    ///
    /// # Errors
    /// Fails if a key cannot be written into the text, or if the new values make robot.toml invalid.
    pub fn updated_robot_toml(&self, text: &str) -> Result<String, IdentifyError> {
        let mut new_text = text.to_owned();
        let mut names: Vec<&str> = self.changed_keys().map(|result| result.key.name).collect();
        names.dedup();
        for name in names {
            let key_results = self.keys.iter().filter(|result| result.key.name == name);
            new_text = write_key(&new_text, &key_results.collect::<Vec<_>>())
                .map_err(|error| IdentifyError::TextNotWritable(error.to_string()))?;
        }
        Robot::parse(&new_text).map_err(|error| IdentifyError::InvalidRobot(error.to_string()))?;
        Ok(new_text)
    }
}

/// Writes a key's value, a number or a list, with a comment about the changed numbers.
fn write_key(text: &str, results: &[&KeyResult]) -> Result<String, edit::KeyError> {
    let name = results[0].key.name;
    let values = results.iter().map(|result| result.rounded_value());
    let values: Vec<f64> = values.collect();
    let new_text = match results[0].key.list_index {
        Some(_) => edit::with_numbers(text, name, &values)?,
        None => edit::with_number(text, name, values[0])?,
    };
    let changed_results = results.iter().filter(|result| result.is_changed());
    let comments = changed_results.map(|result| result.format_comment());
    let comments: Vec<String> = comments.collect();
    edit::with_comment(&new_text, name, "measured:", &comments.join("; "))
}

impl KeyResult {
    /// The value for the new file, rounded if the verdict is `Changed`.
    fn rounded_value(&self) -> f64 {
        if !self.is_changed() {
            return self.file_value;
        }
        let scale = 10f64.powi(self.decimal_count() as i32);
        (self.new_value * scale).round() / scale
    }

    fn format_comment(&self) -> String {
        let decimals = self.decimal_count();
        let index = self.key.list_index;
        let index_text = index.map_or(String::new(), |index| format!("[{index}] "));
        format!(
            "{index_text}{:.decimals$} +- {:.decimals$}, was {:?}",
            self.new_value, self.error, self.file_value
        )
    }
}
