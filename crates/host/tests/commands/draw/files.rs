//! The files of robots/ as text, and values in them.

use crate::program::{read_file, repo_root};

/// The servos, in the order of every array.
pub const SERVOS: [&str; 4] = ["A1", "A2", "A3", "A4"];

/// Every file of robots/: its name and its text.
pub fn robot_files() -> Vec<(String, String)> {
    let folder = std::fs::read_dir(repo_root().join("robots")).expect("robots/ is readable");
    let files: Vec<(String, String)> = folder
        .map(|entry| entry.expect("robots/ is readable").path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .map(|path| {
            let text = std::fs::read_to_string(&path).expect("the file is readable");
            (path.display().to_string(), text)
        })
        .collect();
    assert!(files.len() >= 4);
    files
}

/// The text of a servo's value: that of the first line with this key after the header of the servo's table.
pub fn servo_value<'a>(text: &'a str, servo: &str, key: &str) -> &'a str {
    let (_, table) = text
        .split_once(&format!("[servo.{servo}]"))
        .expect("the file has the servo's table");
    let line = table
        .lines()
        .find(|line| line.starts_with(&format!("{key} =")))
        .expect(key);
    line.split_once('=')
        .expect("the line has a value")
        .1
        .trim()
        .trim_matches('"')
}

pub fn paper_toml() -> String {
    read_file("robots/paper.toml")
}
