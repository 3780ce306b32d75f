//! `lizard mjcf` as its user runs it.

use std::fs;
use std::path::PathBuf;

use crate::program::{run, scratch};

/// A path without a file.
fn fresh_path(name: &str) -> PathBuf {
    let file = scratch().join(name);
    let _ = fs::remove_file(&file);
    file
}

#[test]
fn the_file_holds_a_robot_with_four_servos_and_four_feet() {
    let file = fresh_path("robot.xml");
    let path = file.display().to_string();
    run(&["mjcf", &path]).success();
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
    let text = run(&["mjcf", "/dev/stdout", "--long-foot", "LH=-0.5"]).success();
    assert!(text.starts_with("<mujoco ") && text.ends_with("</mujoco>\n"));
}

#[test]
fn wrong_input_is_refused_with_a_message_and_no_file_is_written() {
    let file = fresh_path("wrong.xml");
    let path = file.display().to_string();
    let refusal = |words: &[&str]| run(&[&["mjcf", &path], words].concat()).refusal();
    let wolk = refusal(&["--drive", "wolk"]);
    assert!(wolk.contains("robot.toml has no gait `wolk`"), "{wolk}");
    assert!(wolk.ends_with("did you mean `walk`?"), "{wolk}");
    let stand = refusal(&["--drive", "stand"]);
    assert_eq!(stand, "lizard: the gait `stand` moves no servo");
    let far = refusal(&["--long-foot", "LF=5.1"]);
    assert!(far.contains("at most 5 mm either way"), "{far}");
    let twice = refusal(&["--long-foot", "LF=1", "--long-foot", "lf=0"]);
    assert_eq!(twice, "lizard: --long-foot LF is given twice");
    assert!(!file.exists());
}
