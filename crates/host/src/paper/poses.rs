//! A stream of poses as comma-separated values. Only one line is in memory at a time, so the stream may have any
//! length.

use std::fmt::Display;
use std::io::{BufRead, Read};

use lizard_kinematics::Pose;

use crate::Failure;
use crate::shared::pose_args::ANGLE_NAMES;
use crate::shared::quantity::Quantity;

/// Names of the columns: the angles in servo order, and the optional time, as in `lizard gaits --trace`.
const COLUMN_NAMES: [&str; 5] = {
    let [a1, a2, a3, a4] = ANGLE_NAMES;
    [a1, a2, a3, a4, "seconds"]
};

/// Index of the time column in [`COLUMN_NAMES`].
const SECONDS_COLUMN: usize = 4;

/// Largest length of a line, bytes. A longer line is refused before it is read completely.
const MAX_LINE_BYTES: u64 = 1024;

/// A pose in the stream, with its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedPose {
    /// Time, s; `None` if the stream has no column `seconds`.
    pub seconds: Option<f64>,
    /// The servo angles.
    pub pose: Pose,
}

/// Iterator over the poses in a CSV text. The first line may be a header that names the columns, in any order. Without
/// a header, the columns are A1, A2, A3, A4. Lines end in LF or CRLF. Blank lines and a byte order mark are ignored.
/// Names and numbers may be in double quotes.
pub struct PoseReader<R> {
    input: R,
    line_bytes: Vec<u8>,
    line_number: usize,
    /// The column of each field of a line, as an index in [`COLUMN_NAMES`].
    columns: Vec<usize>,
    /// True while the first line is a pose instead of a header and has not been returned.
    has_pending_line: bool,
}

impl<R: BufRead> PoseReader<R> {
    /// Creates the iterator and reads the header, if any.
    ///
    /// # Errors
    /// Fails if the input is empty or cannot be read, or if its header is invalid.
    pub fn new(input: R) -> Result<Self, Failure> {
        let mut poses = Self {
            input,
            line_bytes: Vec::new(),
            line_number: 0,
            columns: (0..SECONDS_COLUMN).collect(),
            has_pending_line: false,
        };
        let expected = ANGLE_NAMES.join(",");
        if !poses.read_next_line()? {
            return Err(Failure::Input(format!(
                "line 1, column 1: the input is empty, expected the header {expected}"
            )));
        }
        let text = poses.line_text()?;
        let names: Vec<&str> = text.split(',').map(trim_quotes).collect();
        // A header contains no number; a pose does.
        if names.iter().any(|name| name.parse::<f64>().is_ok()) {
            poses.has_pending_line = true;
            return Ok(poses);
        }
        let header_failure = |column: usize, problem: String| {
            let expected = format!("the header {expected} in any order, optionally with seconds");
            poses.failure(column, format!("{problem}; expected {expected}"))
        };
        let mut columns = Vec::with_capacity(names.len());
        for (i, name) in names.iter().enumerate() {
            let Some(column) = COLUMN_NAMES.iter().position(|known| known == name) else {
                return Err(header_failure(i + 1, format!("\"{name}\" is not a column")));
            };
            if columns.contains(&column) {
                let problem = format!("duplicate column \"{name}\"");
                return Err(header_failure(i + 1, problem));
            }
            columns.push(column);
        }
        if let Some(missing) = (0..SECONDS_COLUMN).find(|angle| !columns.contains(angle)) {
            let problem = format!("{} is missing", ANGLE_NAMES[missing]);
            return Err(header_failure(names.len() + 1, problem));
        }
        poses.columns = columns;
        Ok(poses)
    }

    /// True if the lines have a time column.
    pub fn has_time(&self) -> bool {
        self.columns.contains(&SECONDS_COLUMN)
    }

    /// Reads the next line that is not blank. Returns false at the end of the input.
    fn read_next_line(&mut self) -> Result<bool, Failure> {
        loop {
            self.line_bytes.clear();
            let byte_count = (&mut self.input)
                .take(MAX_LINE_BYTES + 1)
                .read_until(b'\n', &mut self.line_bytes)?;
            if byte_count == 0 {
                return Ok(false);
            }
            self.line_number += 1;
            if byte_count as u64 > MAX_LINE_BYTES && !self.line_bytes.ends_with(b"\n") {
                return Err(self.failure(1, format!("longer than {MAX_LINE_BYTES} bytes")));
            }
            if !self.line_bytes.iter().all(u8::is_ascii_whitespace) {
                return Ok(true);
            }
        }
    }

    /// Returns the text of the current line, without its line ending and a byte order mark.
    fn line_text(&self) -> Result<&str, Failure> {
        let text = std::str::from_utf8(&self.line_bytes).map_err(|error| {
            let valid_bytes = &self.line_bytes[..error.valid_up_to()];
            let column = valid_bytes.iter().filter(|&&byte| byte == b',').count() + 1;
            self.failure(column, "not UTF-8 text")
        })?;
        let text = match self.line_number {
            1 => text.strip_prefix('\u{feff}').unwrap_or(text),
            _ => text,
        };
        Ok(text.trim_end_matches(['\n', '\r']))
    }

    /// Returns the failure for a problem in a column of the current line.
    fn failure(&self, column: impl Display, problem: impl Display) -> Failure {
        let line = self.line_number;
        Failure::Input(format!("line {line}, column {column}: {problem}"))
    }

    /// Parses the current line as a pose.
    fn parse_line(&self) -> Result<TimedPose, Failure> {
        let mut values = [0.0; COLUMN_NAMES.len()];
        let mut value_count = 0;
        let field_failure = |field: usize, problem: String| {
            let name = match self.columns.get(field) {
                Some(&column) => format!(" ({})", COLUMN_NAMES[column]),
                None => String::new(),
            };
            self.failure(format!("{}{name}", field + 1), problem)
        };
        for (field, text) in self.line_text()?.split(',').enumerate() {
            let text = trim_quotes(text);
            let Some(&column) = self.columns.get(field) else {
                return Err(field_failure(field, format!("unexpected value \"{text}\"")));
            };
            if text.is_empty() {
                return Err(field_failure(field, "no value".to_string()));
            }
            let quantity = match column {
                SECONDS_COLUMN => Quantity::TIME,
                _ => Quantity::ANGLE,
            };
            values[column] = quantity
                .parse(text)
                .map_err(|error| field_failure(field, format!("\"{text}\" {error}")))?;
            value_count = field + 1;
        }
        if value_count < self.columns.len() {
            return Err(field_failure(value_count, "no value".to_string()));
        }
        let [angles @ .., seconds] = values;
        Ok(TimedPose {
            seconds: self.has_time().then_some(seconds),
            pose: Pose::from(angles),
        })
    }
}

impl<R: BufRead> Iterator for PoseReader<R> {
    type Item = Result<TimedPose, Failure>;

    fn next(&mut self) -> Option<Self::Item> {
        if std::mem::take(&mut self.has_pending_line) {
            return Some(self.parse_line());
        }
        match self.read_next_line() {
            Ok(true) => Some(self.parse_line()),
            Ok(false) => None,
            Err(failure) => Some(Err(failure)),
        }
    }
}

/// Removes surrounding whitespace and quotes from a field.
fn trim_quotes(field: &str) -> &str {
    let field = field.trim();
    field
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'))
        .unwrap_or(field)
}
