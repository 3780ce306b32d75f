//! Tests of calibration files, of console lines and of transfers.

use super::*;
use crate::testing::{assert_contains, read_table};

/// A calibration with a different trim for each servo.
fn example_calibration() -> Calibration {
    let servo_with = |trim| ServoSettings {
        trim,
        limit: [48.59, 228.59],
        dir: '-',
        scale: 10.0,
    };
    Calibration {
        boot: "arc left".to_owned(),
        deadman: 1500,
        servos: [-3.25, 0.0, 0.1, 20.0].map(servo_with),
    }
}

#[test]
fn a_calibration_written_as_a_file_is_read_back_unchanged() {
    let text = example_calibration().to_toml();
    let calibration = Calibration::parse(&text, "a.toml");
    assert_eq!(calibration, Ok(example_calibration()));
}

#[test]
fn a_file_has_one_line_for_each_setting() {
    let text = example_calibration().to_toml();
    for lines in [
        "boot = \"arc left\"\ndeadman = 1500\n",
        "[servo.A1]\ntrim = -3.25\nlimit = [48.59, 228.59]\ndir = \"-\"\nscale = 10.0\n",
    ] {
        assert!(text.contains(lines), "{text}");
    }
}

#[test]
fn an_error_in_a_file_is_reported_with_its_line_and_key() {
    let valid_text = example_calibration().to_toml();
    let error_message = |old: &str, new: &str| {
        assert!(valid_text.contains(old), "{old}");
        let invalid_text = valid_text.replacen(old, new, 1);
        let result = Calibration::parse(&invalid_text, "a.toml");
        result.expect_err("the changed text is invalid").to_string()
    };
    let result = Calibration::parse("[links]\nl0 = 20.0\n", "a.toml");
    let robot_file_error = result.expect_err("a robot file is not a calibration");
    let format_problem =
        "must be \"lizard calibration 1\": this is not a calibration file of a supported version";
    let expected = format!("a.toml: format {format_problem}");
    assert_eq!(robot_file_error.to_string(), expected);
    let trim = "a.toml:9: servo.A1.trim";
    let mistakes = format!(
        r#"
        calibration 1 | calibration 2 | a.toml:4: format {format_problem}
        trim = -3.25 | trim = "much" | {trim} is the string "much"; it must be a number
        trim = -3.25 | trim = 1.234 | {trim} is 1.234; it must have at most two decimals
        trim = -3.25 | trim = 1e9 | {trim} is 1e9; it must be between -360 and 360 deg
        trim = -3.25 | trim = nan | {trim} is nan; it must be a number
        scale = 10.0 | scale = 400.0 | a.toml:12: servo.A1.scale is 400; it must be between -360 and 360 us per deg
        [48.59, 228.59] | [1] | a.toml:10: servo.A1.limit is an array of 1; it must be an array of two numbers
        [48.59, 228.59] | [1, 2.001] | a.toml:10: servo.A1.limit is 2.001; it must have at most two decimals
        dir = "-" | dir = "left" | a.toml:11: servo.A1.dir is "left"; it must be "+" or "-"
        arc left | walk\nsave | a.toml:5: boot must be the name of a gait or a routine, or "rest"
        deadman = 1500 | deadman = 1.5 | a.toml:6: deadman must be a whole number of ms
        deadman = 1500 | deadman = -1 | a.toml:6: deadman is -1; it must be between 0 and 60000 ms
        "#
    );
    for [old, new, message] in read_table(&mistakes) {
        assert_eq!(error_message(old, new), message);
    }
    let no_trim = error_message("trim = -3.25\n", "");
    // A missing key is reported on the line of its table.
    let expected = "a.toml:8: servo.A1.trim is missing; it must be a number";
    assert_eq!(no_trim, expected);
    let unknown_key = error_message("scale = 10.0", "scale = 10.0\nscal = 9");
    assert_contains(&unknown_key, "servo.A1.scal is not a known key");
    let broken_line = error_message("format = \"", "format = \"x\n");
    assert_contains(&broken_line, "is missing the = between");
}

#[test]
fn the_answer_to_cal_and_the_console_lines_contain_every_setting() {
    let answer = "# boot arc left|# deadman 1500|# A1 trim -3.25 limit 48.59 228.59 dir - scale 10|# t=1 pose=1,2,3,4|\
        # A2 trim 0 limit 48.59 228.59 dir - scale 10|# A3 trim 0.1 limit 48.59 228.59 dir - scale 10|\
        # A4 trim 20 limit 48.59 228.59 dir - scale 10";
    let lines: Vec<String> = answer.split('|').map(str::to_owned).collect();
    let calibration = Calibration::from_cal_answer(&lines);
    assert_eq!(calibration, Some(example_calibration()));
    for index in 0..lines.len() {
        let mut remaining_lines = lines.clone();
        let is_needed = !remaining_lines.remove(index).contains("pose");
        let calibration = Calibration::from_cal_answer(&remaining_lines);
        assert_eq!(calibration.is_none(), is_needed, "{remaining_lines:?}");
    }
    let console_lines = example_calibration().to_console_lines();
    assert_eq!(console_lines.len(), 18);
    let first_lines = "dir 1 -|scale 1 10.00|trim 1 -3.25|limit 1 48.59 228.59";
    assert_eq!(console_lines[..4].join("|"), first_lines);
    assert_eq!(console_lines[16..], ["boot arc left", "deadman 1500"]);
}

