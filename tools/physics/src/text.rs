//! The stored displacements as JSON with one entry per line, so that a diff shows each change.

use std::collections::BTreeMap;

use serde::Serialize;

/// Formats a map as a JSON object with one line per key.
///
/// # Panics
/// Never: the values are names and numbers.
pub fn lines<T: Serialize>(map: &BTreeMap<String, T>) -> String {
    joined(map, |value| serde_json::to_string(value).expect("numbers")) + "\n"
}

/// Formats a map of maps as a JSON object of objects with one line per inner key.
///
/// # Panics
/// Never: the values are names and numbers.
pub fn blocks<T: Serialize>(map: &BTreeMap<String, BTreeMap<String, T>>) -> String {
    joined(map, |inner| lines(inner).trim_end().to_owned()) + "\n"
}

fn joined<T>(map: &BTreeMap<String, T>, text: impl Fn(&T) -> String) -> String {
    let lines = map
        .iter()
        .map(|(key, value)| format!("{key:?}: {}", text(value)));
    format!("{{\n{}\n}}", lines.collect::<Vec<_>>().join(",\n"))
}
