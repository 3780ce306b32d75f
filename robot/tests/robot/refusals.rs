//! What an author of robot.toml may do wrong, and the sentence that says so.

use lizard_robot::Robot;

use crate::{text, with};

/// What to replace, by what, and the message after the file's name.
const CASES: &[(&str, &str, &str)] = &[
    (
        "l1 = 30.0 ",
        r#"l1 = "30" "#,
        r#"links.l1 is the string "30"; it must be a number"#,
    ),
    (
        "l1 = 30.0 ",
        "L1 = 30.0 ",
        r#"links.L1 is not a known key; did you mean "l1"?"#,
    ),
    (
        r#"l13 = 45.0
"#,
        "",
        "links.l13 is missing; it must be a number",
    ),
    (
        "l3 = 50.0 ",
        "l3 = 51.0 ",
        "links.l3 is 51, but links.l2 is 50; the two couplers of a loop are equally long",
    ),
    (
        "l8 = 50.0 ",
        "l8 = 40.0 ",
        "links.l8 is 40, but links.l7 is 50; the two couplers of a loop are equally long",
    ),
    (
        "l15 = 135.0",
        "l15 = 134.0",
        "links.l15 is 134, but links.l10 is 135; the chassis is a rectangle",
    ),
    (
        "l0 = 20.0 ",
        "l0 = 70.0 ",
        "links.l0: the head's l0 + l1 + l4 is 130 mm; the firmware's fixed point holds less than 127 mm",
    ),
    (
        "l11 = 30.0",
        "l11 = 100.0",
        "links.l10: the left side's l10 + l11 + l14 + |l5 - l0|/2 is 265 mm; the firmware's fixed point holds less than 255 mm",
    ),
    (
        "l7 = 50.0 ",
        "l7 = -50.0 ",
        "links.l7 is -50; it must be within 17 to 255 mm",
    ),
    (
        "l7 = 50.0 ",
        "l7 = nan ",
        "links.l7 is nan; it must be a number",
    ),
    (
        "coupler = 50.0",
        "coupler = 49.0",
        "leg.coupler is 49, but leg.ground is 50; a leg is a parallelogram",
    ),
    (
        "follower = 45.0",
        "follower = 44.0",
        "leg.follower is 44, but leg.crank is 45; a leg is a parallelogram",
    ),
    (
        "hip_side = 35.0",
        "hip_sdie = 35.0",
        r#"leg.hip_sdie is not a known key; did you mean "hip_side"?"#,
    ),
    (
        "[servo.A4]",
        "[servo.A5]",
        "servo.A5 is not a known key; allowed are A1, A2, A3, A4",
    ),
    (
        r#"pin = "D10""#,
        r#"pin = "D9""#,
        r#"servo.A2.pin is "D9", which servo.A1 has already"#,
    ),
    (
        r#"pin = "D3""#,
        r#"pin = "D1""#,
        r#"servo.A4.pin is "D1"; it must be one of D2 to D12 or A0 to A5 (D0 and D1 are the serial line, D13 is the LED)"#,
    ),
    (
        r#"pin = "D3""#,
        r#"pin = "D13""#,
        r#"servo.A4.pin is "D13"; it must be one of D2 to D12 or A0 to A5 (D0 and D1 are the serial line, D13 is the LED)"#,
    ),
    (
        r#"pin = "D3""#,
        "pin = 3",
        "servo.A4.pin is 3; it must be a string",
    ),
    (
        r#"pin = "D3""#,
        r#"pin = "D03""#,
        r#"servo.A4.pin is "D03"; it must be one of D2 to D12 or A0 to A5 (D0 and D1 are the serial line, D13 is the LED)"#,
    ),
    (
        r#"pin = "D3""#,
        r#"pin = "A6""#,
        r#"servo.A4.pin is "A6"; it must be one of D2 to D12 or A0 to A5 (D0 and D1 are the serial line, D13 is the LED)"#,
    ),
    (
        "us_per_degree = 10.0",
        "us_per_degree = 0",
        "servo.A1.us_per_degree is 0; it must be within 1 to 22 us, or -22 to -1 where a longer pulse turns the horn clockwise",
    ),
    (
        "us_per_degree = 10.0",
        "us_per_degree = -23.0",
        "servo.A1.us_per_degree is -23; it must be within 1 to 22 us, or -22 to -1 where a longer pulse turns the horn clockwise",
    ),
    (
        "us_per_degree = 10.0",
        "us_per_degre = 10.0",
        r#"servo.A1.us_per_degre is not a known key; did you mean "us_per_degree"?"#,
    ),
    (
        "min_us = 600.0",
        "min_us = 400.0",
        "servo.A1.min_us is 400; it must be within 500 to 2500 us",
    ),
    (
        "max_us = 2400.0",
        "max_us = 4000.0",
        "servo.A1.max_us is 4000; it must be within 500 to 2500 us",
    ),
    (
        "min_us = 600.0",
        "min_us = 1600.0",
        "servo.A1.min_us is 1600; it must be less than neutral_us, which is 1500",
    ),
    (
        "neutral_us = 1500.0",
        "neutral_us = 2400.0",
        "servo.A1.neutral_us is 2400; it must be less than max_us, which is 2400",
    ),
    (
        "neutral = 138.590378",
        "neutral = 170.0",
        "servo: the neutral pose is not safe: margin leg_fl 0.174 is below 0.300",
    ),
    (
        "neutral = 138.590378",
        "neutral = 60.0",
        "servo: the neutral pose is not safe: margin type1_a1 -0.018 is below 0.300",
    ),
    (
        "neutral = 138.590378",
        "neutral = -221.4",
        "servo.A1.neutral is -221.4; it must be within 0 to 360 deg",
    ),
    (
        "type2 = 0.3 ",
        "type2 = 0.05 ",
        "limits.type2 is 0.05; it must be within 0.1 to 0.95 (a sine)",
    ),
    (
        "leg = 0.3 ",
        "leg = 1.3 ",
        "limits.leg is 1.3; it must be within 0 to 0.95 (a sine)",
    ),
    (
        "stroke_min = -15.0",
        "stroke_min = 60.0",
        "limits.stroke_min is 60; it must be less than stroke_max, which is 45",
    ),
    (
        "stroke_max = 45.0",
        "stroke_max = 200.0",
        "limits.stroke_max is 200; it must be within -90 to 165 mm, so that the slider stays within 0 to 255 mm",
    ),
    (
        "gait_slew = 310.0",
        "gait_slew = 0",
        "limits.gait_slew is 0; it must be within 10 to 1000 deg/s",
    ),
    (
        "friction_back_over_forward = 1.0",
        "friction_back_over_forward = -1.0",
        "ground.friction_back_over_forward is -1; it must be within 0.1 to 10 (a ratio)",
    ),
    (
        "[ground] ",
        "[grund] ",
        r#"grund is not a known key; did you mean "ground"?"#,
    ),
    (
        r#"[gait.stand]
period = 1.0
waveform = "still""#,
        "",
        "gait: the first gait must be stand, the neutral pose that the robot takes at power-on",
    ),
    (
        r#"[gait.stand]
period = 1.0
waveform = "still""#,
        r#"[gait.stand]
mirror = "walk""#,
        r#"gait.stand must be the neutral pose that the robot takes at power-on: waveform = "still" and a period"#,
    ),
    (
        "[gait.walk]",
        "[gait.Walk]",
        "gait.Walk is no gait name: it must be lower-case letters, digits and dashes, a letter first",
    ),
    (
        "[gait.walk]",
        "[gait.walk-very-slowly]",
        "gait.walk-very-slowly is no gait name: it must have at most 12 characters",
    ),
    (
        "[gait.walk]",
        "[gait.walk-]",
        "gait.walk- is no gait name: a dash stands for a blank between two words",
    ),
    (
        "[gait.walk]",
        "[gait.status]",
        r#"gait.status is no gait name: "status" is a command of the console"#,
    ),
    (
        "[gait.walk]",
        "[gait.pose-left]",
        r#"gait.pose-left is no gait name: "pose" is a command of the console"#,
    ),
    (
        "[gait.walk]",
        r#"[gait."?"]"#,
        "gait.? is no gait name: it must be lower-case letters, digits and dashes, a letter first",
    ),
    (
        "[gait.walk]",
        r#"[gait.walk]
colour = "green""#,
        "gait.walk.colour is not a known key; allowed are period, waveform, duty, amplitude, start, order, gain, reverse, mirror, like, head, tail",
    ),
    (
        r#"amplitude = 20.0
start"#,
        r#"amplitud = 20.0
start"#,
        r#"gait.walk.amplitud is not a known key; did you mean "amplitude"?"#,
    ),
    (
        r#"waveform = "wave""#,
        r#"waveform = "wawe""#,
        r#"gait.walk.waveform is "wawe"; did you mean "wave"?"#,
    ),
    (
        r#"waveform = "wave""#,
        r#"waveform = "sine""#,
        r#"gait.walk.waveform is "sine"; allowed are still, wave, held"#,
    ),
    (
        r#"duty = 0.75
"#,
        "",
        "gait.walk.duty is missing; it must be a number",
    ),
    (
        "duty = 0.75",
        "duty = 1.0",
        "gait.walk.duty is 1; it must be within 0.05 to 0.95 of the cycle",
    ),
    (
        "period = 1.25",
        "period = 0.0",
        "gait.trot.period is 0; it must be within 0.2 to 60 s",
    ),
    (
        "start = { LH = 0.0, LF = 0.25, RH = 0.5, RF = 0.75 }",
        "start = { LH = 0.0, LF = 0.25, RH = 0.5 }",
        "gait.walk.start.RF is missing; it must be a number",
    ),
    (
        "start = { LH = 0.0, LF = 0.25, RH = 0.5, RF = 0.75 }",
        "start = { LH = 0.0, LF = 0.25, RH = 0.5, FR = 0.75 }",
        "gait.walk.start.FR is not a known key; allowed are LF, RF, RH, LH",
    ),
    (
        r#"order = ["LH", "LF", "RH", "RF"]"#,
        r#"order = ["LH", "LF", "RH", "LH"]"#,
        "gait.crawl.order must list each of LF, RF, RH, LH exactly once",
    ),
    (
        r#"order = ["LH", "LF", "RH", "RF"]"#,
        r#"order = "LH LF RH RF""#,
        r#"gait.crawl.order is the string "LH LF RH RF"; it must be an array of strings"#,
    ),
    (
        r#"order = ["LH", "LF", "RH", "RF"]"#,
        r#"order = ["LH", "LF", "RH", "RF"]
duty = 0.5"#,
        r#"gait.crawl.duty does not go with waveform = "held""#,
    ),
    (
        r#"reverse = "walk""#,
        r#"reverse = "wlak""#,
        r#"gait.back.reverse names the gait "wlak", which does not exist; did you mean "walk"?"#,
    ),
    (
        r#"reverse = "walk""#,
        r#"reverse = "gallop""#,
        r#"gait.back.reverse names the gait "gallop", which does not exist; allowed are stand, walk, trot, crawl, back, left, right, arc-left, arc-right, look"#,
    ),
    (
        r#"reverse = "walk""#,
        r#"reverse = "back""#,
        "gait.back.reverse: the gaits refer to each other in a circle: back -> back",
    ),
    (
        r#"mirror = "left""#,
        r#"mirror = "right""#,
        "gait.right.mirror: the gaits refer to each other in a circle: right -> right",
    ),
    (
        r#"like = "walk""#,
        r#"like = "arc-right""#,
        "gait.arc-right.mirror: the gaits refer to each other in a circle: arc-left -> arc-right -> arc-left",
    ),
    (
        r#"mirror = "left""#,
        r#"mirror = "left"
like = "walk""#,
        "gait.right needs exactly one of waveform, a path (head, tail), reverse, mirror, like",
    ),
    (
        r#"reverse = "walk""#,
        r#"reverse = "walk"
duty = 0.5"#,
        "gait.back.duty does not go with reverse",
    ),
    (
        r#"waveform = "held"
amplitude = 20.0
"#,
        r#"amplitude = 20.0
"#,
        "gait.crawl needs exactly one of waveform, a path (head, tail), reverse, mirror, like",
    ),
    (
        "gain = { LF = -1.0, LH = -1.0 }",
        "gain = { LF = -9.0, LH = -1.0 }",
        "gait.left.gain.LF is -9; it must be within -4 to 4 (a factor)",
    ),
    (
        "centre = [0.0, 54.0]",
        "centre = [0.0, 76.0]",
        "gait.look.head: the point (3.08, 78.93) mm at phase 0.0498 is out of reach of the head",
    ),
    (
        "centre = [0.0, 54.0]",
        "centre = [0.0, 52.0]",
        "gait.look: at phase 0.3428: margin leg_fr 0.262 is below 0.300",
    ),
    (
        "centre = [0.0, 54.0]",
        "centre = [0.0]",
        "gait.look.head.centre is an array of 1; it must be an array of two numbers",
    ),
    (
        "k = 1, amplitude",
        "k = 1.5, amplitude",
        "gait.look.head.x[0].k is 1.5; it must be a whole number",
    ),
    (
        "k = 1, amplitude",
        "amplitude",
        "gait.look.head.x[0].k is missing; it must be a number",
    ),
    (
        "period = 4.0",
        "period = 0.5",
        "gait.look: at phase 0.9766 servo A1 would turn at 340.1 deg/s; limits.gait_slew is 310.0 deg/s",
    ),
    (
        "amplitude = 15.0",
        "amplitude = 17.0",
        "gait.trot: at phase 0.0544 servo A1 would turn at 338.9 deg/s; limits.gait_slew is 310.0 deg/s",
    ),
    (
        "amplitude = 15.0",
        "amplitude = 25.0",
        "gait.trot: at phase 0.0000: margin leg_fl 0.284 is below 0.300",
    ),
    (
        r#"like = "walk""#,
        r#"like = "walk"
period = 0.8"#,
        "gait.arc-left: at phase 0.3625 servo A3 would turn at 327.3 deg/s; limits.gait_slew is 310.0 deg/s",
    ),
    (
        "min_us = 600.0",
        "min_us = 1400.0",
        "gait.walk: at phase 0.1650 servo A1 would be at 128.50 deg, outside its travel of 128.59 to 228.59 deg",
    ),
    (
        "stroke_min = -15.0",
        "stroke_min = -10.0",
        "gait.walk: at phase 0.0000: left slider travel -10.75 mm is below -10.00 mm",
    ),
    (
        "stroke_max = 45.0",
        "stroke_max = 15.0",
        "gait.left: at phase 0.4023: left slider travel +16.29 mm is above +15.00 mm",
    ),
    (
        "type2 = 0.3 ",
        "type2 = 0.9 ",
        "gait.crawl: at phase 0.0000: margin apex_head 0.851 is below 0.900",
    ),
    (
        r#"duty = 0.875
amplitude = 15.0"#,
        r#"duty = 0.95
amplitude = 15.0"#,
        "gait.trot: at phase 0.0920 servo A1 would turn at 706.4 deg/s; limits.gait_slew is 310.0 deg/s",
    ),
    (
        r#"period = 1.25
waveform = "wave"
duty = 0.875"#,
        r#"period = 4.0
waveform = "wave"
duty = 0.95"#,
        "gait.trot: its table of 128 samples is 0.490 deg off at phase 0.1211 (servo A1); at most 0.10 deg is allowed",
    ),
    (
        "amplitude = 15.0",
        "amplitude =",
        "not TOML: string values must be quoted, expected literal string",
    ),
    (
        "amplitude = 15.0",
        r#"amplitude = 15.0
amplitude = 15.0"#,
        "not TOML: duplicate key",
    ),
];

