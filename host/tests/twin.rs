//! `lizard twin` and `lizard spring` on good and wrong input.

use std::path::Path;
use std::process::{Command, Output};

use lizard_time_limit::LIMIT;

/// The paper's robot: what these tests say is its.
const PAPER: &str = concat!(
    "--robot=",
    env!("CARGO_MANIFEST_DIR"),
    "/../robots/paper.toml"
);

fn lizard(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command.args(arguments);
    if !arguments.iter().any(|word| word.starts_with("--robot=")) {
        command.arg(PAPER);
    }
    command.current_dir(Path::new(env!("CARGO_TARGET_TMPDIR")));
    LIMIT.output(&mut command, b"").expect("the program runs")
}

fn complaint(arguments: &[&str]) -> String {
    let output = lizard(arguments);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty(), "nothing is half written");
    String::from_utf8_lossy(&output.stderr).trim().to_owned()
}

fn json(arguments: &[&str]) -> serde_json::Value {
    let output = lizard(arguments);
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).expect("one object")
}

#[test]
fn a_gait_that_there_is_not_is_refused_with_those_there_are() {
    assert_eq!(
        complaint(&["twin", "--gait", "jump"]),
        "lizard: robot.toml has no gait `jump`; those that move are walk, trot, crawl, back, left, right, arc-left, arc-right, look"
    );
    assert_eq!(
        complaint(&["twin", "--gait", "stand"]),
        "lizard: the gait `stand` moves no servo"
    );
}

#[test]
fn a_spring_that_cannot_be_wound_or_hung_is_refused() {
    for (arguments, words) in [
        (
            ["--wire", "2", "--outer", "5.55"],
            "a coil of 5.55 mm is too narrow for a wire of 2 mm: it needs three times that",
        ),
        (
            ["--wire", "0.6", "--length", "8"],
            "between its hooks a spring of 8 mm has no room for two coils of this wire",
        ),
        (
            ["--wire", "0.6", "--installed", "20"],
            "--installed is 20 mm, but without load the spring is 25.4 mm long already",
        ),
        (
            ["--wire", "0.6", "--length", "40"],
            "between a strut's screws it has 33.2 mm, but without load the spring is 40 mm long already",
        ),
    ] {
        let all = [&["spring"], &arguments[..]].concat();
        assert_eq!(complaint(&all), format!("lizard: {words}"));
    }
}

#[test]
fn a_strut_of_the_papers_size_carries_every_gait_and_a_radial_spring_none() {
    let shares = |geometry: &str| -> Vec<f64> {
        let answer = json(&["spring", "--wire=0.6", "--geometry", geometry, "--json"]);
        let gaits = answer["gaits"].as_array().expect("gaits").iter();
        gaits.filter_map(|gait| gait["share"].as_f64()).collect()
    };
    let (strut, radial) = (shares("strut"), shares("radial"));
    assert_eq!(strut.len(), 8);
    assert!(strut.iter().all(|share| *share > 0.99), "{strut:?}");
    assert!(radial.iter().all(|share| *share < 0.9), "{radial:?}");
}

#[test]
fn what_is_advised_does() {
    // On the paper's robot as it weighs, no two springs are strong enough.
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/paper.toml");
    let paper = std::fs::read_to_string(path).expect("paper");
    let light = paper.replacen("mass = 396.4 ", "mass = 307.0 ", 1);
    assert_ne!(paper, light);
    let file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("light-spring.toml");
    std::fs::write(&file, light).expect("a file");
    let robot = format!("--robot={}", file.display());
    let output = lizard(&["spring", "--wire=0.6", "--geometry=pair", &robot]);
    let text = String::from_utf8_lossy(&output.stdout);
    let advice = text
        .split_once("two springs against each other: ")
        .expect("advice")
        .1;
    let numbers: Vec<&str> = advice
        .split_whitespace()
        .filter(|word| word.starts_with(|c: char| c.is_ascii_digit()))
        .collect();
    let [wire, _, _, radius, ..] = numbers[..] else {
        panic!("{advice}")
    };
    let (wire, radius) = (format!("--wire={wire}"), format!("--radius={radius}"));
    let answer = json(&[
        "spring",
        &wire,
        &radius,
        "--geometry=pair",
        &robot,
        "--json",
    ]);
    for gait in answer["gaits"].as_array().expect("gaits") {
        assert!(
            gait["share"].as_f64().is_none_or(|share| share >= 0.9),
            "{gait}"
        );
    }
}

#[test]
fn a_spring_is_to_robot_toml_what_it_is_to_the_bill() {
    let output = lizard(&["spring", "--wire=0.6"]);
    let text = String::from_utf8_lossy(&output.stdout);
    let (_, table) = text.split_once("In robot.toml:\n\n").expect("a table");
    let drive = |table: &str| {
        let path = PAPER.trim_start_matches("--robot=");
        let text = std::fs::read_to_string(path).expect(path);
        let robot = lizard_robot::Robot::parse(&format!("{text}\n{table}")).expect(table);
        *robot.drive().strut().expect("a strut")
    };
    // Left out, force and rate follow from the same coil.
    let (said, meant) = (drive(table), drive("[leg.drive]\nkind = \"strut\""));
    assert!(
        (said.force - meant.force).abs() < 0.005,
        "{said:?} {meant:?}"
    );
    assert!(
        (said.rate - meant.rate).abs() < 0.0005,
        "{said:?} {meant:?}"
    );
    // Another geometry comes to an ideal spring.
    let output = lizard(&["spring", "--wire=0.6", "--geometry=pair"]);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(
        text.contains("\n[leg.drive]\nkind = \"spring\"\nstiffness = "),
        "{text}"
    );
}
