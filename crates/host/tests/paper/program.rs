//! Runs `lizard`.

use std::process::Command;

use lizard_time_limit::LIMIT;

/// The result of a run.
pub struct Outcome {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Outcome {
    /// Standard output as one JSON value.
    pub fn json(&self) -> serde_json::Value {
        assert_eq!(self.code, 0, "{}", self.err);
        serde_json::from_str(&self.out).expect("JSON")
    }
}

/// Adds the paper's robot to a command line: for tests that check its figures.
pub fn paper(args: &str) -> String {
    format!("{args} --robot robots/paper.toml")
}

/// The text of robots/paper.toml.
pub fn paper_text() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/paper.toml");
    std::fs::read_to_string(path).expect("robots/paper.toml")
}

/// A robot file for one test, the paper's with some lines changed; removed when
/// dropped.
pub struct RobotFile(std::path::PathBuf);

impl RobotFile {
    pub fn with(name: &str, changes: &[(&str, &str)]) -> Self {
        let mut text = paper_text();
        for (from, to) in changes {
            assert!(text.contains(from), "robots/paper.toml has no {from:?}");
            text = text.replacen(from, to, 1);
        }
        let path = std::env::temp_dir().join(format!("{}-{name}.toml", std::process::id()));
        std::fs::write(&path, text).expect("a temporary file");
        Self(path)
    }

    /// The command line for this robot.
    pub fn of(&self, args: &str) -> String {
        format!("{args} --robot {}", self.0.display())
    }
}

impl Drop for RobotFile {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

/// Runs the program in the repository's root with this standard input.
pub fn lizard(args: &str, input: impl AsRef<[u8]>) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command
        .args(args.split_whitespace())
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    // A program that stops at bad input closes its end; that is no failure here.
    let output = LIMIT.output(&mut command, input.as_ref());
    let output = output.expect("lizard ends");
    Outcome {
        code: output.status.code().expect("no signal"),
        out: String::from_utf8(output.stdout).expect("UTF-8"),
        err: String::from_utf8(output.stderr).expect("UTF-8"),
    }
}