#[test]
fn every_mistake_gets_its_sentence() {
    for (from, to, expected) in CASES {
        let error = with(from, to)
            .err()
            .unwrap_or_else(|| panic!("{to:?} was accepted"));
        let line = error.line.expect("a line");
        assert_eq!(
            error.to_string(),
            format!("robot.toml:{line}: {expected}"),
            "for {to:?}"
        );
    }
}

#[test]
fn every_mistake_gets_the_line_of_its_key_or_table() {
    for (from, to, _) in CASES {
        let text = text().replacen(from, to, 1);
        let error = Robot::parse(&text).expect_err(to);
        let line = text.lines().nth(error.line.expect("a line") - 1).expect(to);
        let mut names = error.key.split(['.', '[']).filter(|name| *name != "gait");
        let named = names.any(|name| line.contains(name))
            || line.contains("[gait")
            || line.contains("amplitude =");
        assert!(named, "{line:?} for {error}");
    }
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = Robot::load("no/such/robot.toml")
        .expect_err("there is none")
        .to_string();
    assert!(
        error.starts_with("no/such/robot.toml: cannot be read: "),
        "{error}"
    );
}

#[test]
fn an_empty_file_asks_for_its_first_table() {
    let error = Robot::parse("").expect_err("it is empty").to_string();
    assert_eq!(error, "robot.toml: links is missing; it must be a table");
}

#[test]
fn the_limits_of_every_range_are_allowed() {
    for (from, to) in [
        ("min_us = 600.0", "min_us = 500.0"),
        ("max_us = 2400.0", "max_us = 2500"),
        ("us_per_degree = 10.0", "us_per_degree = -10.0"),
        ("us_per_degree = 10.0", "us_per_degree = 22"),
        ("us_per_degree = 10.0", "us_per_degree = -22"),
        ("pin = \"D3\"", "pin = \"A5\""),
        ("pin = \"D3\"", "pin = \"D12\""),
        (
            "[gait.walk]",
            "[gait.walk-slow1]\nlike = \"walk\"\nperiod = 60\n[gait.walk]",
        ),
    ] {
        if let Err(error) = with(from, to) {
            panic!("{to:?}: {error}");
        }
    }
}

#[test]
fn the_project_robot_is_accepted() {
    assert!(Robot::parse(&text()).is_ok());
}
