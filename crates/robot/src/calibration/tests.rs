use super::*;

fn calibration() -> Calibration {
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
fn a_calibration_is_the_same_after_the_way_through_a_file() {
    let text = calibration().text();
    assert_eq!(Calibration::parse(&text, "a.toml"), Ok(calibration()));
}

#[test]
fn the_file_reads_as_a_person_would_write_it() {
    let text = calibration().text();
    for lines in [
        "boot = \"arc left\"\ndeadman = 1500\n",
        "[servo.A1]\ntrim = -3.25\nlimit = [48.59, 228.59]\ndir = \"-\"\nscale = 10.0\n",
    ] {
        assert!(text.contains(lines), "{text}");
    }
}

#[test]
fn a_mistake_in_a_file_is_reported_with_its_line_and_key() {
    let valid_text = calibration().text();
    let error_text = |from: &str, to: &str| {
        assert!(valid_text.contains(from), "{from}");
        let wrong_text = valid_text.replacen(from, to, 1);
        let error = Calibration::parse(&wrong_text, "a.toml").expect_err("it is wrong");
        error.to_string()
    };
    let other_error =
        Calibration::parse("[links]\nl0 = 20.0\n", "a.toml").expect_err("another file");
    let sentence = "must be \"lizard calibration 1\": this is no calibration that can be read";
    assert_eq!(
        other_error.to_string(),
        format!("a.toml: format {sentence}")
    );
    let line = 1 + valid_text
        .lines()
        .position(|line| line == "trim = -3.25")
        .expect("A1");
    let trim_prefix = format!("a.toml:{line}: servo.A1.trim ");
    for (from, to, message) in [
        (
            "calibration 1",
            "calibration 2",
            format!("a.toml:4: format {sentence}"),
        ),
        (
            "trim = -3.25\n",
            "",
            format!(
                "a.toml:{}: servo.A1.trim is missing; it must be a number",
                line - 1
            ),
        ),
        (
            "trim = -3.25",
            "trim = \"much\"",
            format!("{trim_prefix}is the string \"much\"; it must be a number"),
        ),
        (
            "trim = -3.25",
            "trim = 1.234",
            format!("{trim_prefix}is 1.234; it must have at most two decimals"),
        ),
        (
            "trim = -3.25",
            "trim = 1e9",
            format!("{trim_prefix}is 1e9; it must be within -360 to 360 deg"),
        ),
        (
            "arc left",
            "walk\\nsave",
            "a.toml:5: boot is not the name of a gait".to_owned(),
        ),
        (
            "deadman = 1500",
            "deadman = 1.5",
            "a.toml:6: deadman must be a whole number of ms".to_owned(),
        ),
    ] {
        assert_eq!(error_text(from, to), message);
    }
    for (from, to, phrase) in [
        (
            "trim = -3.25",
            "trim = nan",
            "servo.A1.trim is nan; it must be a number",
        ),
        (
            "dir = \"-\"",
            "dir = \"left\"",
            "servo.A1.dir is \"left\"; it must be \"+\" or \"-\"",
        ),
        (
            "[48.59, 228.59]",
            "[1]",
            "servo.A1.limit is an array of 1; it must be an array of two numbers",
        ),
        (
            "[48.59, 228.59]",
            "[1, 2.001]",
            "servo.A1.limit is 2.001; it must have at most two decimals",
        ),
        (
            "scale = 10.0",
            "scale = 10.0\nscal = 9",
            "servo.A1.scal is not a known key",
        ),
        (
            "deadman = 1500",
            "deadman = -1",
            "deadman is -1; it must be within 0 to 60000 ms",
        ),
        ("format = \"", "format = \"x\n", "lacks the = between"),
    ] {
        let message = error_text(from, to);
        assert!(message.contains(phrase), "{message} / {phrase}");
    }
}

#[test]
fn the_lines_of_a_robot_are_read_and_are_those_that_set_it() {
    let answer = "# boot arc left|# deadman 1500|# A1 trim -3.25 limit 48.59 228.59 dir - scale 10|# t=1 pose=1,2,3,4|\
        # A2 trim 0 limit 48.59 228.59 dir - scale 10|# A3 trim 0.1 limit 48.59 228.59 dir - scale 10|\
        # A4 trim 20 limit 48.59 228.59 dir - scale 10";
    let lines: Vec<String> = answer.split('|').map(str::to_owned).collect();
    assert_eq!(Calibration::from_lines(&lines), Some(calibration()));
    for index in 0..lines.len() {
        let mut rest = lines.clone();
        let is_needed = !rest.remove(index).contains("pose");
        assert_eq!(
            Calibration::from_lines(&rest).is_none(),
            is_needed,
            "{rest:?}"
        );
    }
    let set_lines = calibration().lines();
    assert_eq!(set_lines.len(), 18);
    let first_lines = [
        "dir 1 -",
        "scale 1 10.00",
        "trim 1 -3.25",
        "limit 1 48.59 228.59",
    ];
    assert_eq!(set_lines[..4], first_lines);
    assert_eq!(set_lines[16..], ["boot arc left", "deadman 1500"]);
}

#[test]
fn another_scale_or_sign_leaves_the_neutral_pulse_where_it_is() {
    // Change of the neutral pulse by the trim, us.
    let pulse_shift_us = |servo: ServoSettings| {
        let sign = if servo.dir == '+' { 1.0 } else { -1.0 };
        sign * servo.trim * servo.scale
    };
    for trim in [-7.2, -3.25, 0.0, 0.01, 5.0] {
        for scale in [8.5, 10.0, 11.11] {
            let servo = ServoSettings {
                trim,
                ..calibration().servos[0]
            };
            let scaled = servo.with_scale(scale);
            assert_eq!(scaled.scale, scale);
            // A trim is rounded to hundredths of a degree.
            assert!(
                (pulse_shift_us(scaled) - pulse_shift_us(servo)).abs() <= 0.005 * scale + 1e-9,
                "{scaled:?}"
            );
            let reversed = servo.reversed();
            assert_eq!(pulse_shift_us(reversed), pulse_shift_us(servo));
            assert_eq!(reversed.reversed(), servo);
            assert!(
                reversed.trim.is_sign_positive() || reversed.trim < 0.0,
                "no -0"
            );
        }
    }
}

#[test]
fn calibrations_that_differ_in_anything_are_not_the_same_but_a_turn_is_no_difference() {
    let changes: [fn(&mut Calibration); 6] = [
        |calibration| calibration.servos[0].trim = 0.01,
        |calibration| calibration.servos[1].limit[1] += 0.01,
        |calibration| calibration.servos[2].dir = '+',
        |calibration| calibration.servos[3].scale = 10.01,
        |calibration| calibration.boot = "walk".to_owned(),
        |calibration| calibration.deadman = 1,
    ];
    for (index, change) in changes.into_iter().enumerate() {
        let mut changed = calibration();
        change(&mut changed);
        assert!(!changed.is_same(&calibration()), "change {index}");
    }
    let mut turned = calibration();
    turned.servos[2].limit = [48.59 - 360.0, 228.59 - 360.0];
    assert!(turned.is_same(&calibration()));
}

/// Sends the lines of a transfer to a robot that refuses some. Returns those sent, and true if all were accepted.
fn send(is_refused: impl Fn(&str, &[String]) -> bool) -> (Vec<String>, bool) {
    let (mut transfer, mut sent, mut accepted) =
        (Transfer::new(&calibration()), Vec::new(), Vec::new());
    while let Some(line) = transfer.next_line() {
        match is_refused(&line, &accepted) {
            true => {
                transfer.refuse();
            }
            false => accepted.push(line.clone()),
        }
        sent.push(line);
        assert!(sent.len() < 500, "it ends");
    }
    (sent, transfer.is_done())
}

#[test]
fn refused_lines_are_sent_again_after_the_others_and_once_more_from_robot_toml() {
    let lines = calibration().lines();
    assert_eq!(send(|_, _| false), (lines.clone(), true));
    // A trim that is accepted only after the limit.
    let (sent, is_done) = send(|line, accepted| {
        line.starts_with("trim 1") && !accepted.iter().any(|other| other.starts_with("limit 1"))
    });
    assert!(is_done);
    assert_eq!(sent[18..], ["trim 1 -3.25"]);
    // A scale that is accepted only after `factory`, with robot.toml's settings.
    let needs_factory = |line: &str, accepted: &[String]| {
        line.starts_with("scale 2") && !accepted.iter().any(|other| other == "factory")
    };
    let (sent, is_done) = send(needs_factory);
    assert!(is_done);
    assert_eq!(sent[18..20], ["scale 2 10.00", "factory"]);
    assert_eq!(sent[20..], lines);
    // A line that is never accepted is given up after one more round from `factory`.
    let (sent, is_done) = send(|line, _| line.starts_with("limit 4"));
    assert!(!is_done);
    assert_eq!(
        sent.iter()
            .filter(|line| line.as_str() == "factory")
            .count(),
        1
    );
    assert!(!send(|_, _| true).1);
}
