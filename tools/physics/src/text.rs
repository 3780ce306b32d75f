//! The stored displacements as JSON with one entry per line, so that a diff shows each change.

use std::collections::BTreeMap;

use serde::Serialize;

/// Formats a map as a JSON object with one line per key.
///
/// # Panics
/// Never: the values are names and numbers.
pub fn lines<T: Serialize>(map: &BTreeMap<String, T>) -> String {
    join_lines(map, |value| serde_json::to_string(value).expect("numbers")) + "\n"
}

/// Formats a map of maps as a JSON object of objects with one line per inner key.
///
/// # Panics
/// Never: the values are names and numbers.
pub fn blocks<T: Serialize>(map: &BTreeMap<String, BTreeMap<String, T>>) -> String {
    join_lines(map, |inner| lines(inner).trim_end().to_owned()) + "\n"
}

fn join_lines<T>(map: &BTreeMap<String, T>, text_of: impl Fn(&T) -> String) -> String {
    let lines = map
        .iter()
        .map(|(key, value)| format!("{key:?}: {}", text_of(value)));
    format!("{{\n{}\n}}", lines.collect::<Vec<_>>().join(",\n"))
}
