//! XML elements, numbers and names as the model files write them.

use std::fmt::{Display, Write};

/// Metres per mm, kg per g.
pub(super) const MILLI: f64 = 1e-3;

/// Formats a position in mm as three numbers in metres.
pub(super) fn metres(position: [f64; 3]) -> String {
    position
        .map(|component| round(component * MILLI).to_string())
        .join(" ")
}

/// Rounds a number to nine decimals, and turns -0 into 0.
pub(super) fn round(value: f64) -> f64 {
    (value * 1e9).round() / 1e9 + 0.0
}

/// Joins numbers with blanks.
pub(super) fn join_numbers(numbers: impl IntoIterator<Item = impl ToString>) -> String {
    let numbers: Vec<_> = numbers
        .into_iter()
        .map(|number| number.to_string())
        .collect();
    numbers.join(" ")
}

/// Escapes a text for use as the value of an attribute.
pub(super) fn escape_attribute(value: &str) -> String {
    let value = value.replace('&', "&amp;").replace('<', "&lt;");
    value.replace('"', "&quot;")
}

/// XML text, one element per line. An element is given as its name and attributes.
#[derive(Default)]
pub(super) struct Xml {
    text: String,
    open: Vec<String>,
}

impl Xml {
    fn write_line(&mut self, text: impl Display) {
        let indent = self.open.len();
        let _ = writeln!(self.text, "{:indent$}{text}", "");
    }

    /// Writes the XML declaration, the first line of a document.
    pub fn declaration(&mut self) {
        self.write_line(r#"<?xml version="1.0"?>"#);
    }

    /// Writes an element without children.
    pub fn write_empty_element(&mut self, element: impl Display) {
        self.write_line(format_args!("<{element}/>"));
    }

    /// Writes an element that holds a value.
    pub fn value(&mut self, element: impl Display, value: impl Display) {
        let element = element.to_string();
        let name = element.split(' ').next().unwrap_or_default();
        self.write_line(format_args!("<{element}>{value}</{name}>"));
    }

    /// Opens an element with children.
    pub fn open(&mut self, element: impl Display) {
        let element = element.to_string();
        self.write_line(format_args!("<{element}>"));
        let name = element.split(' ').next().unwrap_or_default();
        self.open.push(name.to_owned());
    }

    /// Closes the innermost open element.
    pub fn close(&mut self) {
        if let Some(name) = self.open.pop() {
            self.write_line(format_args!("</{name}>"));
        }
    }

    /// The text, after all open elements are closed.
    pub fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.close();
        }
        self.text
    }
}
