//! Output as JSON, for `--json`.

use std::io::{self, Write};

use serde::Serialize;

/// Prints the value as a line of JSON if `is_json` is true, otherwise as the text that `text_of` returns.
///
/// # Errors
/// Fails if standard output cannot be written.
pub fn print_json_or_text(
    is_json: bool,
    value: &impl Serialize,
    text_of: impl FnOnce() -> String,
) -> Result<(), crate::Failure> {
    let mut out = io::stdout().lock();
    match is_json {
        true => write_line(&mut out, value)?,
        false => out.write_all(text_of().as_bytes())?,
    }
    Ok(())
}

/// Writes one value as one line of JSON.
///
/// # Errors
/// Fails if the output cannot be written.
pub fn write_line(out: &mut impl Write, value: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer(&mut *out, value)?;
    writeln!(out)
}
