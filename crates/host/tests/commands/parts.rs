//! Tests of `lizard parts`.

use std::fs;
use std::path::{Path, PathBuf};

use crate::harness::{Outcome, TemporaryRobot, assert_contains, run_line_in, scratch_folder};

/// Runs `lizard parts` with a folder that does not exist; returns the folder's path and the outcome.
fn make_parts(name: &str, options: &str) -> (PathBuf, Outcome) {
    let folder = scratch_folder().join(name);
    let _ = fs::remove_dir_all(&folder);
    let outcome = run_line_in(scratch_folder(), &format!("parts {name} {options}"));
    (folder, outcome)
}

/// Runs `lizard parts` with the paper's robot, which gets additional tables.
fn make_parts_with_tables(name: &str, tables: &str) -> (PathBuf, Outcome) {
    let tables = format!("{tables}\n[limits]");
    let robot = TemporaryRobot::from_paper(&[("[limits]", &tables)]);
    make_parts(name, &robot.add_option(""))
}

fn read_guide(folder: &Path) -> String {
    fs::read_to_string(folder.join("guide/guide.md")).expect("the file is readable")
}

#[test]
fn parts_writes_all_files_needed_to_build_the_robot() {
    let (folder, outcome) = make_parts("parts-all", "--robot paper");
    outcome.expect_success();
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
    let guide = read_guide(&folder);
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
    let (folder, outcome) = make_parts("parts-corner", "--robot paper --corner --json");
    let parts = outcome.expect_json();
    let parts = parts.as_array().expect("the value is an array");
    let names = parts.iter().filter_map(|part| part["part"].as_str());
    let names: Vec<_> = names.collect();
    let expected = "seat A1|link A1 A3|crank LF RH|follower|leg coupler|foot LF RH";
    for part in expected.split('|') {
        assert!(names.contains(&part), "{names:?}");
    }
    let has_strut = names.iter().any(|name| name.ends_with("strut"));
    assert!(has_strut, "{names:?}");
    assert!(parts.iter().all(|part| part["count"] == 1), "{parts:?}");
    assert!(!names.contains(&"plate") && !folder.join("bill.json").exists());
    assert!(folder.join("stl/seat-A1.stl").is_file());
}

#[test]
fn a_wrong_mass_is_reported_with_the_correct_mass() {
    let make_summary = |options: &str| make_parts("parts-light", options).1.expect_success();
    let light_robot = TemporaryRobot::from_paper(&[("mass = 435.0", "mass = 280.0")]);
    let light_summary = make_summary(&light_robot.add_option(""));
    assert_contains(&light_summary, "The parts weigh 435 g");
    let advice = "\n[body]\nmass = 435.0\n";
    assert!(light_summary.ends_with(advice), "{light_summary}");
    assert_eq!(make_summary("--robot paper").lines().count(), 1);
}

#[test]
fn parts_for_struts_with_springs_include_rigid_struts() {
    let strut = "[leg.drive]\nkind = \"strut\"\nforce = 4.0\nrate = 0.4";
    let (folder, outcome) = make_parts_with_tables("parts-strut", strut);
    outcome.expect_success();
    for file in "stl/rigid-strut.stl cut/rigid-strut.dxf stl/strut.stl".split(' ') {
        assert!(folder.join(file).is_file(), "{file}");
    }
    let guide = read_guide(&folder);
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
    let (folder, outcome) = make_parts_with_tables("parts-refused", "[parts]\nbar = 24.0");
    assert_eq!(outcome.code, Some(1));
    let message = outcome.stderr;
    for phrase in [" overlap by ", " at pose "] {
        assert_contains(&message, phrase);
    }
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(!folder.exists());
}
