//! Tests that sweep the chip's supply down and up, and check the measured voltage and the robot's reactions.

use lizard_host_tests::{FirmwareBench, robot};
use lizard_robot::Rail;
use simulated_uno::{Fidelity, Pin};

use crate::kept::{count_flashes, measure_widths, run_for_pulses};
use crate::{Status, boot_and_command, boot_standing, first_moving_gait};

/// The largest error of a printed board supply, V: one converter step at 5.5 V and the rounding to two decimals.
const BOARD_ERROR_V: f64 = 0.04;

/// The first pin that can measure a rail, by its Arduino number.
const FIRST_ANALOG_PIN: u8 = 14;

/// Returns the reaction and the voltage, V, in each note about the supply since line `from`.
fn notes(bench: &mut FirmwareBench, from: usize) -> Vec<(String, f64)> {
    let lines = &bench.lines()[from..];
    let printed = lines
        .iter()
        .filter_map(|line| line.text.strip_prefix("# supply: "));
    let printed = printed.map(|text| {
        let (volts, reaction) = text.split_once(" V, ").expect("volts and the reaction");
        (reaction.to_owned(), volts.parse().expect("a number"))
    });
    printed.collect()
}

#[test]
fn status_reports_the_supply_within_thirty_millivolts() {
    let mut bench = boot_standing(Fidelity::DataSheet);
    let mut max_error = 0f64;
    for mv in (2_700..=5_500).step_by(35) {
        bench.uno.set_supply_mv(f64::from(mv));
        bench.run_ms(120);
        let printed = Status::of(&mut bench).number("vcc");
        max_error = max_error.max((printed - f64::from(mv) / 1000.0).abs());
    }
    assert!(max_error <= 0.030, "{max_error} V");
}

/// Lowers a supply through its three thresholds, V, and asserts that the robot reports its reaction at
/// each threshold, and the voltage to within `tolerance`.
fn assert_reacts_at(
    bench: &mut FirmwareBench,
    thresholds: [f64; 3],
    tolerance: f64,
    set: impl Fn(&mut FirmwareBench, f64),
) {
    let from = bench.lines().len();
    let [slow, _, rest] = thresholds.map(|volts| (100.0 * volts) as i32);
    let mut true_at = Vec::new();
    for hundredths in (rest - 30..slow + 80).rev() {
        let volts = f64::from(hundredths) / 100.0;
        set(bench, volts);
        bench.run_ms(160);
        while true_at.len() < notes(bench, from).len() {
            true_at.push(volts);
        }
    }
    let printed = notes(bench, from);
    let words: Vec<&str> = printed
        .iter()
        .map(|(reaction, _)| reaction.as_str())
        .collect();
    let pace = robot().supplies().slow_pace;
    let low = format!("low: no saving, speed up to {pace}");
    assert_eq!(
        words,
        [
            low.as_str(),
            "too low to move: stopped",
            "too low to hold: pulses ended"
        ]
    );
    for ((truth, (_, printed)), threshold) in true_at.iter().zip(&printed).zip(thresholds) {
        assert!(
            (truth - threshold).abs() <= tolerance,
            "{truth}, {threshold}"
        );
        assert!((printed - truth).abs() <= tolerance, "{printed}, {truth}");
    }
}

#[test]
fn a_sinking_supply_slows_the_gait_then_stops_it_then_ends_the_pulses() {
    let mut bench = boot_and_command(&first_moving_gait(), Fidelity::DataSheet);
    assert_reacts_at(
        &mut bench,
        robot().supplies().board,
        BOARD_ERROR_V,
        |bench, volts| {
            bench.uno.set_supply_mv(1000.0 * volts);
        },
    );
    let status = Status::of(&mut bench);
    assert_eq!(
        (status.text("gait"), status.text("fault")),
        ("rest", "supply")
    );
    assert!(run_for_pulses(&mut bench, 200).iter().all(Vec::is_empty));
    let flashes = count_flashes(&mut bench, 10);
    assert!(
        flashes.len() >= 3 && flashes.iter().all(|count| *count == 2),
        "{flashes:?}"
    );
}

#[test]
fn a_low_supply_limits_the_pace_and_refuses_to_write_the_memory() {
    let mut bench = boot_and_command(&first_moving_gait(), Fidelity::DataSheet);
    let pace = |bench: &mut FirmwareBench| {
        let before = Status::of(bench).number("phase");
        bench.run_ms(200);
        (Status::of(bench).number("phase") - before).rem_euclid(1.0)
    };
    let full = pace(&mut bench);
    let [slow, stop, _] = robot().supplies().board;
    bench.uno.set_supply_mv((slow + stop) * 500.0);
    bench.run_ms(500);
    let written = bench.uno.eeprom_operations().len();
    let refused = bench.say("save");
    assert!(
        refused.starts_with("err 8 the supply is too low"),
        "{refused}"
    );
    let slow = pace(&mut bench);
    let expected = f64::from(robot().supplies().slow_pace) / 100.0;
    assert!(full > 0.0, "it walks");
    assert!(
        (slow / full - expected).abs() < 0.1,
        "{slow} of {full}, not {expected}"
    );
    bench.say("rest");
    bench.run_ms(400);
    assert_eq!(
        bench.uno.eeprom_operations().len(),
        written,
        "not even the pose"
    );
}

