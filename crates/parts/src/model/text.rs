//! The formats of XML elements, numbers and names in the model files.

use std::fmt::{Display, Write};

/// Factor from mm to m, and from g to kg.
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

/// Escapes a text for use as an attribute's value.
pub(super) fn escape_attribute(value: &str) -> String {
    let value = value.replace('&', "&amp;").replace('<', "&lt;");
    value.replace('"', "&quot;")
}

/// A writer of XML text, one element per line. An element is passed as its name and attributes.
#[derive(Default)]
pub(super) struct XmlWriter {
    text: String,
    /// Names of the open elements, outermost first.
    open_elements: Vec<String>,
}

impl XmlWriter {
    fn write_line(&mut self, text: impl Display) {
        let indent = self.open_elements.len();
        let _ = writeln!(self.text, "{:indent$}{text}", "");
    }

    /// Writes the XML declaration, a document's first line.
    pub fn write_declaration(&mut self) {
        self.write_line(r#"<?xml version="1.0"?>"#);
    }

    /// Writes an element without children.
    pub fn write_empty(&mut self, element: impl Display) {
        self.write_line(format_args!("<{element}/>"));
    }

    /// Writes an element with a value.
    pub fn write_value(&mut self, element: impl Display, value: impl Display) {
        let element = element.to_string();
        let name = element.split(' ').next().unwrap_or_default();
        self.write_line(format_args!("<{element}>{value}</{name}>"));
    }

    /// Opens an element with children.
    pub fn open(&mut self, element: impl Display) {
        let element = element.to_string();
        self.write_line(format_args!("<{element}>"));
        let name = element.split(' ').next().unwrap_or_default();
        self.open_elements.push(name.to_owned());
    }

    /// Closes the innermost open element.
    pub fn close(&mut self) {
        if let Some(name) = self.open_elements.pop() {
            self.write_line(format_args!("</{name}>"));
        }
    }

    /// Closes all open elements and returns the text.
    pub fn finish(mut self) -> String {
        while !self.open_elements.is_empty() {
            self.close();
        }
        self.text
    }
}
