//! The Rust source for the firmware.

use crate::{robot, with};

#[test]
fn the_source_holds_the_robots_numbers_in_the_firmwares_units() {
    let source = robot().source();
    for line in [
        // 138.590378 deg of 65536 steps; 1500 us of 16 cycles; 10 us per degree.
        "Servo { pin: 9, neutral: 25230, neutral_cycles: 24000, gain: 14400, min_sweep: -16384, max_sweep: 16384 }",
        "pub const HEAD: FiveBar = FiveBar::new(5120, 7680, 7680, Slope::new(12800, HEAD_SLOPE));",
        "pub const TAIL: FiveBar = FiveBar::new(5120, 7680, 7680, Slope::new(12800, HEAD_SLOPE));",
        "Slider { offset: 0, base: 34560, front: 7680, rear: 7680, nominal: 23040, min: 19200, max: 34560 }",
        "pub const LIMITS: Limits = Limits { type2: 9831, type1: 9831, leg: 9831 };",
        "pub const SLEW: u16 = 1092;",
        "pub const GAIT_COUNT: usize = 10;",
        "pub const WAVE_COUNT: usize = 5;",
        "Gait { name: *b\"stand       \", increment: 335544,",
        "Gait { name: *b\"arc left    \", increment: 335544,",
        "Gait { name: *b\"back        \", increment: -335544,",
        "Gait { name: *b\"look        \", increment: 83886,",
    ] {
        assert!(source.contains(line), "no {line}");
    }
}

#[test]
fn sides_of_unlike_ends_carry_their_offset() {
    let source = with("l5 = 20.0", "l5 = 24.0")
        .expect("a wider tail")
        .source();
    assert!(
        source.contains("LEFT: Slider = Slider { offset: 512,"),
        "A1 is 2 mm right of A4"
    );
    assert!(
        source.contains("RIGHT: Slider = Slider { offset: -512,"),
        "A2 is 2 mm left of A3"
    );
}

#[test]
fn every_link_goes_where_it_belongs() {
    for (from, to, line) in [
        (
            "l1 = 30.0 ",
            "l1 = 31.0",
            "HEAD: FiveBar = FiveBar::new(5120, 7936, 7680, Slope::new(12800, HEAD_SLOPE))",
        ),
        (
            "l4 = 30.0 ",
            "l4 = 31.0",
            "HEAD: FiveBar = FiveBar::new(5120, 7680, 7936, Slope::new(12800, HEAD_SLOPE))",
        ),
        (
            "l6 = 30.0 ",
            "l6 = 31.0",
            "TAIL: FiveBar = FiveBar::new(5120, 7936, 7680, Slope::new(12800, HEAD_SLOPE))",
        ),
        (
            "l9 = 30.0 ",
            "l9 = 31.0",
            "TAIL: FiveBar = FiveBar::new(5120, 7680, 7936, Slope::new(12800, HEAD_SLOPE))",
        ),
        (
            "l11 = 30.0 ",
            "l11 = 31.0",
            "LEFT: Slider = Slider { offset: 0, base: 34560, front: 7680, rear: 7936,",
        ),
        (
            "l14 = 30.0 ",
            "l14 = 31.0",
            "LEFT: Slider = Slider { offset: 0, base: 34560, front: 7936, rear: 7680,",
        ),
        (
            "l16 = 30.0 ",
            "l16 = 31.0",
            "RIGHT: Slider = Slider { offset: 0, base: 34560, front: 7680, rear: 7936,",
        ),
        (
            "l19 = 30.0 ",
            "l19 = 31.0",
            "RIGHT: Slider = Slider { offset: 0, base: 34560, front: 7936, rear: 7680,",
        ),
        (
            "l13 = 45.0",
            "l13 = 46.0",
            "LEFT: Slider = Slider { offset: 0, base: 34560, front: 7680, rear: 7680, nominal: 23296, min: 19456, max: 34816 }",
        ),
        (
            "l18 = 45.0",
            "l18 = 46.0",
            "RIGHT: Slider = Slider { offset: 0, base: 34560, front: 7680, rear: 7680, nominal: 23296, min: 19456, max: 34816 }",
        ),
        (
            "us_per_degree = 10.0",
            "us_per_degree = -12.5",
            "Servo { pin: 9, neutral: 25230, neutral_cycles: 24000, gain: -18000, min_sweep: -13107, max_sweep: 13107 }",
        ),
    ] {
        let source = with(from, to).expect(to).source();
        assert!(source.contains(line), "{to}: no {line}");
    }
}

#[test]
fn the_hash_covers_all_that_the_firmware_gets() {
    let robot = robot();
    let hash = robot.tables_hash();
    assert!(
        robot
            .source()
            .contains(&format!("TABLES_HASH: u32 = {hash:#010x};"))
    );
    for (from, to) in [
        ("pin = \"D9\"", "pin = \"D6\""),
        ("slew = 300.0", "slew = 250.0"),
        ("amplitude = 15.0", "amplitude = 14.9"),
        ("period = 4.0", "period = 4.1"),
        ("stroke_max = 45.0", "stroke_max = 44.0"),
    ] {
        assert_ne!(with(from, to).expect(to).tables_hash(), hash, "{to}");
    }
    assert_eq!(
        with("_forward = 1.0", "_forward = 1.2")
            .expect("pads")
            .tables_hash(),
        hash,
        "the floor is no part of it"
    );
}
