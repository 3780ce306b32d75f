//! Tests of `lizard measure servo`, `steps` and `slope` with rendered videos whose true values are known.

use std::fs;
use std::path::Path;

use fastrand::Rng;
use lizard_studio::board::{self, EVENLY_LIFTED_BOARD, LiftedBoard};
use lizard_studio::encode_jpeg;
use lizard_studio::servo::Servo;
use lizard_video::Frame;
use serde_json::Value;

use crate::harness::{assert_contains, new_folder, read_file, read_value, run_line_in};

/// Returns a function that writes a frame as a JPEG file that is named after its time.
fn frame_writer(folder: &Path) -> impl FnMut(f64, &Frame) {
    move |seconds, frame| {
        let jpeg = encode_jpeg(frame, 90).expect("the frame is encodable");
        fs::write(folder.join(format!("{seconds:.4}s.jpg")), jpeg).expect("the file is written");
    }
}

/// Writes jig.toml: the paper's robot with a slew limit above the rate of its servos.
fn write_jig_robot(folder: &Path) {
    let text = read_file("robots/paper.toml").replace("slew = 300.0", "slew = 1000.0");
    fs::write(folder.join("jig.toml"), text).expect("the file is written");
}

/// Checks that the measured value of a key is within two standard errors of its true value, and that the standard error
/// is below `max_standard_error`.
fn check_measured_value(object: &Value, key: &str, true_value: f64, max_standard_error: f64) {
    let figures = object["figures"].as_array().expect("the value is an array");
    let figure = figures.iter().find(|figure| figure["key"] == key);
    let figure = figure.unwrap_or_else(|| panic!("{key}: {object}"));
    let number_at = |field: &str| figure[field].as_f64().expect("the value is a number");
    let (standard_error, error) = (number_at("error"), number_at("measured") - true_value);
    let is_near = error.abs() < 2.0 * standard_error;
    assert!(is_near, "{figure}, true value {true_value}");
    assert!(standard_error < max_standard_error, "{figure}");
}

#[test]
fn a_video_of_a_horn_yields_the_keys_of_a_reversed_servo() {
    let folder = new_folder("horn");
    write_jig_robot(&folder);
    let servo = Servo {
        gain: -0.9,
        no_load_rate: 420.0,
        dead_band: 0.8,
        ..Servo::default()
    };
    let mut studio = super::studio();
    (studio.deck_tag_height, studio.exposure_s) = (40.0, 1.0 / 250.0);
    // A1 turns clockwise; counter-clockwise the leg would come too close to its singularity.
    let mut rng = Rng::with_seed(9);
    servo.record(&studio, -1.0, 90.0, &mut rng, frame_writer(&folder));
    let command = "measure servo . --servo A1 --robot jig.toml --height";
    let measure = |options: &str| run_line_in(&folder, &format!("{command} {options}"));
    let object = measure("40 --json").expect_json();
    check_measured_value(&object, "us_per_degree", 10.0 / servo.gain, 0.05);
    let true_seconds = 60.0 / servo.steady_rate();
    check_measured_value(&object, "s_per_60_deg", true_seconds, 0.003);
    assert_eq!(object["turns_the_other_way"], true);
    let text = measure("40").expect_success();
    assert_contains(&text, "The servo turns in the opposite direction");
    assert_contains(&text, "[servo.A1]\nus_per_degree = -11.");
    assert_contains(&text, "Not measured: stall_kg_cm");
    let output = measure("40 --volts 4.5 --output measured.toml").expect_success();
    let expected = "Written: measured.toml; its [limits] slew is still 1000 deg/s";
    assert_contains(&output, expected);
    let [old_text, new_text] = ["jig.toml", "measured.toml"]
        .map(|file| fs::read_to_string(folder.join(file)).expect("the file is readable"));
    let is_new = |line: &&str| old_text.lines().all(|old| old != *line);
    let changed_lines: Vec<&str> = new_text.lines().filter(is_new).collect();
    let changed_text = changed_lines.join("\n");
    let find_value = |key: &str| {
        let number = read_value(&changed_text, key).parse::<f64>();
        number.unwrap_or_else(|_| panic!("{key} is not a number: {changed_text}"))
    };
    assert!((find_value("us_per_degree") - 10.0 / servo.gain).abs() < 0.1);
    // The file states the time at 4.8 V, but the video was recorded at 4.5 V.
    let error_s = find_value("s_per_60_deg") - true_seconds * 4.5 / 4.8;
    assert!(error_s.abs() < 0.003, "{changed_text}");
    let printed_s = read_value(&output, "s_per_60_deg").parse::<f64>();
    assert_eq!(printed_s, Ok(find_value("s_per_60_deg")), "{output}");
    assert_eq!(find_value("volts"), 4.5);
    assert_contains(&changed_text, ", was 10.00");
    // Only the measured keys, a table header and blank lines were added.
    assert!(new_text.lines().count() - old_text.lines().count() < 8);
    measure("40 --output jig.toml").expect_refusal_with("the output must not overwrite jig.toml");
    measure("90").expect_refusal_with("according to its size, the tag on the deck or horn is");
}

#[test]
fn steps_are_printed_only_for_a_robot_with_a_slew_limit_above_its_servos_rate() {
    let folder = new_folder("steps");
    write_jig_robot(&folder);
    let print_steps = |servo: &str, robot: &str| {
        let line = format!("measure steps --list --servo {servo} --robot {robot}");
        run_line_in(&folder, &line)
    };
    let lines = print_steps("A1", "jig.toml").expect_success();
    let first_lines = "factory\npose 138.59 41.41 318.59 221.41\n";
    assert!(lines.starts_with(first_lines), "{lines}");
    let reversal = "\npose 108.59 41.41 318.59 221.41\ndir 1 -\ndir 1 +\n";
    assert_contains(&lines, reversal);
    print_steps("A1", "paper").expect_refusal_with("write slew = 1000.0 under [limits]");
    print_steps("B1", "jig.toml").expect_refusal_with("expected A1, A2, A3 or A4");
}

#[test]
fn a_video_of_a_slide_yields_the_friction_and_names_the_key_that_was_not_measured() {
    let folder = new_folder("slope");
    let sliding_board = LiftedBoard {
        static_friction: 0.45,
        sliding_friction: 0.4,
        lift_deg_per_s: 8.0,
        ..EVENLY_LIFTED_BOARD
    };
    sliding_board.record(&board::small_studio(), 30.0, frame_writer(&folder));
    let command = "measure slope . --robot paper --height 83";
    let measure = |options: &str| run_line_in(&folder, &format!("{command} {options}"));
    let object = measure("--json").expect_json();
    let true_friction = sliding_board.sliding_friction;
    check_measured_value(&object, "friction", true_friction, 0.02);
    let text = measure("").expect_success();
    assert_contains(&text, "[ground]\nfriction = 0.");
    let missing_key =
        "Not measured: friction_back_over_forward (needs a video of a slide with the head uphill)";
    assert_contains(&text, missing_key);
}
