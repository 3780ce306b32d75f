//! The lines typed in earlier sessions, stored in a file in the user's state folder.

use std::path::PathBuf;

use crate::shared::files;

/// Returns the path `$XDG_STATE_HOME/lizard/history`; `$XDG_STATE_HOME` is ~/.local/state by default.
fn history_path() -> Option<PathBuf> {
    let folder = std::env::var_os("XDG_STATE_HOME").map(PathBuf::from);
    let default_folder = || Some(PathBuf::from(std::env::var_os("HOME")?).join(".local/state"));
    let folder = folder
        .filter(|folder| folder.is_absolute())
        .or_else(default_folder)?;
    Some(folder.join("lizard/history"))
}

/// Loads the lines, the oldest first; returns an empty list if the file cannot be read.
pub fn load() -> Vec<String> {
    let text = history_path().and_then(|path| std::fs::read_to_string(path).ok());
    let text = text.unwrap_or_default();
    text.lines().map(str::to_owned).collect()
}

/// Saves the lines. A failure is ignored: a session does not depend on its history.
pub fn save(lines: &[String]) {
    let Some(path) = history_path() else {
        return;
    };
    let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
    let _ = files::write(&path, text.as_bytes());
}
