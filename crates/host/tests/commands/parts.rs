//! Tests of `lizard parts`.

use std::fs;
use std::path::{Path, PathBuf};

use crate::program::{Outcome, assert_contains, read_file, robot_path, run, scratch_folder};

fn make_parts(folder: &Path, arguments: &[&str]) -> Outcome {
    let folder = folder.display().to_string();
    run(&[&["parts", &folder], arguments].concat())
}

/// Returns a path at which no folder exists.
fn unused_path(name: &str) -> PathBuf {
    let folder = scratch_folder().join(name);
    let _ = fs::remove_dir_all(&folder);
    folder
}

/// Writes a changed copy of the paper's robot file; returns its path.
fn write_changed_paper(name: &str, change: impl Fn(String) -> String) -> String {
    let file = scratch_folder().join(name);
    fs::write(&file, change(read_file("robots/paper.toml"))).expect("the file is written");
    file.display().to_string()
}

#[test]
fn parts_writes_all_files_needed_to_build_the_robot() {
    let folder = unused_path("parts-all");
    make_parts(&folder, &["--robot", &robot_path("paper")]).expect_success();
    for file in [
        "step/plate.step",
        "stl/link-A1-A3.stl",
        "cut/link-A1-A3.dxf",
        "cut/coupler-A1.svg",
        "stl/coupon.stl",
        "stl/rigid-strut.stl",
        "bill.json",
        "guide/guide.html",
        "guide/guide.md",
        "guide/robot.svg",
        "guide/step-11-done.svg",
        "guide/step-1-near.svg",
        "guide/step-2-below.svg",
        "guide/placements.json",
        "stl/head-plate.stl",
    ] {
        assert!(folder.join(file).is_file(), "{file}");
    }
    let guide = fs::read_to_string(folder.join("guide/guide.md")).expect("the file is readable");
    assert_contains(&guide, "## 9. Struts\n");
    assert_contains(&guide, ", print 4 x strut,");
    assert_contains(&guide, " g each, instead of the struts.");
    for phrase in ["hook of the spring", "tension"] {
        assert!(!guide.contains(phrase), "{phrase}: {guide}");
    }
    for line in guide.lines().filter(|line| line.starts_with("![")) {
        let link = line.trim_end_matches(')').rsplit_once('(');
        let (_, file) = link.expect("the line names a file");
        assert!(folder.join("guide").join(file).is_file(), "{file}");
    }
}

#[test]
fn the_option_corner_writes_only_the_parts_of_one_corner() {
    let folder = unused_path("parts-corner");
    let options = ["--robot", &robot_path("paper"), "--corner", "--json"];
    let list = make_parts(&folder, &options).expect_json();
    let list = list.as_array().expect("the value is an array");
    let names = list.iter().filter_map(|part| part["part"].as_str());
    let names: Vec<_> = names.collect();
    let expected = "seat A1|link A1 A3|crank LF RH|follower|leg coupler|foot LF RH";
    for part in expected.split('|') {
        assert!(names.contains(&part), "{names:?}");
    }
    let has_strut = names.iter().any(|name| name.ends_with("strut"));
    assert!(has_strut, "{names:?}");
    assert!(list.iter().all(|part| part["count"] == 1), "{list:?}");
    assert!(!names.contains(&"plate") && !folder.join("bill.json").exists());
    assert!(folder.join("stl/seat-A1.stl").is_file());
}

#[test]
fn a_wrong_mass_is_reported_with_the_correct_mass() {
    let lighten = |text: String| text.replace("mass = 435.0", "mass = 280.0");
    let light_robot = write_changed_paper("light.toml", lighten);
    let make_summary =
        |robot: &str| make_parts(&unused_path("parts-light"), &["--robot", robot]).expect_success();
    let light_summary = make_summary(&light_robot);
    assert_contains(&light_summary, "The parts weigh 435 g");
    let advice = "\n[body]\nmass = 435.0\n";
    assert!(light_summary.ends_with(advice), "{light_summary}");
    assert_eq!(make_summary(&robot_path("paper")).lines().count(), 1);
}

#[test]
fn parts_for_struts_with_springs_include_rigid_struts() {
    let folder = unused_path("parts-strut");
    let robot = write_changed_paper("strut.toml", |text| {
        text + "\n[leg.drive]\nkind = \"strut\"\nforce = 4.0\nrate = 0.4\n"
    });
    make_parts(&folder, &["--robot", &robot]).expect_success();
    for file in "stl/rigid-strut.stl cut/rigid-strut.dxf stl/strut.stl".split(' ') {
        assert!(folder.join(file).is_file(), "{file}");
    }
    let guide = fs::read_to_string(folder.join("guide/guide.md")).expect("the file is readable");
    for phrase in [
        "## 9. Struts and springs",
        ", print 4 x rigid strut,",
        " g each, instead of the struts.",
        "hook",
        "tension",
        "pulls 4.0 N (0.40 N/mm)",
        "[leg.drive]\nkind = \"strut\"\nforce = 4.00\nrate = 0.400\n",
    ] {
        assert_contains(&guide, phrase);
    }
}

#[test]
fn parts_refuses_a_robot_whose_parts_overlap_and_writes_no_file() {
    let folder = unused_path("parts-refused");
    let robot = write_changed_paper("wide.toml", |text| text + "\n[parts]\nbar = 24.0\n");
    let outcome = make_parts(&folder, &["--robot", &robot]);
    assert_eq!(outcome.code, Some(1));
    let message = outcome.stderr;
    for part in [" overlap by ", " at pose "] {
        assert_contains(&message, part);
    }
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(!folder.exists());
}
