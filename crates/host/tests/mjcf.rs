//! `lizard mjcf` as its user runs it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use lizard_time_limit::LIMIT;

fn lizard(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command
        .arg("mjcf")
        .args(arguments)
        .current_dir(env!("CARGO_TARGET_TMPDIR"));
    LIMIT.output(&mut command, b"").expect("lizard runs")
}

fn fresh(name: &str) -> PathBuf {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_file(&file);
    file
}

/// The sentence that a call is refused with.
fn refusal(arguments: &[&str]) -> String {
    let made = lizard(arguments);
    assert_eq!(made.status.code(), Some(2), "{made:?}");
    String::from_utf8(made.stderr).expect("text")
}

#[test]
fn the_file_holds_a_robot_with_four_servos_and_four_feet() {
    let file = fresh("robot.xml");
    let path = file.display().to_string();
    let made = lizard(&[&path]);
    assert!(made.status.success(), "{made:?}");
    let text = fs::read_to_string(&file).expect("a file");
    for part in [
        "<position name=\"A1\"",
        "<position name=\"A4\"",
        "<geom name=\"pad LH\"",
    ] {
        assert_eq!(text.matches(part).count(), 1, "{part}");
    }
    assert!(text.ends_with("</mujoco>\n"));
    assert!(!text.contains("<key "), "nobody asked for a gait");
}

#[test]
#[cfg(unix)]
fn a_stream_gets_the_file_and_nothing_else() {
    let made = lizard(&["/dev/stdout", "--long-foot", "LH=-0.5"]);
    assert!(made.status.success(), "{made:?}");
    let text = String::from_utf8(made.stdout).expect("text");
    assert!(text.starts_with("<mujoco ") && text.ends_with("</mujoco>\n"));
}

#[test]
fn what_is_wrong_is_refused_in_a_sentence_and_no_file_is_written() {
    let file = fresh("wrong.xml");
    let path = file.display().to_string();
    let wolk = refusal(&[&path, "--drive", "wolk"]);
    assert!(wolk.contains("robot.toml has no gait `wolk`"), "{wolk}");
    assert!(wolk.ends_with("did you mean `walk`?\n"), "{wolk}");
    let stand = refusal(&[&path, "--drive", "stand"]);
    assert_eq!(stand, "lizard: the gait `stand` moves no servo\n");
    let far = refusal(&[&path, "--long-foot", "LF=5.1"]);
    assert!(far.contains("at most 5 mm either way"), "{far}");
    let twice = refusal(&[&path, "--long-foot", "LF=1", "--long-foot", "lf=0"]);
    assert_eq!(twice, "lizard: --long-foot LF is given twice\n");
    assert!(!file.exists());
}
