//! Bytes into lines.
//!
//! Terminals disagree about line ends: some send CR, some LF, some both. Each
//! ends a line here, and since an empty line is no line, CRLF ends just one.

use heapless::Vec;

/// The longest line, without its end.
pub const LONGEST: usize = 63;

/// What a byte completed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// A line, to be read with [`Line::text`].
    Line,
    /// A line that was longer than [`LONGEST`]; all of it is dropped.
    TooLong,
}

/// The line that is being received.
#[derive(Debug, Default)]
pub struct Line {
    bytes: Vec<u8, LONGEST>,
    overlong: bool,
    ended: bool,
}

impl Line {
    /// An empty line.
    pub const fn new() -> Self {
        Self {
            bytes: Vec::new(),
            overlong: false,
            ended: false,
        }
    }

    /// Takes a byte. After a line has ended, the next byte begins a new one.
    pub fn push(&mut self, byte: u8) -> Option<Ended> {
        if self.ended {
            *self = Self::new();
        }
        match byte {
            b'\r' | b'\n' => self.end(),
            // Backspace and delete, for those who type by hand.
            0x08 | 0x7f => {
                self.bytes.pop();
                None
            }
            _ => {
                self.overlong |= self.bytes.push(byte.to_ascii_lowercase()).is_err();
                None
            }
        }
    }

    /// The line in lower case, without blanks around it.
    pub fn text(&self) -> &[u8] {
        self.bytes.trim_ascii()
    }

    fn end(&mut self) -> Option<Ended> {
        self.ended = true;
        if self.overlong {
            Some(Ended::TooLong)
        } else if self.text().is_empty() {
            None
        } else {
            Some(Ended::Line)
        }
    }
}
