//! Text files: JSON of stored displacements with one entry per line, so that a diff shows each change, and the tables
//! in the documentation.

use std::collections::BTreeMap;
use std::fs;

use serde::Serialize;

use crate::crate_dir;

/// Formats a map as a JSON object with one line per key.
///
/// # Panics
/// Never: the values are names and numbers.
pub fn format_lines<T: Serialize>(map: &BTreeMap<String, T>) -> String {
    join_lines(map, to_json) + "\n"
}

/// Formats a map of maps as a JSON object of objects with one line per inner key.
///
/// # Panics
/// Never: the values are names and numbers.
pub fn format_blocks<T: Serialize>(map: &BTreeMap<String, BTreeMap<String, T>>) -> String {
    join_lines(map, |inner| join_lines(inner, to_json)) + "\n"
}

/// Formats maps as a JSON object of objects with one line per key of the innermost map.
///
/// # Panics
/// Never: the values are names and numbers.
pub fn format_nested_blocks<T: Serialize>(
    map: &BTreeMap<String, BTreeMap<String, BTreeMap<String, T>>>,
) -> String {
    join_lines(map, |outer| {
        join_lines(outer, |inner| join_lines(inner, to_json))
    }) + "\n"
}

/// Formats a map as a JSON object, without a line feed at its end.
pub(crate) fn join_lines<T>(
    map: &BTreeMap<String, T>,
    format_value: impl Fn(&T) -> String,
) -> String {
    let lines = map
        .iter()
        .map(|(key, value)| format!("{key:?}: {}", format_value(value)));
    format!("{{\n{}\n}}", lines.collect::<Vec<_>>().join(",\n"))
}

pub(crate) fn to_json<T: Serialize>(value: &T) -> String {
    serde_json::to_string(value).expect("numbers can be written as JSON")
}

/// Compares the text between `begin` and `end` in one of the project's files with `expected_text`. Replaces the text
/// instead if `BLESS_PHYSICS` is set.
///
/// # Panics
/// If the texts differ, or if `begin` or `end` is missing.
pub fn check_block(path: &str, begin: &str, end: &str, expected_text: &str) {
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
            "{path} is out of date; run with BLESS_PHYSICS=1"
        );
    }
}
