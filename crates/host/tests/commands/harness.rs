//! Runs `lizard`, and provides files for the tests.

use std::path::{Path, PathBuf};
use std::process::Command;

use lizard_time_limit::TIME_LIMIT;
use tempfile::NamedTempFile;

/// The result of a run of `lizard`.
#[derive(Debug)]
pub struct Outcome {
    /// The exit code; `None` if a signal terminated the program.
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Outcome {
    /// Checks that the run succeeded, and returns its standard output.
    pub fn expect_success(self) -> String {
        assert_eq!(self.code, Some(0), "{}", self.stderr);
        self.stdout
    }

    /// Checks that the run succeeded, and parses its standard output as one JSON value.
    pub fn expect_json(self) -> serde_json::Value {
        serde_json::from_str(&self.expect_success()).expect("the output is JSON")
    }

    /// Checks that the run succeeded, and parses each line of its standard output as a JSON value.
    pub fn expect_json_lines(self) -> Vec<serde_json::Value> {
        let output = self.expect_success();
        let values = output.lines().map(serde_json::from_str);
        let values: Result<_, _> = values.collect();
        values.expect("the output is JSON")
    }

    /// Checks that the run refused its input and printed nothing to standard output; returns the message.
    pub fn expect_refusal(self) -> String {
        assert_eq!(self.code, Some(2), "{}", self.stderr);
        assert_eq!(self.stdout, "", "output before the refusal");
        self.stderr.trim().to_owned()
    }

    /// Checks that the run refused its input with a message that contains `expected`. If `expected` begins with
    /// `lizard: ` or contains `...`, which stands for any text, it is the complete message.
    #[track_caller]
    pub fn expect_refusal_with(self, expected: &str) {
        assert_refusal(&self.expect_refusal(), expected, "refusal");
    }
}

/// Checks the message of a refusal: see [`Outcome::expect_refusal_with`].
#[track_caller]
fn assert_refusal(message: &str, expected: &str, case_name: &str) {
    let is_expected = match expected.split_once("...") {
        Some((start, end)) => message.starts_with(start) && message.ends_with(end),
        None if expected.starts_with("lizard: ") => message == expected,
        None => message.contains(expected),
    };
    assert!(
        is_expected,
        "{case_name}: expected {expected:?}, got: {message}"
    );
}

/// Checks that `text` contains `expected`.
#[track_caller]
pub fn assert_contains(text: &str, expected: &str) {
    assert!(
        text.contains(expected),
        "expected {expected:?}, got: {text}"
    );
}

/// Reads a table of cases. Each line has an input and its expected message, separated by ` => `.
pub fn read_cases(table: &str) -> impl Iterator<Item = (&str, &str)> {
    let lines = table.trim().lines().map(str::trim_start);
    lines.map(|line| line.split_once(" => ").expect(line))
}

/// Runs the command lines of a table in a folder; checks that each is refused with its message: see
/// [`Outcome::expect_refusal_with`].
#[track_caller]
pub fn expect_refusals(folder: &Path, table: &str) {
    for (line, expected) in read_cases(table) {
        let outcome = run_line_in(folder, line);
        assert_eq!(outcome.code, Some(2), "{line}: {}", outcome.stderr);
        assert_refusal(&outcome.expect_refusal(), expected, line);
    }
}

/// Creates an empty folder in the scratch folder.
pub fn new_folder(name: &str) -> PathBuf {
    let folder = scratch_folder().join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("the folder is created");
    folder
}

/// Returns the root of the repository.
pub fn repo_root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Reads a file of the repository.
pub fn read_file(path: &str) -> String {
    std::fs::read_to_string(repo_root().join(path))
        .unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Returns the first value of `key` in the text of a robot file, without quotation marks and comment.
pub fn read_value<'a>(text: &'a str, key: &str) -> &'a str {
    let mut values = text
        .lines()
        .filter_map(|line| line.strip_prefix(key)?.trim().strip_prefix('='));
    let value = values.next().and_then(|value| value.split('#').next());
    value.expect(key).trim().trim_matches('"')
}

/// Reads a length in a robot file, mm.
pub fn read_length(text: &str, key: &str) -> f64 {
    let value = read_value(text, key).parse();
    value.expect("the value is a number")
}

/// Returns the scratch folder of all tests.
pub fn scratch_folder() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR"))
}

/// Returns the path of a robot file in robots/; `name` has no extension.
pub fn robot_path(name: &str) -> String {
    let path = repo_root().join("robots").join(name).with_extension("toml");
    path.display().to_string()
}

/// Adds the option for the paper's robot to a command line, for tests of the paper's values.
pub fn with_paper(args: &str) -> String {
    format!("{args} --robot robots/paper.toml")
}

/// A temporary robot file, which `drop` removes.
pub struct TemporaryRobot(NamedTempFile);

impl TemporaryRobot {
    /// Copies the paper's robot file with some changes.
    pub fn from_paper(changes: &[(&str, &str)]) -> Self {
        Self::from_file("robots/paper.toml", changes)
    }

    /// Copies a file of the repository with some changes.
    pub fn from_file(source_path: &str, changes: &[(&str, &str)]) -> Self {
        let mut text = read_file(source_path);
        for (old, new) in changes {
            assert!(text.contains(old), "{source_path} has no {old:?}");
            text = text.replacen(old, new, 1);
        }
        let file = NamedTempFile::new().expect("a temporary file is created");
        std::fs::write(file.path(), text).expect("the file is written");
        Self(file)
    }

    /// Adds the option for this robot file to a command line.
    pub fn add_option(&self, args: &str) -> String {
        format!("{args} --robot {}", self.0.path().display())
    }
}

/// Runs a command line in the repository's root with the given standard input.
pub fn run_line(line: &str, input: impl AsRef<[u8]>) -> Outcome {
    run_in(&repo_root(), line, input)
}

/// Runs a command line in a folder with empty standard input.
pub fn run_line_in(folder: &Path, line: &str) -> Outcome {
    run_in(folder, line, "")
}

/// Runs a command line in a folder with the given standard input.
fn run_in(folder: &Path, line: &str, input: impl AsRef<[u8]>) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command.args(line.split_whitespace()).current_dir(folder);
    run_command(&mut command, input)
}

/// Runs the program in the scratch folder with empty standard input.
pub fn run(arguments: &[&str]) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    run_command(command.args(arguments).current_dir(scratch_folder()), "")
}

/// Runs a command with the given standard input.
pub fn run_command(command: &mut Command, input: impl AsRef<[u8]>) -> Outcome {
    // A program that stops at invalid input closes its standard input early, which is not an error here.
    let output = TIME_LIMIT.run_command(command, input.as_ref());
    let output = output.expect("the program runs and exits");
    Outcome {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).expect("the output is UTF-8"),
        stderr: String::from_utf8(output.stderr).expect("the output is UTF-8"),
    }
}
