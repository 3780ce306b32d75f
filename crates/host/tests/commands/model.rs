//! Tests of `lizard model` as a user runs it.

use std::fs;
use std::path::PathBuf;

use crate::program::{assert_contains, run, scratch_folder};

/// Returns a path at which no file exists.
fn unused_path(name: &str) -> PathBuf {
    let file = scratch_folder().join(name);
    let _ = fs::remove_file(&file);
    file
}

#[test]
fn the_file_holds_a_robot_with_four_servos_and_four_feet() {
    let file = unused_path("robot.xml");
    let path = file.display().to_string();
    run(&["model", &path]).expect_success();
    let text = fs::read_to_string(&file).expect("the file is readable");
    for fragment in [
        "<position name=\"A1\"",
        "<position name=\"A4\"",
        "<geom name=\"pad LH\"",
    ] {
        assert_eq!(text.matches(fragment).count(), 1, "{fragment}");
    }
    assert!(text.ends_with("</mujoco>\n"));
    assert_eq!(text.matches("<key ").count(), 1, "only the home pose");
    assert!(text.contains("<key name=\"home\""));
}

#[test]
#[cfg(unix)]
fn a_stream_gets_the_file_and_nothing_else() {
    let text = run(&["model", "/dev/stdout", "--long-foot", "LH=-0.5"]).expect_success();
    assert!(text.starts_with("<mujoco ") && text.ends_with("</mujoco>\n"));
}

#[test]
fn invalid_input_is_refused_with_a_message_and_no_file_is_written() {
    let file = unused_path("wrong.xml");
    let path = file.display().to_string();
    let refusal_of =
        |arguments: &[&str]| run(&[&["model", &path], arguments].concat()).expect_refusal();
    let message = refusal_of(&["--drive", "wolk"]);
    assert_contains(&message, "robot.toml has no gait `wolk`");
    assert!(message.ends_with("did you mean `walk`?"), "{message}");
    let message = refusal_of(&["--drive", "stand"]);
    assert_eq!(message, "lizard: the gait `stand` moves no servo");
    let message = refusal_of(&["--long-foot", "LF=5.1"]);
    assert_contains(&message, "at most 5 mm either way");
    let message = refusal_of(&["--long-foot", "LF=1", "--long-foot", "lf=0"]);
    assert_eq!(message, "lizard: --long-foot LF is given twice");
    assert!(!file.exists());
}

#[test]
fn a_urdf_or_sdf_comes_with_the_meshes_that_it_names() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    for extension in ["urdf", "sdf"] {
        let file = folder.path().join(format!("new/my.{extension}"));
        let output = run(&["model", &file.display().to_string()]).expect_success();
        assert!(output.contains("my-meshes"), "{output}");
        let text = fs::read_to_string(&file).expect("the file is readable");
        let names = text.split("my-meshes/").skip(1);
        let names: Vec<&str> = names
            .filter_map(|rest| Some(rest.split_once(".stl")?.0))
            .collect();
        assert!(names.len() > 30, "{names:?}");
        for name in names {
            let mesh = folder.path().join(format!("new/my-meshes/{name}.stl"));
            assert!(mesh.is_file(), "{name}");
        }
    }
    let file = folder.path().join("my.urdf");
    let address = ["--mesh-address", "package://my_robot/meshes/"];
    run(&[&["model", &file.display().to_string()], &address[..]].concat()).expect_success();
    let text = fs::read_to_string(&file).expect("the file is readable");
    assert!(text.contains("\"package://my_robot/meshes/link_A1-printed.stl\""));
}

#[test]
fn options_that_a_format_does_not_support_are_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    for (name, options, expected) in [
        ("a.urfd", &[][..], "the ending decides the format"),
        (
            "a.urdf",
            &["--drive", "walk"],
            "--drive is for MuJoCo's file",
        ),
        (
            "a.xml",
            &["--mesh-address", "x"],
            "--mesh-address is for .urdf and .sdf",
        ),
    ] {
        let file = folder.path().join(name).display().to_string();
        run(&[&["model", &file], options].concat()).expect_refusal_with(expected);
    }
    let remaining_files = folder.path().read_dir().expect("the folder is readable");
    assert_eq!(remaining_files.count(), 0);
}
