//! Splits received bytes into lines.
//!
//! Some terminals end a line with CR, some with LF, some with both. Here each CR and each LF ends a line. A line
//! that is empty or only white space is blank; blank lines are ignored, so CR LF ends only one line.

use heapless::Vec;

/// The largest length of a received line without its line end, in bytes.
pub const MAX_LINE_BYTES: usize = 63;

/// The kind of line that a line end completes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineKind {
    /// A complete line without garbled bytes; [`Line::text`] is its text.
    Valid,
    /// A line longer than [`MAX_LINE_BYTES`], which is dropped as a whole.
    TooLong,
    /// A line with a garbled byte. Its other bytes may form a command that was not sent.
    Garbled,
}

/// The byte that a board passes on in place of a byte that arrived garbled. Like any other byte that is not ASCII, it
/// makes its line garbled.
pub const GARBLED_BYTE: u8 = 0xff;

/// The line being received.
#[derive(Clone, Debug, Default)]
pub struct Line {
    bytes: Vec<u8, MAX_LINE_BYTES>,
    is_too_long: bool,
    is_garbled: bool,
    has_ended: bool,
}

impl Line {
    /// Creates an empty line.
    pub const fn new() -> Self {
        Self {
            bytes: Vec::new(),
            is_too_long: false,
            is_garbled: false,
            has_ended: false,
        }
    }

    /// Appends a byte; the byte after a line end begins a new line. Returns the kind of line that the byte completes,
    /// or `None` if the byte is not a line end or the line is blank.
    pub fn push(&mut self, byte: u8) -> Option<LineKind> {
        if self.has_ended {
            *self = Self::new();
        }
        match byte {
            b'\r' | b'\n' => self.end(),
            // Backspace and delete, for lines that are typed by hand.
            0x08 | 0x7f => {
                self.bytes.pop();
                None
            }
            // No command has such a byte, but most lines sent at another baud rate have one.
            0x80.. => {
                self.is_garbled = true;
                None
            }
            _ => {
                self.is_too_long |= self.bytes.push(byte.to_ascii_lowercase()).is_err();
                None
            }
        }
    }

    /// Marks a partial line as garbled, unless it is blank.
    pub fn mark_partial_line_garbled(&mut self) {
        self.is_garbled |= !self.has_ended && !self.text().is_empty();
    }

    /// The text of the line in lower case, without leading and trailing white space.
    pub fn text(&self) -> &[u8] {
        self.bytes.trim_ascii()
    }

    fn end(&mut self) -> Option<LineKind> {
        self.has_ended = true;
        if self.is_garbled {
            Some(LineKind::Garbled)
        } else if self.is_too_long {
            Some(LineKind::TooLong)
        } else if self.text().is_empty() {
            None
        } else {
            Some(LineKind::Valid)
        }
    }
}

#[cfg(test)]
mod tests {
    use std::string::{String, ToString};
    use std::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    /// Returns the text of every line that the bytes complete; `None` if the line is too long or garbled.
    fn split_lines(bytes: impl AsRef<[u8]>) -> Vec<Option<String>> {
        let mut line = Line::new();
        let mut lines = Vec::new();
        for byte in bytes.as_ref() {
            if let Some(kind) = line.push(*byte) {
                let text = line.text().iter().copied().map(char::from).collect();
                lines.push((kind == LineKind::Valid).then_some(text));
            }
        }
        lines
    }

    /// The reference implementation of [`split_lines`].
    fn split_lines_by_reference(bytes: &[u8]) -> Vec<Option<String>> {
        let mut lines = Vec::new();
        for line in bytes.split(|byte| matches!(byte, b'\r' | b'\n')) {
            let mut typed_text = String::new();
            let mut is_too_long_or_garbled = false;
            for byte in line {
                match byte {
                    0x08 | 0x7f => drop(typed_text.pop()),
                    0x80.. => is_too_long_or_garbled = true,
                    _ if typed_text.chars().count() == 63 => is_too_long_or_garbled = true,
                    _ => typed_text.push(char::from(*byte)),
                }
            }
            let text = typed_text.trim_matches([' ', '\t', '\x0c']);
            lines.push((!is_too_long_or_garbled).then(|| text.to_ascii_lowercase()));
        }
        // The last line has not ended yet.
        lines.pop();
        lines.retain(|line| line.as_deref() != Some(""));
        lines
    }

    #[test]
    fn cr_lf_or_both_end_a_line_and_blank_lines_are_ignored() {
        for line_end in ["\r", "\n", "\r\n", "\n\r", "\r\r\n\n", "\r \t \n"] {
            let bytes = std::format!("{line_end}one{line_end}two{line_end}");
            let expected_lines = ["one", "two"].map(|text| Some(text.to_string()));
            assert_eq!(split_lines(bytes), expected_lines, "{line_end:?}");
        }
    }

    #[test]
    fn a_line_longer_than_63_characters_is_dropped_and_does_not_affect_the_next() {
        for length in [62, 63, 64, 65, 200, 5000] {
            let text = "x".repeat(length);
            let bytes = std::format!("{text}\rstand\r");
            let first_line = (length <= 63).then_some(text);
            assert_eq!(split_lines(bytes), [first_line, Some("stand".to_string())]);
        }
        // Leading white space counts towards the 63 characters.
        assert_eq!(split_lines(std::format!("{:>64}\r", "stand")), [None]);
    }

    #[test]
    fn backspace_deletes_the_last_byte_and_does_nothing_on_an_empty_line() {
        for delete_byte in ["\x08", "\x7f"] {
            let five_deletions = delete_byte.repeat(5);
            for line in [
                std::format!("walt{delete_byte}k\r"),
                std::format!("{five_deletions}walk\r"),
            ] {
                assert_eq!(split_lines(line), [Some("walk".to_string())]);
            }
            assert_eq!(split_lines(std::format!("stand{five_deletions}\r")), []);
        }
    }

    #[test]
    fn the_text_of_a_line_is_in_lower_case_without_surrounding_white_space() {
        let text = "arc \t left".to_string();
        assert_eq!(split_lines("  Arc \t LEFT\t \n"), [Some(text)]);
    }

    #[test]
    fn a_line_with_a_garbled_byte_anywhere_is_dropped_despite_backspaces() {
        for index in 0..8 {
            let mut bytes = b"speed 90".to_vec();
            bytes[index] = GARBLED_BYTE;
            for correction in ["", "\x08", "\x08\x08\x08\x08\x08\x08\x08\x08\x08speed 90"] {
                let mut line = Line::new();
                let sent_bytes = [&bytes, correction.as_bytes(), b"\rstop\r"].concat();
                let line_kinds = sent_bytes.iter().filter_map(|byte| line.push(*byte));
                let line_kinds: Vec<LineKind> = line_kinds.collect();
                assert_eq!(line_kinds, [LineKind::Garbled, LineKind::Valid]);
                assert_eq!(line.text(), b"stop");
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn random_bytes_are_split_like_the_reference_implementation(
            pieces in prop::collection::vec(
                prop_oneof![
                    prop::collection::vec(any::<u8>(), 0..40),
                    "[ -~\x08\x7f\t]{0,80}[\r\n]{0,2}".prop_map(String::into_bytes),
                ],
                0..8,
            ),
        ) {
            let bytes = pieces.concat();
            prop_assert_eq!(split_lines(&bytes), split_lines_by_reference(&bytes));
        }
    }
}
