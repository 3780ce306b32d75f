//! `lizard measure keys` on hand-written results of `lizard measure`.

use std::fs;
use std::path::PathBuf;

use crate::program::{Outcome, read, robot, run_in, scratch};

/// The movement per cycle of a gait, as `lizard measure --json` prints it; all errors are 0.05.
fn object(gait: &str, [forward, left, turn]: [f64; 3]) -> String {
    let part = |mean: f64| format!(r#"{{"mean":{mean},"sd":0.1,"error":0.05}}"#);
    format!(
        r#"{{"gait":"{gait}","speed":100,"forward":{},"left":{},"turn":{}}}"#,
        part(forward),
        part(left),
        part(turn)
    )
}

/// The movements of several gaits, as `lizard measure --json` prints them.
fn ways(objects: &[String]) -> String {
    format!(r#"{{"gaits":[{}]}}"#, objects.join(","))
}

/// Writes a file into the scratch folder.
fn file(name: &str, text: &str) -> PathBuf {
    let path = scratch().join(name);
    fs::write(&path, text).expect("it is written");
    path
}

fn keys(files: &[&PathBuf], more: &[&str]) -> Outcome {
    let paper = robot("paper");
    let files: Vec<&str> = files.iter().filter_map(|file| file.to_str()).collect();
    let line = [&["measure", "keys", "--robot", &paper], &files[..], more].concat();
    run_in(scratch(), &line, "")
}

#[test]
fn files_without_information_are_refused_with_advice() {
    let foreign = file("foreign.json", r#"{"gaits":[{"gait":"walk","speed":100}]}"#);
    let message = keys(&[&foreign], &[]).expect_refusal();
    assert!(
        message.contains("foreign.json") && message.contains("missing field `forward`"),
        "{message}"
    );
    let empty = file("empty.json", "");
    let message = keys(&[&empty], &[]).expect_refusal();
    assert!(
        message.contains("empty.json: this is not what"),
        "{message}"
    );
    let without = file("without.json", &ways(&[]));
    let message = keys(&[&without], &[]).expect_refusal();
    assert!(message.contains("none of these gaits"), "{message}");
    let unknown = file("unknown.json", &ways(&[object("wakl", [30.0, 0.0, 0.0])]));
    assert!(
        keys(&[&unknown], &[])
            .expect_refusal()
            .contains("no gait `wakl`")
    );
    let still = file("still.json", &ways(&[object("stand", [0.0; 3])]));
    assert!(
        keys(&[&still], &[])
            .expect_refusal()
            .contains("moves no servo")
    );
    let other = ways(&[object("walk", [30.0, 0.0, 0.0])])
        .replace(r#""speed":100"#, r#""speed":100,"period_expected":1.25"#);
    let other = file("other.json", &other);
    assert!(
        keys(&[&other], &[])
            .expect_refusal()
            .contains("1.00 s by this robot.toml, but took 1.25 s")
    );
}

#[test]
fn no_robot_and_no_input_is_replaced() {
    let way = file("way.json", &ways(&[object("walk", [30.0, 0.0, 0.0])]));
    let text = read("robots/grain.toml");
    let other = file("other-robot.toml", &text);
    let message = keys(&[&way], &["--output", other.to_str().expect("a name")]).expect_refusal();
    assert!(message.contains("describes a robot"), "{message}");
    let message = keys(&[&way], &["--output", way.to_str().expect("a name")]).expect_refusal();
    assert!(message.contains("this command reads it"), "{message}");
    assert_eq!(fs::read_to_string(&other).expect("it is there"), text);
}

#[test]
fn a_new_robot_differs_in_the_lines_that_were_measured_and_in_no_other() {
    // The model's movement with a friction ratio of 1.1, extrapolated by its derivatives at the file's ratio, 1.
    let measured = [
        object("walk", [33.57, 0.07, 0.0]),
        object("trot", [25.63, -0.02, 0.0]),
        object("crawl", [29.72, 0.3, -0.11]),
        object("back", [-32.91, 0.08, 0.0]),
        object("left", [1.09, 0.29, 14.53]),
    ];
    let measured = file("ways.json", &ways(&measured));
    let output = scratch().join("measured.toml");
    let _ = fs::remove_file(&output);
    let shown = output.to_str().expect("a name");
    let result = keys(&[&measured], &["--output", shown, "--json"]).json();
    let verdict = |key: &str| {
        let mut all = result["keys"].as_array().into_iter().flatten();
        let found = all.find(|found| found["key"] == key).expect(key);
        found["verdict"].as_str().expect("a word").to_owned()
    };
    assert_eq!(verdict("ground.friction_back_over_forward"), "moved");
    assert_eq!(result["written"], shown);
    let (old, new) = (
        read("robots/paper.toml"),
        fs::read_to_string(&output).expect("it is written"),
    );
    let changed = new
        .lines()
        .filter(|line| !old.lines().any(|known| known == *line));
    for line in changed {
        let is_measured =
            line.contains("# measured: ") && line.contains("+-") && line.contains("was ");
        assert!(
            is_measured || line.is_empty() || line.starts_with('['),
            "{line}"
        );
    }
    assert!(new.contains("friction_back_over_forward = ") && new != old);
    let check = run_in(scratch(), &["gaits", "--robot", shown], "");
    assert!(check.expect_success().contains("walk"));
}
