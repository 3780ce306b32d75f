//! The lines typed in earlier sessions, kept in the user's folder for such things.

use std::path::PathBuf;

use crate::shared::files;

/// `$XDG_STATE_HOME/lizard/history`, by default in ~/.local/state.
fn path() -> Option<PathBuf> {
    let folder = std::env::var_os("XDG_STATE_HOME").map(PathBuf::from);
    let home = || Some(PathBuf::from(std::env::var_os("HOME")?).join(".local/state"));
    let folder = folder.filter(|folder| folder.is_absolute()).or_else(home)?;
    Some(folder.join("lizard/history"))
}

/// The lines, the oldest first; none if there is no such file.
#[must_use]
pub fn load() -> Vec<String> {
    let text = path().and_then(|path| std::fs::read_to_string(path).ok());
    let text = text.unwrap_or_default();
    text.lines().map(str::to_owned).collect()
}

/// Keeps the lines. A folder that cannot be written to is no reason to complain.
pub fn save(lines: &[String]) {
    let Some(path) = path() else {
        return;
    };
    let _ = files::write(&path, (lines.join("\n") + "\n").as_bytes());
}
