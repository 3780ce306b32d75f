//! Assembles serial bytes into lines.

use simulated_uno::SerialByte;

/// A line that the firmware has sent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// The cycle of the line end.
    pub cycle: u64,
    /// The text without the line end.
    pub text: String,
}

impl Line {
    /// True if the line answers a command; false for an information line (`# ...`).
    pub fn is_answer(&self) -> bool {
        !self.text.starts_with('#')
    }
}

/// Assembles lines and keeps a partial line until its end arrives.
#[derive(Debug, Default)]
pub struct LineReader {
    partial_line: String,
}

impl LineReader {
    /// Returns the lines that end within `bytes`.
    pub fn read<'a>(&'a mut self, bytes: &'a [SerialByte]) -> impl Iterator<Item = Line> + 'a {
        bytes.iter().filter_map(|byte| match byte.value {
            b'\n' => Some(Line {
                cycle: byte.cycle,
                text: std::mem::take(&mut self.partial_line),
            }),
            b'\r' => None,
            character => {
                self.partial_line.push(char::from(character));
                None
            }
        })
    }
}
