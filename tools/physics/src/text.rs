//! Stored texts: the displacements as JSON, one entry per line, so that a diff shows each change; and the tables in the
//! documentation.

use std::collections::BTreeMap;
use std::fs;

use serde::Serialize;

use crate::crate_dir;

/// Formats a map as a JSON object with one line per key.
pub fn map_to_json<T: Serialize>(map: &BTreeMap<String, T>) -> String {
    format_object(map, to_json) + "\n"
}

/// Formats a map of maps as a JSON object of objects with one line per inner key.
pub fn nested_map_to_json<T: Serialize>(map: &BTreeMap<String, BTreeMap<String, T>>) -> String {
    format_object(map, |inner| format_object(inner, to_json)) + "\n"
}

/// Formats a map of maps of maps as nested JSON objects with one line per key of the innermost maps.
pub fn doubly_nested_map_to_json<T: Serialize>(
    map: &BTreeMap<String, BTreeMap<String, BTreeMap<String, T>>>,
) -> String {
    format_object(map, |outer| {
        format_object(outer, |inner| format_object(inner, to_json))
    }) + "\n"
}

/// Formats a map as a JSON object, one line per key, without a trailing newline.
pub(crate) fn format_object<T>(
    map: &BTreeMap<String, T>,
    format_value: impl Fn(&T) -> String,
) -> String {
    let format_line = |(key, value): (&String, &T)| format!("{key:?}: {}", format_value(value));
    let lines: Vec<String> = map.iter().map(format_line).collect();
    format!("{{\n{}\n}}", lines.join(",\n"))
}

pub(crate) fn to_json<T: Serialize>(value: &T) -> String {
    serde_json::to_string(value).expect("the value is serializable as JSON")
}

/// Asserts that the text between `begin` and `end` in one of the project's files equals `expected_text`; if
/// `BLESS_PHYSICS` is set, updates the file instead.
///
/// # Panics
/// Panics if the texts differ, or if `begin` or `end` is missing.
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
            "{path} is out of date; run with BLESS_PHYSICS=1"
        );
    }
}
