//! The serial console as its user sees it: bytes put together into lines.

use simulated_uno::{SerialByte, Uno};

/// A line that the robot has sent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// Cycle at which it ended.
    pub cycle: u64,
    /// Its text without the line end.
    pub text: String,
}

impl Line {
    /// Whether this is a command's one final line, not information.
    #[must_use]
    pub fn is_answer(&self) -> bool {
        !self.text.starts_with('#')
    }
}

/// Everything the robot has sent since power-on.
#[derive(Debug, Default)]
pub struct Console {
    bytes: Vec<SerialByte>,
    lines: Vec<Line>,
    partial: String,
}

impl Console {
    /// Takes over what the robot has sent since the last call.
    pub fn collect(&mut self, uno: &mut Uno) {
        for byte in uno.take_transmitted() {
            self.bytes.push(byte);
            match byte.byte {
                b'\n' => self.lines.push(Line {
                    cycle: byte.cycle,
                    text: std::mem::take(&mut self.partial),
                }),
                b'\r' => {}
                other => self.partial.push(char::from(other)),
            }
        }
    }

    /// The whole lines collected so far.
    #[must_use]
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// The bytes collected so far.
    #[must_use]
    pub fn bytes(&self) -> &[SerialByte] {
        &self.bytes
    }
}
