//! Output as JSON, for `--json`.

use std::io::{self, Write};

use serde::Serialize;

/// Prints the value as a line of JSON if `json` is true, else as the text that `text` returns.
///
/// # Errors
/// Fails if standard output cannot be written.
pub fn print_json_or(
    json: bool,
    value: &impl Serialize,
    text: impl FnOnce() -> String,
) -> Result<(), crate::Failure> {
    let mut out = io::stdout().lock();
    match json {
        true => write_line(&mut out, value)?,
        false => out.write_all(text().as_bytes())?,
    }
    Ok(())
}

/// Writes one value as one line of JSON.
///
/// # Errors
/// Fails if writing fails.
pub fn write_line(out: &mut impl Write, value: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer(&mut *out, value)?;
    writeln!(out)
}
