//! JSON output, for `--json`.

use std::io::{self, Write};

use serde::Serialize;

/// Prints the value as a line of JSON if `prints_json` is true, otherwise the text that `format_text` returns.
///
/// # Errors
/// Fails if standard output cannot be written.
pub fn print_json_or_text(
    prints_json: bool,
    value: &impl Serialize,
    format_text: impl FnOnce() -> String,
) -> Result<(), crate::Failure> {
    let mut out = io::stdout().lock();
    match prints_json {
        true => write_line(&mut out, value)?,
        false => out.write_all(format_text().as_bytes())?,
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
