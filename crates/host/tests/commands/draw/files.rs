//! The robots of robots/, and the values in their files, read as text.

use crate::program::{read, root};

/// The servos, in the order of every array.
pub const SERVOS: [&str; 4] = ["A1", "A2", "A3", "A4"];

/// Every file of robots/: its name and its text.
pub fn files() -> Vec<(String, String)> {
    let folder = std::fs::read_dir(root().join("robots")).expect("robots/");
    let files: Vec<(String, String)> = folder
        .map(|entry| entry.expect("a file").path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .map(|path| {
            let text = std::fs::read_to_string(&path).expect("a robot");
            (path.display().to_string(), text)
        })
        .collect();
    assert!(files.len() >= 4);
    files
}

/// The value of a key in the table of a servo, read as text: the first line with this key after
/// the table's header.
pub fn value_of<'a>(text: &'a str, servo: &str, key: &str) -> &'a str {
    let (_, table) = text
        .split_once(&format!("[servo.{servo}]"))
        .expect("a servo");
    let line = table
        .lines()
        .find(|line| line.starts_with(&format!("{key} =")))
        .expect(key);
    line.split_once('=')
        .expect("a value")
        .1
        .trim()
        .trim_matches('"')
}

pub fn paper() -> String {
    read("robots/paper.toml")
}
