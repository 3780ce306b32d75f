//! Tests of `lizard model`.

use std::fs;
use std::path::PathBuf;

use crate::program::{assert_contains, read_cases, run, run_line_in, scratch_folder};

/// Returns a path at which no file exists.
fn unused_path(name: &str) -> PathBuf {
    let file = scratch_folder().join(name);
    let _ = fs::remove_file(&file);
    file
}

#[test]
fn a_mujoco_file_has_servos_feet_and_one_home_pose() {
    let file = unused_path("robot.xml");
    let path = file.display().to_string();
    run(&["model", &path]).expect_success();
    let text = fs::read_to_string(&file).expect("the file is readable");
    for fragment in [
        r#"<position name="A1""#,
        r#"<position name="A4""#,
        r#"<geom name="pad LH""#,
    ] {
        assert_eq!(text.matches(fragment).count(), 1, "{fragment}");
    }
    assert!(text.ends_with("</mujoco>\n"));
    assert_eq!(text.matches("<key ").count(), 1, "only the home pose");
    assert!(text.contains("<key name=\"home\""));
}

#[test]
#[cfg(unix)]
fn standard_output_as_file_gets_only_the_model() {
    let text = run(&["model", "/dev/stdout", "--long-foot", "LH=-0.5"]).expect_success();
    assert!(text.starts_with("<mujoco ") && text.ends_with("</mujoco>\n"));
}

#[test]
fn model_refuses_invalid_input_and_writes_no_file() {
    let file = unused_path("wrong.xml");
    let path = file.display().to_string();
    let run_and_refuse =
        |arguments: &[&str]| run(&[&["model", &path], arguments].concat()).expect_refusal();
    let message = run_and_refuse(&["--drive", "wolk"]);
    assert_contains(&message, "robot.toml has no gait `wolk`");
    assert!(message.ends_with("did you mean `walk`?"), "{message}");
    let message = run_and_refuse(&["--drive", "stand"]);
    assert_eq!(message, "lizard: the gait `stand` moves no servo");
    let message = run_and_refuse(&["--long-foot", "LF=5.1"]);
    assert_contains(&message, "must be between -5 and 5 mm, but is 5.1 mm");
    let message = run_and_refuse(&["--long-foot", "LF=1", "--long-foot", "lf=0"]);
    assert_eq!(message, "lizard: --long-foot LF is given twice");
    assert!(!file.exists());
}

#[test]
fn model_writes_the_meshes_named_in_a_urdf_or_sdf() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    for extension in ["urdf", "sdf"] {
        let file = folder.path().join(format!("new/my.{extension}"));
        let output = run(&["model", &file.display().to_string()]).expect_success();
        assert!(output.contains("my-meshes"), "{output}");
        let text = fs::read_to_string(&file).expect("the file is readable");
        let texts_after = text.split("my-meshes/").skip(1);
        let names = texts_after.filter_map(|rest| Some(rest.split_once(".stl")?.0));
        let names: Vec<&str> = names.collect();
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
fn model_refuses_options_that_a_format_does_not_support_and_writes_no_file() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let cases = "
        model a.urfd => unknown file extension
        model a.urdf --drive walk => --drive requires a MuJoCo file
        model a.xml --mesh-address x => --mesh-address requires .urdf or .sdf
    ";
    for (line, expected) in read_cases(cases) {
        run_line_in(folder.path(), line).expect_refusal_with(expected);
    }
    let remaining_files = folder.path().read_dir().expect("the folder is readable");
    assert_eq!(remaining_files.count(), 0);
}
