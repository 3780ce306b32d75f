//! A stream of poses as comma-separated values. Only one line is in memory at a time, so the stream may have any
//! length.

use std::io::{BufRead, Read};

use lizard_kinematics::Pose;

use crate::Failure;
use crate::shared::pose_args::ANGLE_NAMES;
use crate::shared::quantity::{NumberError, Quantity};

/// Name of the optional time column, as in `lizard gaits --trace`.
const SECONDS: &str = "seconds";

/// A column of the stream: an angle or the time.
#[derive(Clone, Copy, PartialEq)]
enum Column {
    Angle(usize),
    Seconds,
}

impl Column {
    fn name(self) -> &'static str {
        match self {
            Self::Angle(servo) => ANGLE_NAMES[servo],
            Self::Seconds => SECONDS,
        }
    }

    fn from_name(name: &str) -> Option<Self> {
        if name == SECONDS {
            return Some(Self::Seconds);
        }
        let servo = ANGLE_NAMES.iter().position(|angle| *angle == name)?;
        Some(Self::Angle(servo))
    }
}

/// The columns of a stream without a header.
const DEFAULT_COLUMNS: [Column; 4] = [
    Column::Angle(0),
    Column::Angle(1),
    Column::Angle(2),
    Column::Angle(3),
];

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
    /// The column of each field of a line.
    columns: Vec<Column>,
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
            columns: DEFAULT_COLUMNS.to_vec(),
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
        let line_number = poses.line_number;
        let header_failure = |column: usize, problem: String| {
            Failure::Input(format!(
                "line {line_number}, column {column}: {problem}; expected the header {expected} in any order, \
                 optionally with {SECONDS}"
            ))
        };
        let mut columns = Vec::with_capacity(names.len());
        for (i, name) in names.iter().enumerate() {
            let Some(column) = Column::from_name(name) else {
                return Err(header_failure(i + 1, format!("\"{name}\" is not a column")));
            };
            if columns.contains(&column) {
                return Err(header_failure(
                    i + 1,
                    format!("duplicate column \"{name}\""),
                ));
            }
            columns.push(column);
        }
        if let Some(missing_column) = DEFAULT_COLUMNS
            .iter()
            .find(|angle| !columns.contains(angle))
        {
            let missing_column = missing_column.name();
            return Err(header_failure(
                names.len() + 1,
                format!("{missing_column} is missing"),
            ));
        }
        poses.columns = columns;
        Ok(poses)
    }

    /// True if the lines have a time column.
    pub fn has_time(&self) -> bool {
        self.columns.contains(&Column::Seconds)
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
                return Err(Failure::Input(format!(
                    "line {}, column 1: longer than {MAX_LINE_BYTES} bytes",
                    self.line_number
                )));
            }
            if !self.line_bytes.iter().all(u8::is_ascii_whitespace) {
                return Ok(true);
            }
        }
    }

    /// Returns the text of the current line, without its line ending and a byte order mark.
    fn line_text(&self) -> Result<&str, Failure> {
        std::str::from_utf8(&self.line_bytes)
            .map(|text| {
                let is_first = self.line_number == 1;
                let text = text
                    .strip_prefix('\u{feff}')
                    .filter(|_| is_first)
                    .unwrap_or(text);
                text.trim_end_matches(['\n', '\r'])
            })
            .map_err(|error| {
                let valid_bytes = &self.line_bytes[..error.valid_up_to()];
                let column = valid_bytes.iter().filter(|&&byte| byte == b',').count() + 1;
                Failure::Input(format!(
                    "line {}, column {column}: not UTF-8 text",
                    self.line_number
                ))
            })
    }

    /// Parses the current line as a pose.
    fn parse_line(&self) -> Result<TimedPose, Failure> {
        let mut angles = [0.0; 4];
        let mut seconds = None;
        let mut value_count = 0;
        let field_failure = |field: usize, problem: String| {
            let name = match self.columns.get(field) {
                Some(column) => format!(" ({})", column.name()),
                None => String::new(),
            };
            Failure::Input(format!(
                "line {}, column {}{name}: {problem}",
                self.line_number,
                field + 1
            ))
        };
        for (field, text) in self.line_text()?.split(',').enumerate() {
            let text = trim_quotes(text);
            let Some(&column) = self.columns.get(field) else {
                return Err(field_failure(field, format!("unexpected value \"{text}\"")));
            };
            if text.is_empty() {
                return Err(field_failure(field, "no value".to_string()));
            }
            let number_failure =
                |error: NumberError| field_failure(field, format!("\"{text}\" {error}"));
            match column {
                Column::Angle(servo) => {
                    angles[servo] = Quantity::ANGLE.parse(text).map_err(number_failure)?;
                }
                Column::Seconds => {
                    seconds = Some(Quantity::TIME.parse(text).map_err(number_failure)?);
                }
            }
            value_count = field + 1;
        }
        if value_count < self.columns.len() {
            return Err(field_failure(value_count, "no value".to_string()));
        }
        Ok(TimedPose {
            seconds,
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
