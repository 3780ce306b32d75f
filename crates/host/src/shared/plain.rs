//! Makes text from files and boards safe for a terminal.
//!
//! A terminal executes escape sequences: one in the name of a robot or in a recorded line moves the cursor, changes
//! the window's title or hides the text after it. So text from a file or a board is shown with control characters
//! spelled out.

/// The text with every control character as an escape of Rust, such as `\u{1b}`.
pub fn escape_controls(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() {
            result.extend(c.escape_default());
        } else {
            result.push(c);
        }
    }
    result
}

/// The text with every control character escaped, except line feeds; the middle of a very long line is omitted.
pub fn readable_lines(text: &str) -> String {
    let lines: Vec<String> = text
        .split('\n')
        .map(|line| shorten(&escape_controls(line)))
        .collect();
    lines.join("\n")
}

/// Replaces the middle of a very long line by the number of its characters.
fn shorten(line: &str) -> String {
    const SIDE: usize = 300;
    let count = line.chars().count();
    if count <= 3 * SIDE {
        return line.to_owned();
    }
    let start: String = line.chars().take(SIDE).collect();
    let end: String = line.chars().skip(count - SIDE).collect();
    format!("{start} [...{} characters...] {end}", count - 2 * SIDE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_too_long_to_read_loses_its_middle() {
        let [fits, long] = [900, 901].map(|count| "ä".repeat(count));
        assert_eq!(readable_lines(&fits), fits);
        let side = "ä".repeat(300);
        let shortened = format!("no\n{side} [...301 characters...] {side}");
        assert_eq!(readable_lines(&format!("no\n{long}")), shortened);
    }

    #[test]
    fn control_characters_are_spelled_out_and_all_others_stay() {
        assert_eq!(
            escape_controls("a\u{1b}]0;x\u{7}\u{9b}1m\t\r\n"),
            "a\\u{1b}]0;x\\u{7}\\u{9b}1m\\t\\r\\n"
        );
        assert_eq!(escape_controls("Ä 5 µs \\"), "Ä 5 µs \\");
        assert_eq!(readable_lines("a\nb\u{1b}\n"), "a\nb\\u{1b}\n");
    }
}