#[test]
fn a_supply_that_has_recovered_allows_everything_and_begins_nothing() {
    let mut bench = boot_and_command(&first_moving_gait(), Fidelity::DataSheet);
    let [slow, stop, _] = robot().supplies().board;
    bench.uno.set_supply_mv(stop * 1000.0 - 60.0);
    bench.run_ms(500);
    assert_eq!(Status::of(&mut bench).text("gait"), "stop");
    let refused = bench.say(&first_moving_gait());
    assert!(refused.starts_with("err 8 "), "{refused}");
    let held = measure_widths(&mut bench);
    let from = bench.lines().len();
    let mut good_at = None;
    for mv in ((stop * 1000.0) as i32..=5_000).step_by(10) {
        bench.uno.set_supply_mv(f64::from(mv));
        bench.run_ms(1_150);
        if good_at.is_none()
            && notes(&mut bench, from)
                .iter()
                .any(|(reaction, _)| reaction == "good")
        {
            good_at = Some(f64::from(mv) / 1000.0);
        }
    }
    let good_at = good_at.expect("it is good at last");
    assert!(
        (good_at - slow - 0.150).abs() <= BOARD_ERROR_V,
        "{good_at}: 150 mV above"
    );
    assert_eq!(measure_widths(&mut bench), held, "nothing has moved");
    assert_eq!(
        Status::of(&mut bench).text("fault"),
        "supply",
        "until it moves"
    );
    assert_eq!(
        bench.say(&first_moving_gait()),
        format!("ok {}", first_moving_gait())
    );
    bench.run_ms(500);
    assert_eq!(Status::of(&mut bench).text("fault"), "none");
    assert_eq!(bench.say("save"), "ok save");
}

#[test]
fn a_short_dip_and_a_supply_that_wavers_change_little() {
    let mut bench = boot_and_command(&first_moving_gait(), Fidelity::DataSheet);
    let from = bench.lines().len();
    // A starting servo pulls the supply down for some milliseconds.
    for n in 0..200u64 {
        bench.uno.set_supply_mv(3_300.0);
        bench.uno.run_cycles(15 * 16_000 + n * 997);
        bench.uno.set_supply_mv(5_000.0);
        bench.run_ms(100);
    }
    assert!(notes(&mut bench, from).is_empty());
    // The supply alternates around the threshold for half a minute.
    let slow = robot().supplies().board[0] * 1000.0;
    for n in 0..100 {
        bench
            .uno
            .set_supply_mv(slow + if n % 2 == 0 { -40.0 } else { 90.0 });
        bench.run_ms(300);
    }
    let printed = notes(&mut bench, from);
    assert_eq!(printed.len(), 1, "{printed:?}");
}

/// Sets the rail's pin to the voltage that the divider gives if the servos' rail has `volts`.
fn set_rail(bench: &mut FirmwareBench, rail: &Rail, volts: f64) {
    let mv = (1000.0 * volts / rail.ratio).round() as u16;
    bench.uno.set_analog_mv(Pin::arduino(rail.pin), mv);
}

/// Checks that a robot without a rail pin in robot.toml reports no rail, and that the voltage of a
/// free pin has no effect.
fn assert_no_rail() {
    let mut bench = boot_and_command(&first_moving_gait(), Fidelity::DataSheet);
    let servos = robot().servos().each_ref().map(|servo| servo.pin);
    let free: Vec<u8> = (FIRST_ANALOG_PIN..FIRST_ANALOG_PIN + 6)
        .filter(|pin| !servos.contains(pin))
        .collect();
    assert!(free.len() >= 2, "six pins and four servos");
    for mv in [0, 2_500, 5_000] {
        for pin in &free {
            bench.uno.set_analog_mv(Pin::arduino(*pin), mv);
        }
        bench.run_ms(1_000);
        let answer = bench.say("status");
        assert!(!answer.contains("rail="), "{answer}");
        assert!(answer.contains(" fault=none "), "{answer}");
        assert!(notes(&mut bench, 0).is_empty());
    }
    let gait = first_moving_gait().replace(' ', "-");
    assert_eq!(Status::of(&mut bench).text("gait"), gait);
}

#[test]
fn status_reports_the_servos_rail_if_robot_toml_names_its_pin() {
    let Some(rail) = robot().supplies().rail else {
        return assert_no_rail();
    };
    let mut bench = boot_and_command(&first_moving_gait(), Fidelity::DataSheet);
    let highest = 5.0 * rail.ratio;
    for step in 1..=40 {
        let volts = highest * f64::from(step) / 41.0;
        set_rail(&mut bench, &rail, volts);
        bench.run_ms(120);
        let printed = Status::of(&mut bench).number("rail");
        let tolerance = rail_tolerance(&rail, volts);
        assert!((printed - volts).abs() <= tolerance, "{printed}, {volts}");
    }
}

/// Returns the largest error of a printed rail voltage, V: one converter step each for the
/// rail and for the reference, and the rounding to two decimals.
fn rail_tolerance(rail: &Rail, volts: f64) -> f64 {
    0.01 + rail.ratio * 5.0 / 1024.0 + volts / 225.0
}

#[test]
fn a_sinking_rail_slows_stops_and_rests_the_robot_with_a_good_board_supply() {
    let Some(rail) = robot().supplies().rail else {
        return assert_no_rail();
    };
    let mut bench = boot_and_command(&first_moving_gait(), Fidelity::DataSheet);
    let tolerance = rail_tolerance(&rail, rail.thresholds[0]);
    assert_reacts_at(&mut bench, rail.thresholds, tolerance, |bench, volts| {
        set_rail(bench, &rail, volts);
    });
    assert!(run_for_pulses(&mut bench, 200).iter().all(Vec::is_empty));
    assert!((Status::of(&mut bench).number("vcc") - 5.0).abs() <= BOARD_ERROR_V);
}
