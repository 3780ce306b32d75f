//! The pictures of a folder in order, and their times.

use std::fs;
use std::path::{Path, PathBuf};

use crate::Failure;

/// File extensions of pictures.
const PICTURE_EXTENSIONS: [&str; 3] = ["png", "jpg", "jpeg"];

/// Returns the pictures of a folder in the order of the numbers in their names, each with its time, s.
///
/// # Errors
/// Fails if the folder cannot be read or has no pictures, or if neither `rate` nor the names give the times.
pub(super) fn list_pictures(
    folder: &Path,
    rate: Option<f64>,
) -> Result<Vec<(f64, PathBuf)>, Failure> {
    let read_failure = |error: std::io::Error| {
        Failure::Input(format!("cannot read {}: {error}", folder.display()))
    };
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(read_failure)? {
        let path = entry.map_err(read_failure)?.path();
        let extension = path
            .extension()
            .map(|extension| extension.to_string_lossy().to_lowercase());
        if extension.is_some_and(|extension| PICTURE_EXTENSIONS.contains(&&*extension)) {
            files.push((stem_of(&path), path));
        }
    }
    if files.is_empty() {
        return Err(Failure::Input(format!(
            "{} has no pictures: .png, .jpg or .jpeg",
            folder.display()
        )));
    }
    files.sort_by_key(|(stem, _)| sort_key(stem));
    let timed_picture = |(index, (stem, path)): (usize, (String, PathBuf))| match rate {
        Some(rate) => Ok((index as f64 / rate, path)),
        None => match parse_seconds(&stem) {
            Some(seconds) => Ok((seconds, path)),
            None => Err(Failure::Input(format!(
                "the times of the pictures are unknown: --fps 30 gives the film's frames per second, or name \
                 the files by their times, such as 1.033s.png or 1033ms.png; {} tells none",
                path.display()
            ))),
        },
    };
    files.into_iter().enumerate().map(timed_picture).collect()
}

fn stem_of(path: &Path) -> String {
    path.file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// A sort key for a name: its numbers and words, so that 10 comes after 9.
fn sort_key(name: &str) -> Vec<(u64, String)> {
    let mut parts: Vec<(u64, String)> = Vec::new();
    let mut was_digit = None;
    for character in name.chars() {
        if was_digit != Some(character.is_ascii_digit()) {
            parts.push((0, String::new()));
            was_digit = Some(character.is_ascii_digit());
        }
        if let Some((number, word)) = parts.last_mut() {
            match character.to_digit(10) {
                Some(digit) => *number = number.saturating_mul(10).saturating_add(u64::from(digit)),
                None => word.push(character),
            }
        }
    }
    parts
}

/// The time at the end of a name such as `walk-1.033s` or `walk-1033ms`, s; `None` if the name does not end with a
/// number and its unit.
fn parse_seconds(stem: &str) -> Option<f64> {
    let (number, unit) = match stem.strip_suffix("ms") {
        Some(number) => (number, 1e-3),
        None => (stem.strip_suffix('s')?, 1.0),
    };
    let last_non_digit = number.rfind(|c: char| !(c.is_ascii_digit() || c == '.'));
    let number = &number[last_non_digit.map_or(0, |index| index + 1)..];
    let value: f64 = number.parse().ok()?;
    Some(value * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_contains_a_time_only_with_its_unit() {
        assert_eq!(parse_seconds("walk-1033ms"), Some(1.033));
        assert_eq!(parse_seconds("1.5s"), Some(1.5));
        for name in ["frame-0001", "1.5", "s", "films", "1.2.3s"] {
            assert_eq!(parse_seconds(name), None, "{name}");
        }
    }

    #[test]
    fn ten_comes_after_nine() {
        assert!(sort_key("frame-9") < sort_key("frame-10"));
        assert!(sort_key("0.9s") < sort_key("0.10s"));
        assert!(sort_key("a2b1") < sort_key("a2b3"));
    }
}
