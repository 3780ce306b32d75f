//! Stored texts: the displacements as JSON, one entry per line, so that a diff shows each change; and the tables in the
//! documentation.

use std::fs;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::crate_dir;

/// Loads the results stored in a file of this crate's folder, such as `pads.json`.
///
/// # Panics
/// If the file is missing or does not have the format of the results.
pub fn load_stored<T: DeserializeOwned>(file: &str) -> T {
    let text = fs::read_to_string(crate_dir().join(file)).expect(file);
    serde_json::from_str(&text)
        .unwrap_or_else(|error| panic!("{file} does not have the expected format: {error}"))
}

/// Formats nested maps and lists as the text of a stored file: JSON with a line for each entry down to this depth.
///
/// # Panics
/// Never: names and numbers can always be written as JSON.
pub fn format_stored<T: Serialize>(results: &T, depth: usize) -> String {
    let value = serde_json::to_value(results).expect("the results are serializable as JSON");
    format_entries(&value, depth) + "\n"
}

/// Formats a value as JSON without a trailing newline.
fn format_entries(value: &Value, depth: usize) -> String {
    match value {
        Value::Object(map) if depth > 0 => {
            let format_line = |(key, value): (&String, &Value)| {
                format!("{key:?}: {}", format_entries(value, depth - 1))
            };
            let lines: Vec<String> = map.iter().map(format_line).collect();
            format!("{{\n{}\n}}", lines.join(",\n"))
        }
        Value::Array(items) if depth > 0 => {
            let lines = items.iter().map(|item| format_entries(item, depth - 1));
            format!("[\n{}\n]", lines.collect::<Vec<_>>().join(",\n"))
        }
        _ => value.to_string(),
    }
}

/// Asserts that the text between `begin` and `end` in one of the project's files equals `expected_text`; if
/// `BLESS_PHYSICS` is set, updates the file instead.
///
/// # Panics
/// If the texts differ and `BLESS_PHYSICS` is not set, or if `begin` or `end` is missing.
pub fn check_or_update_block(path: &str, begin: &str, end: &str, expected_text: &str) {
    let file = crate_dir().join("../..").join(path);
    let text = fs::read_to_string(&file).expect(path);
    let start = text.find(begin).expect(begin) + begin.len();
    let end_index = start + text[start..].find(end).expect(end);
    let new_text = format!("{}{expected_text}{}", &text[..start], &text[end_index..]);
    if std::env::var_os("BLESS_PHYSICS").is_some() {
        fs::write(&file, new_text).expect(path);
    } else {
        assert_eq!(
            text, new_text,
            "{path} is out of date; `make docs` updates it"
        );
    }
}
