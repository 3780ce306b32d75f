//! Serial bytes put together into lines.

use simulated_uno::SerialByte;

/// A line that the robot has sent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// The cycle at which the line ended.
    pub cycle: u64,
    /// The text without the line end.
    pub text: String,
}

impl Line {
    /// True if this is the final line of a command's answer, not information.
    pub fn is_answer(&self) -> bool {
        !self.text.starts_with('#')
    }
}

/// The beginning of a line whose end has not come yet.
#[derive(Debug, Default)]
pub struct LineReader {
    partial: String,
}

impl LineReader {
    /// The lines that end within `bytes`.
    pub fn read<'a>(&'a mut self, bytes: &'a [SerialByte]) -> impl Iterator<Item = Line> + 'a {
        bytes.iter().filter_map(|byte| match byte.byte {
            b'\n' => Some(Line {
                cycle: byte.cycle,
                text: std::mem::take(&mut self.partial),
            }),
            b'\r' => None,
            other => {
                self.partial.push(char::from(other));
                None
            }
        })
    }
}
