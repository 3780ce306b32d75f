//! Reads a robot file as text.

use std::io::Read;
use std::path::Path;

/// The largest size of a robot file, bytes. A real file has a few thousand bytes, but a device or a pipe might be
/// endless.
pub const MAX_FILE_BYTES: u64 = 1 << 20;

/// Reads a file of at most [`MAX_FILE_BYTES`] bytes.
///
/// # Errors
/// Returns a message if the file cannot be read, is too long, or is not UTF-8 text.
pub(crate) fn read_text(path: &Path) -> Result<String, String> {
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes))
        .map_err(|error| format!("cannot be read: {error}"))?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        let mib = MAX_FILE_BYTES >> 20;
        return Err(format!(
            "is longer than {mib} MiB, so it is not a robot file"
        ));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid_bytes = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = valid_bytes.iter().filter(|&&byte| byte == b'\n').count() + 1;
        format!("is not UTF-8 text: line {line} contains other bytes; save the file as UTF-8")
    })
}
