//! Makes text from files and boards safe for a terminal.
//!
//! A terminal executes escape sequences. An escape sequence in a robot's name or in a recorded line could move the
//! cursor, change the window's title or hide text. Control characters from a file or a board are therefore escaped.

/// Returns the text with every control character replaced by a Rust escape such as `\u{1b}`.
pub fn escape_controls(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    for character in text.chars() {
        if character.is_control() {
            result.extend(character.escape_default());
        } else {
            result.push(character);
        }
    }
    result
}

/// Returns the text with every control character escaped, except line feeds. The middle of a very long line is
/// omitted.
pub fn make_readable(text: &str) -> String {
    let lines: Vec<String> = text
        .split('\n')
        .map(|line| shorten(&escape_controls(line)))
        .collect();
    lines.join("\n")
}

/// Replaces the middle of a very long line with the number of omitted characters.
fn shorten(line: &str) -> String {
    /// Number of characters that remain at each end.
    const SIDE_LENGTH: usize = 300;
    let char_count = line.chars().count();
    if char_count <= 3 * SIDE_LENGTH {
        return line.to_owned();
    }
    let start: String = line.chars().take(SIDE_LENGTH).collect();
    let end: String = line.chars().skip(char_count - SIDE_LENGTH).collect();
    format!(
        "{start} [...{} characters...] {end}",
        char_count - 2 * SIDE_LENGTH
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_very_long_line_loses_its_middle() {
        let [short_line, long_line] = [900, 901].map(|count| "ä".repeat(count));
        assert_eq!(make_readable(&short_line), short_line);
        let side = "ä".repeat(300);
        let expected = format!("no\n{side} [...301 characters...] {side}");
        assert_eq!(make_readable(&format!("no\n{long_line}")), expected);
    }

    #[test]
    fn only_control_characters_are_escaped() {
        assert_eq!(
            escape_controls("a\u{1b}]0;x\u{7}\u{9b}1m\t\r\n"),
            "a\\u{1b}]0;x\\u{7}\\u{9b}1m\\t\\r\\n"
        );
        assert_eq!(escape_controls("Ä 5 µs \\"), "Ä 5 µs \\");
        assert_eq!(make_readable("a\nb\u{1b}\n"), "a\nb\\u{1b}\n");
    }
}
