//! The formats of XML elements, attribute values and numbers in the model files.

use std::fmt::{Display, Write};

/// Factor from mm to m, from g to kg, and from N mm to N m.
pub(super) const MILLI: f64 = 1e-3;

/// Formats a position in mm as three numbers in metres.
pub(super) fn format_metres(position: [f64; 3]) -> String {
    join_numbers(position.map(|component| round(component * MILLI)))
}

/// Rounds a number to nine decimals, and turns -0 into 0.
pub(super) fn round(value: f64) -> f64 {
    (value * 1e9).round() / 1e9 + 0.0
}

/// Joins numbers with spaces.
pub(super) fn join_numbers(numbers: impl IntoIterator<Item = impl ToString>) -> String {
    let numbers = numbers.into_iter().map(|number| number.to_string());
    numbers.collect::<Vec<_>>().join(" ")
}

/// Escapes a text for use as the value of an XML attribute; a line break becomes `&#10;`.
pub(super) fn escape_attribute(value: &str) -> String {
    let value = value.replace('&', "&amp;").replace('<', "&lt;");
    value.replace('"', "&quot;").replace('\n', "&#10;")
}

/// A writer of XML text, one element per line, each indented by its depth.
#[derive(Default)]
pub(super) struct XmlWriter {
    /// Lines written so far.
    pub text: String,
    /// Number of open elements.
    depth: usize,
}

impl XmlWriter {
    /// Writes lines, each with one complete element, or with one opening or closing tag. Each line's own indentation is
    /// replaced by that of its depth.
    pub fn write(&mut self, lines: impl Display) {
        let lines = lines.to_string();
        for line in lines.lines().map(str::trim_start) {
            if line.starts_with("</") {
                self.depth -= 1;
            }
            let indent = self.depth;
            let _ = writeln!(self.text, "{:indent$}{line}", "");
            let is_complete = line.contains("</") || line.ends_with("/>") || line.ends_with("?>");
            if !is_complete {
                self.depth += 1;
            }
        }
    }
}
