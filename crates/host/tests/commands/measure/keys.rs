//! Tests of `lizard measure keys` with hand-written outputs of `lizard measure --json`.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::harness::{Outcome, read_file, robot_path, run, run_command, scratch_folder};

/// Formats a gait's movement per cycle (mm, mm, deg) as `lizard measure --json` does; all standard errors are 0.05.
fn format_gait(gait: &str, movement: [f64; 3]) -> Value {
    let format_component = |mean: f64| json!({ "mean": mean, "sd": 0.1, "error": 0.05 });
    let [forward, left, turn] = movement.map(format_component);
    json!({ "gait": gait, "speed": 100, "forward": forward, "left": left, "turn": turn })
}

/// Formats the movements of several gaits as `lizard measure --json` does.
fn format_measurement(gaits: &[Value]) -> String {
    json!({ "gaits": gaits }).to_string()
}

/// Writes a file to the scratch folder.
fn write_file(name: &str, text: &str) -> PathBuf {
    let path = scratch_folder().join(name);
    fs::write(&path, text).expect("the file is written");
    path
}

fn run_measure_keys(file: &Path, options: &[&str]) -> Outcome {
    let paper = robot_path("paper");
    let file = file.display().to_string();
    run(&[&["measure", "keys", "--robot", &paper, &file], options].concat())
}

#[test]
fn files_without_usable_movements_are_refused_with_advice() {
    let foreign_json = r#"{"gaits":[{"gait":"walk","speed":100}]}"#.to_owned();
    let json_with_gait = |gait: &str| format_measurement(&[format_gait(gait, [30.0, 0.0, 0.0])]);
    let json_without_motion = format_measurement(&[format_gait("stand", [0.0; 3])]);
    let json_of_other_robot =
        json_with_gait("walk").replace(r#""speed":100"#, r#""speed":100,"period_expected":1.25"#);
    for (text, expected) in [
        (&foreign_json, "refused.json: expected the output of"),
        (&foreign_json, "missing field `forward`"),
        (&String::new(), "refused.json: expected the output of"),
        (&format_measurement(&[]), "none of these gaits"),
        (&json_with_gait("wakl"), "no gait `wakl`"),
        (&json_without_motion, "moves no servo"),
        (
            &json_of_other_robot,
            "1.00 s in this robot.toml, but 1.25 s",
        ),
    ] {
        let file = write_file("refused.json", text);
        run_measure_keys(&file, &[]).expect_refusal_with(expected);
    }
}

#[test]
fn measure_keys_never_overwrites_a_robot_file_or_its_input() {
    let movements = format_measurement(&[format_gait("walk", [30.0, 0.0, 0.0])]);
    let movement_file = write_file("movement.json", &movements);
    let text = read_file("robots/grain.toml");
    let robot_file = write_file("other-robot.toml", &text);
    for (output, reason) in [
        (&robot_file, "describes a robot"),
        (&movement_file, "this command reads it"),
    ] {
        let output = output.display().to_string();
        run_measure_keys(&movement_file, &["--output", &output]).expect_refusal_with(reason);
    }
    let robot_text = fs::read_to_string(&robot_file).expect("the file is readable");
    assert_eq!(robot_text, text);
}

/// The movements that the model predicts for a friction ratio of 1.1, extrapolated from the ratio of 1 in the file.
fn format_movements_on_gripping_pads() -> String {
    format_measurement(&[
        format_gait("walk", [33.57, 0.07, 0.0]),
        format_gait("trot", [25.63, -0.02, 0.0]),
        format_gait("crawl", [29.72, 0.3, -0.11]),
        format_gait("back", [-32.91, 0.08, 0.0]),
        format_gait("left", [1.09, 0.29, 14.53]),
    ])
}

#[test]
#[cfg(target_os = "linux")]
fn an_output_name_that_is_not_utf_8_does_not_break_the_json_object() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let measured_file = folder.path().join("movements.json");
    let measurement = format_movements_on_gripping_pads();
    fs::write(&measured_file, measurement).expect("the file is written");
    let name = std::ffi::OsStr::from_bytes(b"measured-\xe4.toml");
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_lizard"));
    command.args(["measure", "keys", "movements.json", "--robot", "paper"]);
    command.args(["--json", "--output"]).arg(name);
    let result = run_command(command.current_dir(folder.path()), "").expect_json();
    assert_eq!(result["written"], "measured-\u{fffd}.toml");
    assert!(folder.path().join(name).is_file());
}

#[test]
fn the_written_robot_file_differs_only_in_measured_lines() {
    let measured_file = write_file("movements.json", &format_movements_on_gripping_pads());
    let output = scratch_folder().join("measured.toml");
    let _ = fs::remove_file(&output);
    let output_name = output.to_str().expect("the path is UTF-8");
    let result =
        run_measure_keys(&measured_file, &["--output", output_name, "--json"]).expect_json();
    let find_verdict = |key: &str| {
        let mut entries = result["keys"].as_array().into_iter().flatten();
        let entry = entries.find(|entry| entry["key"] == key).expect(key);
        entry["verdict"].clone()
    };
    assert_eq!(find_verdict("ground.friction_back_over_forward"), "moved");
    assert_eq!(result["written"], output_name);
    let old_text = read_file("robots/paper.toml");
    let new_text = fs::read_to_string(&output).expect("the file is readable");
    let is_new = |line: &&str| !old_text.lines().any(|old_line| old_line == *line);
    for line in new_text.lines().filter(is_new) {
        let is_measured =
            line.contains("# measured: ") && line.contains("+-") && line.contains("was ");
        let is_blank_or_header = line.is_empty() || line.starts_with('[');
        assert!(is_measured || is_blank_or_header, "{line}");
    }
    assert!(new_text.contains("friction_back_over_forward = ") && new_text != old_text);
    // A second run may replace this file, until a user edits it. The measured gait `stand` is refused after this check.
    let still_measurement = format_measurement(&[format_gait("stand", [0.0; 3])]);
    let still_file = write_file("still.json", &still_measurement);
    let run_again = || run_measure_keys(&still_file, &["--output", output_name]);
    run_again().expect_refusal_with("moves no servo");
    let edited_text = new_text.replace(
        "friction_back_over_forward = 1.",
        "friction_back_over_forward = 1.9",
    );
    assert_ne!(edited_text, new_text);
    for edited_text in [edited_text, new_text + "# mine\n"] {
        fs::write(&output, edited_text).expect("the file is written");
        run_again().expect_refusal_with("describes a robot");
    }
    let gaits = run(&["gaits", "--robot", output_name]).expect_success();
    assert!(gaits.contains("walk"));
}
