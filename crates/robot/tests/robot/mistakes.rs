//! Mistakes that an author of robot.toml can make, and their error messages.

use lizard_robot::Robot;

use crate::{paper, paper_text, paper_with};

/// A mistake in the paper's robot.toml.
struct Mistake {
    /// The replaced text of the file.
    old: String,
    /// The replacement.
    new: String,
    /// The message without the file's name and line.
    message: String,
}

/// Reads the mistakes from mistakes.txt, in which `-` marks the text of the file, `+` the replacement and `=` the
/// message.
fn read_mistakes() -> impl Iterator<Item = Mistake> {
    let blocks = include_str!("mistakes.txt").split("\n\n");
    blocks.filter(|block| block.starts_with('-')).map(|block| {
        let lines_with = |mark: char| -> String {
            let marked_lines = block.lines().filter_map(|line| line.strip_prefix(mark));
            let text = marked_lines.map(|line| line.strip_prefix(' ').unwrap_or(line));
            text.collect::<Vec<_>>().join("\n")
        };
        Mistake {
            old: lines_with('-'),
            new: lines_with('+'),
            message: lines_with('='),
        }
    })
}

#[test]
fn every_mistake_has_its_message_and_the_line_of_its_key_or_table() {
    assert!(read_mistakes().count() > 100);
    for Mistake { old, new, message } in read_mistakes() {
        let error = paper_with(&old, &new)
            .err()
            .unwrap_or_else(|| panic!("{new:?} was accepted"));
        let line_number = error.line.expect("the error has a line");
        let location = format!("robot.toml:{line_number}: ");
        let full_message = error.to_string();
        // The location comes first, or last if the message begins with the consequence for the robot.
        assert!(full_message.contains(&location), "{full_message}");
        let actual = full_message.replacen(&location, "", 1);
        assert_eq!(actual, message, "for {new:?}");
        let text = paper_text().replacen(&old, &new, 1);
        let line = text.lines().nth(line_number - 1);
        let line = line.expect("the line is in the file");
        let mut names = error.key.split(['.', '[']).filter(|name| *name != "gait");
        let names_key = names.any(|name| line.contains(name))
            || line.contains("[gait")
            || line.contains("amplitude =");
        assert!(names_key, "{line:?} for {error}");
    }
}

#[test]
fn the_error_names_a_missing_file() {
    let message = load_error("no/such/robot.toml".as_ref());
    assert!(message.starts_with("FILE: cannot be read: "), "{message}");
}

/// Writes a temporary file with these bytes, under a name that no other test process uses.
fn write_temporary_file(name: &str, bytes: &[u8]) -> std::path::PathBuf {
    let path = std::env::temp_dir().join(format!("{}-{name}.toml", std::process::id()));
    std::fs::write(&path, bytes).expect("the temporary file can be written");
    path
}

/// Returns the error message for a file, with `FILE` in place of its path.
fn load_error(path: &std::path::Path) -> String {
    Robot::load(path)
        .expect_err("the file is not a robot file")
        .to_string()
        .replacen(&path.display().to_string(), "FILE", 1)
}

#[test]
fn a_file_that_is_too_long_unreadable_or_not_text_is_rejected() {
    // Without a limit, reading would continue until memory is full.
    let too_long = "FILE: is longer than 1 MiB, so it is not a robot file";
    assert_eq!(load_error("/dev/zero".as_ref()), too_long);
    let message = load_error(&std::env::temp_dir());
    assert!(message.starts_with("FILE: cannot be read: "), "{message}");
    let latin_path = write_temporary_file("latin", b"# one\n# caf\xe9\n");
    let not_text = "FILE: is not UTF-8 text: line 2 contains other bytes; save the file as UTF-8";
    assert_eq!(load_error(&latin_path), not_text);
    let mut bytes = paper_text().into_bytes();
    bytes.resize(lizard_robot::MAX_FILE_BYTES as usize, b'\n');
    let long_path = write_temporary_file("long", &bytes);
    assert!(Robot::load(&long_path).is_ok(), "1 MiB is allowed");
    for path in [latin_path, long_path] {
        std::fs::remove_file(path).expect("the file can be removed");
    }
}

#[test]
fn a_byte_order_mark_changes_nothing() {
    let marked_text = format!("\u{feff}{}", paper_text());
    assert_eq!(Robot::parse(&marked_text).as_ref(), Ok(paper()));
}

#[test]
fn an_empty_file_is_rejected_for_its_missing_first_table() {
    let error = Robot::parse("").expect_err("an empty file is invalid");
    let expected = "robot.toml: links is missing; it must be a table";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn values_at_the_ends_of_their_ranges_are_allowed() {
    for (old, new) in [
        ("min_us = 600.0", "min_us = 500.0"),
        ("max_us = 2400.0", "max_us = 2500"),
        ("us_per_degree = 10.0", "us_per_degree = -10.0"),
        ("us_per_degree = 10.0", "us_per_degree = 20"),
        ("us_per_degree = 10.0", "us_per_degree = -20"),
        ("pin = \"D3\"", "pin = \"A5\""),
        ("pin = \"D3\"", "pin = \"D12\""),
        (
            "[gait.walk]",
            "[gait.walk-slow1]\nlike = \"walk\"\nperiod = 60\n[gait.walk]",
        ),
    ] {
        if let Err(error) = paper_with(old, new) {
            panic!("{new:?}: {error}");
        }
    }
}
