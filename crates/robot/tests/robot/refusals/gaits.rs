//! Mistakes in gaits, and text that is no TOML.

use super::Mistake;

pub const MISTAKES: &[Mistake] = &[
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
        "[gait.walk-very-very-very-slowly-through-the-wet-grasses]",
        "gait.walk-very-very-very-slowly-through-the-wet-grasses is no gait name: it has 50 characters, but `status` must fit into a line of the console with it, so it may have 48",
    ),
    (
        "[gait.walk]",
        "[gait.walk-]",
        "gait.walk- is no gait name: a dash stands for a blank between two words",
    ),
    (
        "[gait.crawl]",
        "[gait.go-an]\nreverse = \"walk\"\n\n[gait.go-c0]\nreverse = \"walk\"\n\n[gait.crawl]",
        "gait.go-c0 is no gait name: the memory would take it for go-an when `boot` begins it, so one of them needs another name",
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
        "gait.look: at phase 0.3438: margin leg_rf 0.262 is below 0.300",
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
        "gait.trot: at phase 0.0000: margin leg_lf 0.284 is below 0.300",
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
        "gait.walk: at phase 0.1650 servo A1 would be at 128.51 deg, outside its travel of 128.59 to 228.59 deg",
    ),
    (
        "stroke_min = -15.0",
        "stroke_min = -10.0",
        "gait.walk: at phase 0.0000: left slider travel -10.77 mm is below -10.00 mm",
    ),
    (
        "stroke_max = 45.0",
        "stroke_max = 15.0",
        "gait.left: at phase 0.4062: left slider travel +16.29 mm is above +15.00 mm",
    ),
    (
        "type2 = 0.3 ",
        "type2 = 0.9 ",
        "gait.crawl: at phase 0.0000: margin type2_head 0.851 is below 0.900",
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
        "gait.trot: its table of 64 samples is 1.340 deg off at phase 0.1182 (servo A1); at most 0.50 deg is allowed",
    ),
    (
        "amplitude = 15.0",
        "amplitude =",
        "`amplitude` has no value behind the =",
    ),
    (
        "amplitude = 15.0",
        r#"amplitude = 15.0
amplitude = 15.0"#,
        "`amplitude` is there twice, first in line 162; keep one of them",
    ),
];
