//! What commands answer with `--json`.

use std::io::{self, Write};

use serde::Serialize;

/// Writes one value as one line of JSON.
///
/// # Errors
/// Writing failed.
pub fn line(out: &mut impl Write, value: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer(&mut *out, value)?;
    writeln!(out)
}
