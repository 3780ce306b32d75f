//! Lists the frames in a folder, with their times.

use std::borrow::Cow;
use std::fs;
use std::path::{Path, PathBuf};

use crate::Failure;

/// File extensions of frames.
const FRAME_EXTENSIONS: [&str; 3] = ["png", "jpg", "jpeg"];

/// Lists the frames in a folder, each with its time, s, in the order of time. If every name contains a time, the frames
/// are sorted by these times, otherwise by the numbers in the names. With `frame_rate`, each frame's time follows from
/// its place in this order; without it, the time is that in the name.
///
/// # Errors
/// Fails if the folder cannot be read or has no frames, or if neither `frame_rate` nor the names give the times.
pub(super) fn list_frames(
    folder: &Path,
    frame_rate: Option<f64>,
) -> Result<Vec<(f64, PathBuf)>, Failure> {
    let read_failure = |error: std::io::Error| {
        Failure::Input(format!("cannot read {}: {error}", folder.display()))
    };
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(read_failure)? {
        let path = entry.map_err(read_failure)?.path();
        let extension = path.extension().unwrap_or_default();
        let extension = extension.to_string_lossy().to_lowercase();
        if FRAME_EXTENSIONS.contains(&extension.as_str()) {
            files.push(path);
        }
    }
    if files.is_empty() {
        return Err(Failure::Input(format!(
            "{} has no frames: .png, .jpg or .jpeg files",
            folder.display()
        )));
    }
    files.sort_by_key(|path| split_for_sorting(&stem(path)));
    if files
        .iter()
        .all(|path| parse_seconds(&stem(path)).is_some())
    {
        let seconds = |path: &PathBuf| parse_seconds(&stem(path)).unwrap_or_default();
        files.sort_by(|a, b| seconds(a).total_cmp(&seconds(b)));
    }
    let to_timed_frame = |(index, path): (usize, PathBuf)| {
        let seconds = match frame_rate {
            Some(frame_rate) => Some(index as f64 / frame_rate),
            None => parse_seconds(&stem(&path)),
        };
        let unknown_time = || {
            Failure::Input(format!(
                "the time of {} is unknown: give the frames per second, for example --fps 30, or name the files by \
                 their times, such as 1.033s.png or 1033ms.png",
                path.display()
            ))
        };
        let seconds = seconds.ok_or_else(unknown_time)?;
        Ok((seconds, path))
    };
    files.into_iter().enumerate().map(to_timed_frame).collect()
}

/// Returns a file's name without its extension.
fn stem(path: &Path) -> Cow<'_, str> {
    path.file_stem().unwrap_or_default().to_string_lossy()
}

/// Splits a name into numbers and words, so that 10 is sorted after 9.
fn split_for_sorting(name: &str) -> Vec<(u64, String)> {
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

/// Parses the time at the end of a name such as `walk-1.033s` or `walk-1033ms`, s; `None` if the name does not end with
/// a number and its unit.
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
    fn a_time_in_a_name_requires_a_unit() {
        assert_eq!(parse_seconds("walk-1033ms"), Some(1.033));
        assert_eq!(parse_seconds("1.5s"), Some(1.5));
        for name in ["frame-0001", "1.5", "s", "videos", "1.2.3s"] {
            assert_eq!(parse_seconds(name), None, "{name}");
        }
    }

    #[test]
    fn frames_are_sorted_by_the_times_in_their_names() {
        let folder = tempfile::tempdir().expect("a temporary folder is created");
        for name in ["0.1s.png", "0.067s.png", "33ms.png"] {
            fs::write(folder.path().join(name), "").expect("the file is written");
        }
        for (frame_rate, expected_times) in
            [(None, [0.033, 0.067, 0.1]), (Some(2.0), [0.0, 0.5, 1.0])]
        {
            let frames = list_frames(folder.path(), frame_rate).expect("the names give the times");
            let (times, paths): (Vec<f64>, Vec<_>) = frames.into_iter().unzip();
            assert_eq!(times, expected_times);
            let names: Vec<_> = paths.iter().map(|path| stem(path)).collect();
            assert_eq!(names, ["33ms", "0.067s", "0.1s"]);
        }
    }

    #[test]
    fn split_for_sorting_puts_10_after_9() {
        assert!(split_for_sorting("frame-9") < split_for_sorting("frame-10"));
        assert!(split_for_sorting("a2b1") < split_for_sorting("a2b3"));
    }
}
