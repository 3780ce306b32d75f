//! A stream of poses as comma-separated values. One line is held at a time, so
//! a file of any length takes the same memory.

use std::io::{BufRead, Read};

use lizard_kinematics::Pose;

use crate::Failure;

/// The columns, in the order of the paper's Algorithm 1; a file may have them in
/// any order.
pub const COLUMNS: [&str; 4] = ["theta1", "theta4", "theta5", "theta8"];

/// Longer lines are not poses, and are not read to their end.
const LONGEST_LINE: u64 = 1024;

/// Poses of a CSV text with a header line. Blank lines are skipped, lines end
/// in LF or CRLF, numbers may stand in double quotes.
pub struct Poses<R> {
    input: R,
    line: Vec<u8>,
    number: usize,
    /// What each field of a line is: an index into `COLUMNS`.
    order: [usize; 4],
}

impl<R: BufRead> Poses<R> {
    /// Reads the header.
    pub fn new(input: R) -> Result<Self, Failure> {
        let mut poses = Self {
            input,
            line: Vec::new(),
            number: 0,
            order: [0; 4],
        };
        let wanted = COLUMNS.join(",");
        if !poses.advance()? {
            return Err(Failure::Input(format!(
                "line 1, column 1: the input is empty, expected the header {wanted}"
            )));
        }
        let number = poses.number;
        let wrong = |column: usize, what: String| {
            Failure::Input(format!(
                "line {number}, column {column}: {what}; the header is {wanted}, in any order"
            ))
        };
        let text = poses.text()?;
        let names: Vec<&str> = text
            .trim_start_matches('\u{feff}')
            .split(',')
            .map(bare)
            .collect();
        let mut order = [0; 4];
        for (i, name) in names.iter().enumerate() {
            let Some(column) = COLUMNS.iter().position(|column| column == name) else {
                return Err(wrong(i + 1, format!("\"{name}\" is not a column")));
            };
            if names[..i].contains(name) {
                return Err(wrong(i + 1, format!("\"{name}\" comes twice")));
            }
            order[i] = column;
        }
        if let Some(missing) = COLUMNS.iter().find(|column| !names.contains(column)) {
            return Err(wrong(names.len() + 1, format!("{missing} is missing")));
        }
        poses.order = order;
        Ok(poses)
    }

    /// Reads the next line that is not blank; false at the end.
    fn advance(&mut self) -> Result<bool, Failure> {
        loop {
            self.line.clear();
            let read = (&mut self.input)
                .take(LONGEST_LINE)
                .read_until(b'\n', &mut self.line)?;
            if read == 0 {
                return Ok(false);
            }
            self.number += 1;
            if read as u64 == LONGEST_LINE && !self.line.ends_with(b"\n") {
                return Err(Failure::Input(format!(
                    "line {}, column 1: longer than {LONGEST_LINE} bytes",
                    self.number
                )));
            }
            if !self.line.iter().all(u8::is_ascii_whitespace) {
                return Ok(true);
            }
        }
    }

    fn text(&self) -> Result<&str, Failure> {
        std::str::from_utf8(&self.line)
            .map(|text| text.trim_end_matches(['\n', '\r']))
            .map_err(|fault| {
                let before = &self.line[..fault.valid_up_to()];
                let column = before.iter().filter(|&&byte| byte == b',').count() + 1;
                Failure::Input(format!(
                    "line {}, column {column}: not UTF-8 text",
                    self.number
                ))
            })
    }

    fn parse(&self) -> Result<Pose, Failure> {
        let mut values = [0.0; 4];
        let mut count = 0;
        let at = |field: usize, what: String| {
            let name = match self.order.get(field) {
                Some(&column) => format!(" ({})", COLUMNS[column]),
                None => String::new(),
            };
            Failure::Input(format!(
                "line {}, column {}{name}: {what}",
                self.number,
                field + 1
            ))
        };
        for (field, text) in self.text()?.split(',').enumerate() {
            let text = bare(text);
            let Some(&column) = self.order.get(field) else {
                return Err(at(field, format!("\"{text}\" is one value too many")));
            };
            values[column] = match text.parse::<f64>() {
                Ok(value) if value.is_finite() => value,
                Ok(_) => return Err(at(field, format!("\"{text}\" is not a finite number"))),
                Err(_) if text.is_empty() => return Err(at(field, "no value".to_string())),
                Err(_) => return Err(at(field, format!("\"{text}\" is not a number"))),
            };
            count = field + 1;
        }
        if count < 4 {
            return Err(at(count, "no value".to_string()));
        }
        let [theta1, theta4, theta5, theta8] = values;
        Ok(Pose {
            theta1,
            theta4,
            theta8,
            theta5,
        })
    }
}

impl<R: BufRead> Iterator for Poses<R> {
    type Item = Result<Pose, Failure>;

    fn next(&mut self) -> Option<Self::Item> {
        match self.advance() {
            Ok(true) => Some(self.parse()),
            Ok(false) => None,
            Err(failure) => Some(Err(failure)),
        }
    }
}

/// A field without blanks and without quotes around it.
fn bare(field: &str) -> &str {
    let field = field.trim();
    field
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'))
        .unwrap_or(field)
}
