//! Runs `lizard`.

use std::path::{Path, PathBuf};
use std::process::Command;

use lizard_time_limit::LIMIT;

/// The result of a run of `lizard`.
#[derive(Debug)]
pub struct Outcome {
    /// The exit code; `None` if a signal ended the program.
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Outcome {
    /// Checks that the run succeeded, and returns its standard output.
    pub fn expect_success(self) -> String {
        assert_eq!(self.code, Some(0), "{}", self.err);
        self.out
    }

    /// Checks that the run succeeded, and parses its standard output as one JSON value.
    pub fn json(self) -> serde_json::Value {
        serde_json::from_str(&self.expect_success()).expect("JSON")
    }

    /// Checks that the run refused its input and wrote nothing to standard output, and returns its
    /// message.
    pub fn expect_refusal(self) -> String {
        assert_eq!(self.code, Some(2), "{}", self.err);
        assert_eq!(self.out, "", "nothing is half written");
        self.err.trim().to_owned()
    }
}

/// The root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The text of a file of the repository.
pub fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|fault| panic!("{path}: {fault}"))
}

/// A folder for files of tests.
pub fn scratch() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR"))
}

/// The path of a robot of robots/.
pub fn robot(name: &str) -> String {
    let path = root().join("robots").join(name).with_extension("toml");
    path.display().to_string()
}

/// Adds the option for the paper's robot to a command line, for tests that check the paper's figures.
pub fn paper(args: &str) -> String {
    format!("{args} --robot robots/paper.toml")
}

/// A robot file for one test: a copy of another file with some lines changed. It is removed when
/// dropped.
pub struct RobotFile(std::path::PathBuf);

impl RobotFile {
    pub fn with(name: &str, changes: &[(&str, &str)]) -> Self {
        Self::changed("robots/paper.toml", name, changes)
    }

    /// Copies a file of the repository with some lines changed.
    pub fn changed(file: &str, name: &str, changes: &[(&str, &str)]) -> Self {
        let mut text = read(file);
        for (from, to) in changes {
            assert!(text.contains(from), "{file} has no {from:?}");
            text = text.replacen(from, to, 1);
        }
        let path = std::env::temp_dir().join(format!("{}-{name}.toml", std::process::id()));
        std::fs::write(&path, text).expect("a temporary file");
        Self(path)
    }

    /// Adds the option for this robot file to a command line.
    pub fn add_to(&self, args: &str) -> String {
        format!("{args} --robot {}", self.0.display())
    }
}

impl Drop for RobotFile {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

/// Runs the program in the repository's root with this standard input.
pub fn lizard(line: &str, input: impl AsRef<[u8]>) -> Outcome {
    let arguments: Vec<&str> = line.split_whitespace().collect();
    run_in(&root(), &arguments, input)
}

/// Runs the program in a folder for files of tests.
pub fn run(arguments: &[&str]) -> Outcome {
    run_in(scratch(), arguments, "")
}

/// Runs the program in a folder with this standard input.
pub fn run_in(folder: &Path, arguments: &[&str], input: impl AsRef<[u8]>) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command.args(arguments).current_dir(folder);
    // A program that stops at bad input closes its standard input early; that is no failure of the test.
    let output = LIMIT.output(&mut command, input.as_ref());
    let output = output.expect("lizard ends");
    Outcome {
        code: output.status.code(),
        out: String::from_utf8(output.stdout).expect("UTF-8"),
        err: String::from_utf8(output.stderr).expect("UTF-8"),
    }
}