#[test]
fn changing_the_scale_or_the_direction_keeps_the_neutral_pulse_width() {
    // The trim's effect on the neutral pulse width, us.
    let pulse_shift_us = |servo: ServoSettings| {
        let sign = if servo.dir == '+' { 1.0 } else { -1.0 };
        sign * servo.trim * servo.scale
    };
    for trim in [-7.2, -3.25, 0.0, 0.01, 5.0] {
        for scale in [8.5, 10.0, 11.11] {
            let servo = ServoSettings {
                trim,
                ..example_calibration().servos[0]
            };
            let scaled = servo.with_scale(scale);
            assert_eq!(scaled.scale, scale);
            // A trim is rounded to hundredths of a degree.
            let error_us = pulse_shift_us(scaled) - pulse_shift_us(servo);
            assert!(error_us.abs() <= 0.005 * scale + 1e-9, "{scaled:?}");
            let reversed = servo.reversed();
            assert_eq!(pulse_shift_us(reversed), pulse_shift_us(servo));
            assert_eq!(reversed.reversed(), servo);
            let is_not_negative_zero = reversed.trim.is_sign_positive() || reversed.trim < 0.0;
            assert!(is_not_negative_zero, "the trim must not be -0");
        }
    }
}

#[test]
fn equivalent_calibrations_differ_at_most_by_full_turns_of_the_limits() {
    let changes: [fn(&mut Calibration); 6] = [
        |calibration| calibration.servos[0].trim = 0.01,
        |calibration| calibration.servos[1].limit[1] += 0.01,
        |calibration| calibration.servos[2].dir = '+',
        |calibration| calibration.servos[3].scale = 10.01,
        |calibration| calibration.boot = "walk".to_owned(),
        |calibration| calibration.deadman = 1,
    ];
    for (index, change) in changes.into_iter().enumerate() {
        let mut changed_calibration = example_calibration();
        change(&mut changed_calibration);
        let is_equivalent = changed_calibration.is_equivalent_to(&example_calibration());
        assert!(!is_equivalent, "change {index}");
    }
    let mut turned_calibration = example_calibration();
    turned_calibration.servos[2].limit = [48.59 - 360.0, 228.59 - 360.0];
    assert!(turned_calibration.is_equivalent_to(&example_calibration()));
}

/// Sends the lines of a transfer to a robot that refuses some of the lines. Returns the sent lines, and true if every
/// setting was accepted in the end.
fn simulate_transfer(is_refused: impl Fn(&str, &[String]) -> bool) -> (Vec<String>, bool) {
    let mut transfer = Transfer::new(&example_calibration());
    let (mut sent_lines, mut accepted_lines) = (Vec::new(), Vec::new());
    while let Some(line) = transfer.next_line() {
        if is_refused(&line, &accepted_lines) {
            transfer.record_refusal();
        } else {
            accepted_lines.push(line.clone());
        }
        sent_lines.push(line);
        assert!(sent_lines.len() < 500, "the transfer must end");
    }
    (sent_lines, transfer.is_done())
}

#[test]
fn refused_lines_are_sent_again_and_once_more_after_factory() {
    let lines = example_calibration().to_console_lines();
    assert_eq!(simulate_transfer(|_, _| false), (lines.clone(), true));
    // A trim that is accepted only after the limit.
    let (sent_lines, is_done) = simulate_transfer(|line, accepted| {
        line.starts_with("trim 1") && !accepted.iter().any(|sent| sent.starts_with("limit 1"))
    });
    assert!(is_done);
    assert_eq!(sent_lines[18..], ["trim 1 -3.25"]);
    // A scale that is accepted only after `factory`, with robot.toml's settings.
    let needs_factory = |line: &str, accepted: &[String]| {
        line.starts_with("scale 2") && !accepted.iter().any(|sent| sent == "factory")
    };
    let (sent_lines, is_done) = simulate_transfer(needs_factory);
    assert!(is_done);
    assert_eq!(sent_lines[18..20], ["scale 2 10.00", "factory"]);
    assert_eq!(sent_lines[20..], lines);
    // The transfer gives up a line that is still refused after the round that starts with `factory`.
    let (sent_lines, is_done) = simulate_transfer(|line, _| line.starts_with("limit 4"));
    assert!(!is_done);
    let is_factory = |line: &&String| *line == "factory";
    assert_eq!(sent_lines.iter().filter(is_factory).count(), 1);
    assert!(!simulate_transfer(|_, _| true).1);
}
