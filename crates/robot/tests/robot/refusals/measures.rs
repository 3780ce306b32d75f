//! Mistakes in measurements, servos and limits.

use super::Mistake;

pub const MISTAKES: &[Mistake] = &[
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
        "l15 = 135.0",
        "l15 = 134.0",
        "links.l15 is 134, but links.l10 is 135; the chassis is a rectangle, so its two sides are equally long",
    ),
    (
        "l7 = 50.0 ",
        "l7 = -50.0 ",
        "links.l7 is -50; it must be within 1 to 1000 mm",
    ),
    (
        "l10 = 135.0",
        "l10 = 1000.001",
        "links.l10 is 1000.001; it must be within 1 to 1000 mm",
    ),
    (
        "l10 = 135.0",
        "l10 = 1e308",
        "links.l10 is 1e308; it must be within 1 to 1000 mm",
    ),
    (
        "l10 = 135.0",
        "l10 = 1e309",
        "links.l10 is 1e309; it must be a number",
    ),
    (
        "l2 = 50.0 ",
        "l2 = 16.0 ",
        "links.l2 is 16 mm, which is short beside the rest of its loop; the firmware's 16-bit integers ask for at least 16.1 mm, or for shorter cranks and a shorter base",
    ),
    (
        "l8 = 50.0 ",
        "l8 = 15.0 ",
        "links.l8 is 15 mm, which is short beside the rest of its loop; the firmware's 16-bit integers ask for at least 16.1 mm, or for shorter cranks and a shorter base",
    ),
    (
        "l7 = 50.0 ",
        "l7 = nan ",
        "links.l7 is nan; it must be a number",
    ),
    (
        "coupler = 50.0",
        "coupler = 49.0",
        "leg.coupler is 49, but leg.ground is 50; a leg is a parallelogram, so its opposite links are equally long",
    ),
    (
        "follower = 45.0",
        "follower = 44.0",
        "leg.follower is 44, but leg.crank is 45; a leg is a parallelogram, so its opposite links are equally long",
    ),
    (
        "mount = 0.0 ",
        "hip_sdie = 35.0\nmount = 0.0 ",
        r#"leg.hip_sdie is not a known key; did you mean "hip_side"?"#,
    ),
    (
        "mount = 0.0 ",
        "hip_side = -1.0\nmount = 0.0 ",
        "leg.hip_side is -1; it must be within 0 to 500 mm",
    ),
    (
        "mount = 0.0 ",
        "spring = 10.0\nmount = 0.0 ",
        r#"leg.spring is not read any more; write [leg.drive] with kind = "spring", stiffness and preload, or with kind = "strut" and the force and rate of its spring"#,
    ),
    (
        "mount = 0.0 ",
        "preload = 60.0\nmount = 0.0 ",
        r#"leg.preload is not read any more; write [leg.drive] with kind = "spring", stiffness and preload, or with kind = "strut" and the force and rate of its spring"#,
    ),
    (
        "mount = 0.0 ",
        "drive = 3\nmount = 0.0 ",
        "leg.drive is 3; it must be a table",
    ),
    (
        "mount = 0.0 ",
        "drive = { kind = \"sprung\" }\nmount = 0.0 ",
        r#"leg.drive.kind is "sprung"; did you mean "spring"?"#,
    ),
    (
        "mount = 0.0 ",
        "drive = { kind = \"spring\", stiffness = 0 }\nmount = 0.0 ",
        "leg.drive.stiffness is 0; it must be within 0.01 to 10000 N mm/deg",
    ),
    (
        "mount = 0.0 ",
        "drive = { kind = \"spring\", preload = 60 }\nmount = 0.0 ",
        "leg.drive.stiffness is missing; it must be a number",
    ),
    (
        "mount = 0.0 ",
        "drive = { kind = \"spring\", stiffness = 2, preload = -1 }\nmount = 0.0 ",
        "leg.drive.preload is -1; it must be within 0 to 10000 N mm",
    ),
    (
        "mount = 0.0 ",
        "drive = { force = 4.0 }\nmount = 0.0 ",
        r#"leg.drive.force does not go with kind = "rigid""#,
    ),
    (
        "mount = 0.0 ",
        "drive = { kind = \"strut\", stiffness = 4.0 }\nmount = 0.0 ",
        r#"leg.drive.stiffness does not go with kind = "strut""#,
    ),
    (
        "mount = 0.0 ",
        "drive = { kind = \"strut\", force = 0 }\nmount = 0.0 ",
        "leg.drive.force is 0; it must be within 0.01 to 100 N",
    ),
    (
        "mount = 0.0 ",
        "drive = { paly = 1 }\nmount = 0.0 ",
        r#"leg.drive.paly is not a known key; did you mean "play"?"#,
    ),
    (
        "mount = 0.0 ",
        "drive = { play = -1 }\nmount = 0.0 ",
        "leg.drive.play is -1; it must be within 0 to 20 deg",
    ),
    (
        "[body]",
        "[feet]\nstiffness = 0\n[body]",
        "feet.stiffness is 0; it must be within 0.01 to 1000 N/mm",
    ),
    (
        "[body]",
        "[feet]\ntwist = 30.0\n[body]",
        "feet.twist is 30; it must be within -20 to 20 mm",
    ),
    (
        "[body]",
        "[feet]\nlevels = 0.1\n[body]",
        r#"feet.levels is not a known key; did you mean "level"?"#,
    ),
    (
        "mass = 396.4 ",
        "weight = 395 ",
        "body.weight is not a known key; allowed are mass, centre",
    ),
    (
        "mass = 396.4 ",
        "mass = 0.395 ",
        "body.mass is 0.395; it must be within 10 to 10000 g",
    ),
    (
        "mass = 396.4 ",
        "centre = [56.0, 0.0] ",
        "body.centre is so far from the middle that foot RH is in the air at neutral; all four must carry",
    ),
    (
        "mass = 396.4 ",
        "centre = 5.0 ",
        "body.centre is 5.0; it must be an array of two numbers",
    ),
    (
        "friction_back_over_forward",
        "friction = 0\nfriction_back_over_forward",
        "ground.friction is 0; it must be within 0.05 to 5 (a coefficient)",
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
        "servo: the neutral pose is not safe: margin leg_lf 0.174 is below 0.300",
    ),
    (
        "neutral = 138.590378",
        "neutral = 60.0",
        "servo: the neutral pose is not safe: margin type1_a1 -0.018 is below 0.300",
    ),
    // Beyond its change point a parallelogram may have come out crossed.
    (
        "neutral = 138.590378",
        "neutral = 209.0",
        "servo: the neutral pose is not safe: margin leg_lf -0.485 is below 0.300",
    ),
    (
        "us_per_degree = 10.0",
        "us_per_degree = 1e300",
        "servo.A1.us_per_degree is 1e300; it must be within 1 to 22 us, or -22 to -1 where a longer pulse turns the horn clockwise",
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
        "stroke_min = -15.0",
        "stroke_min = -90.5",
        "limits.stroke_min is -90.5; it must be within -90 to 1000 mm, so that the slider keeps a length",
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
];
