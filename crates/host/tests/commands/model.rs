//! Tests of `lizard model`.

use std::fs;

use crate::harness::{expect_refusals, new_folder, run, run_line_in};

#[test]
fn a_mujoco_file_has_servos_feet_and_one_home_pose() {
    let folder = new_folder("model home");
    run_line_in(&folder, "model robot.xml").expect_success();
    let text = fs::read_to_string(folder.join("robot.xml")).expect("the file is readable");
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
    let folder = new_folder("model refusals");
    let cases = "
        model a.xml --drive wolk => lizard: the robot has no gait `wolk`...; did you mean `walk`?
        model a.xml --drive stand => lizard: the gait `stand` moves no servo
        model a.xml --long-foot LF=5.1 => must be between -5 and 5 mm, but is 5.1 mm
        model a.xml --long-foot LF=1 --long-foot lf=0 => lizard: --long-foot LF is given twice
        model a.urfd => unknown file extension
        model a.urdf --drive walk => --drive requires a MuJoCo file
        model a.xml --mesh-address x => --mesh-address requires .urdf or .sdf
    ";
    expect_refusals(&folder, cases);
    let remaining_files = folder.read_dir().expect("the folder is readable");
    assert_eq!(remaining_files.count(), 0);
}

#[test]
fn model_writes_the_meshes_named_in_a_urdf_or_sdf() {
    let folder = new_folder("model meshes");
    let write_model = |file: &str, options: &str| {
        let output = run_line_in(&folder, &format!("model {file} {options}")).expect_success();
        let text = fs::read_to_string(folder.join(file)).expect("the file is readable");
        (output, text)
    };
    for (file, mesh_folder) in [
        ("new/my.urdf", "my-urdf-meshes"),
        ("new/my.sdf", "my-sdf-meshes"),
    ] {
        let (output, text) = write_model(file, "");
        assert!(output.contains(mesh_folder), "{output}");
        let texts_after = text.split(mesh_folder).skip(1);
        let names = texts_after.filter_map(|rest| Some(rest.split_once(".stl")?.0));
        let names: Vec<&str> = names.collect();
        assert!(names.len() > 30, "{names:?}");
        for name in names {
            let mesh = folder.join(format!("new/{mesh_folder}{name}.stl"));
            assert!(mesh.is_file(), "{name}");
        }
    }
    // A model of another robot in the other format has its own meshes.
    let mesh = folder.join("new/my-urdf-meshes/link_A1-printed.stl");
    let read_mesh = || fs::read(&mesh).expect("the mesh is readable");
    let bytes = read_mesh();
    write_model("new/my.sdf", "--robot large");
    assert!(read_mesh() == bytes, "the mesh of my.urdf has changed");
    let (_, text) = write_model("my.urdf", "--mesh-address package://my_robot/meshes/");
    assert!(text.contains("\"package://my_robot/meshes/link_A1-printed.stl\""));
}
