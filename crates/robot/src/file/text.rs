//! The file itself, before anything in it has a meaning.

use std::io::Read;
use std::path::Path;

use crate::file::error::Problem;

/// Bytes that a robot file may have. A real one has some thousands; more is not
/// read, because a device or a pipe may never end.
pub const LONGEST: u64 = 1 << 20;

/// The text of a file, of which no more than [`LONGEST`] bytes are read.
pub(crate) fn read(path: &Path) -> Result<String, Problem> {
    let unreadable = |fault: std::io::Error| Problem::Unreadable(fault.to_string());
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(LONGEST + 1).read_to_end(&mut bytes))
        .map_err(unreadable)?;
    if bytes.len() as u64 > LONGEST {
        return Err(Problem::Huge { mib: LONGEST >> 20 });
    }
    String::from_utf8(bytes).map_err(|fault| {
        let before = &fault.as_bytes()[..fault.utf8_error().valid_up_to()];
        let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
        Problem::NotText(line)
    })
}
