//! Tests of the measured supply voltage, and of the robot's reactions while the supply falls and recovers.

use lizard_host_tests::{FirmwareBench, Line, robot};
use lizard_robot::Rail;
use simulated_uno::{CYCLES_PER_MS, FREQUENCY, Fidelity, Pin};

use crate::measurements::{assert_flashes, assert_no_pulse, measure_widths};
use crate::{Status, assert_near, boot_to_stand, boot_to_walk, expect_answer, first_moving_gait};

/// The tolerance of a board voltage, V: 0.03 V of the printed value, and the steps of 0.01 V in which these tests
/// change the supply.
const BOARD_TOLERANCE_V: f64 = 0.04;

/// The Arduino number of the first pin that can measure a rail.
const FIRST_ANALOGUE_PIN: u8 = 14;

/// Returns the reaction and the voltage (V) in each note about the supply, from line `first_line` on.
fn read_supply_notes(bench: &mut FirmwareBench, first_line: usize) -> Vec<(String, f64)> {
    let lines = &bench.lines()[first_line..];
    let parse_note = |line: &Line| {
        let pieces = line.text.strip_prefix("# supply: ")?.split_once(" V, ");
        let (volts, reaction) = pieces.expect("a note has a voltage and a reaction");
        let volts = volts.parse().expect("the voltage is a number");
        Some((reaction.to_owned(), volts))
    };
    lines.iter().filter_map(parse_note).collect()
}

#[test]
fn status_reports_the_supply_within_thirty_millivolts() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    for mv in (2_700..=5_500).step_by(35) {
        bench.uno.set_supply_mv(f64::from(mv));
        bench.run_ms(120);
        let printed_volts = Status::read(&mut bench).number("vcc");
        let volts = f64::from(mv) / 1000.0;
        assert_near(printed_volts, volts, 0.030, "printed voltage, V");
    }
}

#[test]
fn the_converter_runs_at_a_rate_that_gives_ten_bits() {
    /// The data address of ADCSRA, whose lowest three bits select the divider of the clock.
    const ADCSRA: u16 = 0x7a;
    let bench = boot_to_stand(Fidelity::DataSheet);
    let divider = 1 << (bench.uno.peek(ADCSRA) & 7);
    // Data sheet, section 24.4.
    assert!((50_000..=200_000).contains(&(FREQUENCY / divider)));
}

/// Lowers a supply through its three thresholds (V), and asserts that the robot reports its reaction at each threshold,
/// and the voltage with an error of at most `tolerance` (V).
fn lower_supply_and_check_reactions(
    bench: &mut FirmwareBench,
    thresholds: [f64; 3],
    tolerance: f64,
    set_volts: impl Fn(&mut FirmwareBench, f64),
) {
    let line_count = bench.lines().len();
    let [slow_hundredths, _, rest_hundredths] = thresholds.map(|volts| (100.0 * volts) as i32);
    let mut true_volts = Vec::new();
    for hundredths in (rest_hundredths - 30..slow_hundredths + 80).rev() {
        let volts = f64::from(hundredths) / 100.0;
        set_volts(bench, volts);
        bench.run_ms(160);
        while true_volts.len() < read_supply_notes(bench, line_count).len() {
            true_volts.push(volts);
        }
    }
    let printed_notes = read_supply_notes(bench, line_count);
    let reactions: Vec<&String> = printed_notes.iter().map(|(reaction, _)| reaction).collect();
    let pace = robot().supplies().slow_pace_percent;
    let expected_reactions: [&str; 3] = [
        &format!("low: no saving, speed at most {pace}"),
        "too low to move: stopped",
        "too low to hold: pulses off",
    ];
    assert_eq!(reactions, expected_reactions);
    let volts = true_volts.iter().zip(&printed_notes).zip(thresholds);
    for ((actual, (_, printed_volts)), threshold) in volts {
        assert_near(*actual, threshold, tolerance, "voltage of a reaction, V");
        assert_near(*printed_volts, *actual, tolerance, "printed voltage, V");
    }
}

#[test]
fn a_sinking_supply_slows_the_gait_then_stops_it_then_ends_the_pulses() {
    let mut bench = boot_to_walk(Fidelity::DataSheet);
    let thresholds = robot().supplies().board_thresholds;
    lower_supply_and_check_reactions(&mut bench, thresholds, BOARD_TOLERANCE_V, |bench, volts| {
        bench.uno.set_supply_mv(1000.0 * volts);
    });
    Status::read(&mut bench).assert_has("gait=rest fault=supply");
    assert_no_pulse(&mut bench, 200, "below the lowest threshold");
    assert_flashes(&mut bench, 10, 2);
}

#[test]
fn a_low_supply_limits_the_pace_and_prevents_saving() {
    let mut bench = boot_to_walk(Fidelity::DataSheet);
    let measure_pace = |bench: &mut FirmwareBench| {
        let phase_before = Status::read(bench).number("phase");
        bench.run_ms(200);
        (Status::read(bench).number("phase") - phase_before).rem_euclid(1.0)
    };
    let full_pace = measure_pace(&mut bench);
    let [slow_volts, stop_volts, _] = robot().supplies().board_thresholds;
    bench.uno.set_supply_mv((slow_volts + stop_volts) * 500.0);
    bench.run_ms(500);
    let operations_before = bench.uno.eeprom_operations().len();
    expect_answer(&mut bench, "save", "err 8 the supply is too low");
    let slow_pace = measure_pace(&mut bench);
    let expected_ratio = f64::from(robot().supplies().slow_pace_percent) / 100.0;
    assert!(full_pace > 0.0, "the robot does not walk");
    assert!(
        (slow_pace / full_pace - expected_ratio).abs() < 0.1,
        "slow pace {slow_pace} of {full_pace}, expected a ratio of {expected_ratio}"
    );
    bench.say("rest");
    bench.run_ms(400);
    let operations = bench.uno.eeprom_operations().len();
    assert_eq!(operations, operations_before, "`rest` saved the pose");
}

#[test]
fn a_recovered_supply_allows_commands_again_and_starts_nothing() {
    let mut bench = boot_to_walk(Fidelity::DataSheet);
    let [slow_volts, stop_volts, _] = robot().supplies().board_thresholds;
    bench.uno.set_supply_mv(stop_volts * 1000.0 - 60.0);
    bench.run_ms(500);
    Status::read(&mut bench).assert_has("gait=stop");
    expect_answer(&mut bench, &first_moving_gait(), "err 8 ");
    let held_widths = measure_widths(&mut bench);
    let line_count = bench.lines().len();
    let mut good_volts = None;
    for mv in ((stop_volts * 1000.0) as i32..=5_000).step_by(10) {
        bench.uno.set_supply_mv(f64::from(mv));
        bench.run_ms(1_150);
        let notes = read_supply_notes(&mut bench, line_count);
        if notes.iter().any(|(reaction, _)| reaction == "good") {
            good_volts.get_or_insert(f64::from(mv) / 1000.0);
        }
    }
    let good_volts = good_volts.expect("the supply is reported as good");
    let hysteresis_volts = good_volts - slow_volts;
    let case = "hysteresis of the recovery, V";
    assert_near(hysteresis_volts, 0.150, BOARD_TOLERANCE_V, case);
    assert_eq!(measure_widths(&mut bench), held_widths, "a servo moved");
    assert_eq!(
        Status::read(&mut bench).text("fault"),
        "supply",
        "the fault ended before the robot moved"
    );
    bench.expect_ok(&first_moving_gait());
    bench.run_ms(500);
    Status::read(&mut bench).assert_has("fault=none");
    assert_eq!(bench.say("save"), "ok save");
}

#[test]
fn short_dips_cause_no_note_and_a_wavering_supply_causes_one() {
    let mut bench = boot_to_walk(Fidelity::DataSheet);
    let line_count = bench.lines().len();
    // A servo that starts to move lowers the supply for some milliseconds.
    for n in 0..200u64 {
        bench.uno.set_supply_mv(3_300.0);
        bench.uno.run_cycles(15 * CYCLES_PER_MS + n * 997);
        bench.uno.set_supply_mv(5_000.0);
        bench.run_ms(100);
    }
    assert!(read_supply_notes(&mut bench, line_count).is_empty());
    // For half a minute the supply alternates between a voltage below the threshold and one above it.
    let slow_mv = robot().supplies().board_thresholds[0] * 1000.0;
    for n in 0..100 {
        let offset_mv = if n % 2 == 0 { -40.0 } else { 90.0 };
        bench.uno.set_supply_mv(slow_mv + offset_mv);
        bench.run_ms(300);
    }
    let printed_notes = read_supply_notes(&mut bench, line_count);
    assert_eq!(printed_notes.len(), 1, "{printed_notes:?}");
}

/// Sets the rail's pin to the voltage behind the divider for a rail of `volts`.
fn set_rail(bench: &mut FirmwareBench, rail: &Rail, volts: f64) {
    let mv = (1000.0 * volts / rail.divider_ratio).round() as u16;
    bench.uno.set_analog_mv(Pin::arduino(rail.pin), mv);
}

/// Checks that a robot without a rail pin in robot.toml reports no rail, and that the voltage at a free pin has no
/// effect.
fn assert_no_rail() {
    let mut bench = boot_to_walk(Fidelity::DataSheet);
    let servo_pins = robot().servos().each_ref().map(|servo| servo.pin);
    let analogue_pins = FIRST_ANALOGUE_PIN..FIRST_ANALOGUE_PIN + 6;
    let free_pins: Vec<u8> = analogue_pins
        .filter(|pin| !servo_pins.contains(pin))
        .collect();
    assert!(free_pins.len() >= 2, "{free_pins:?}");
    for mv in [0, 2_500, 5_000] {
        for pin in &free_pins {
            bench.uno.set_analog_mv(Pin::arduino(*pin), mv);
        }
        bench.run_ms(1_000);
        let status = Status::read(&mut bench);
        assert!(!status.0.contains("rail="), "{status:?}");
        status.assert_has("fault=none");
        assert!(read_supply_notes(&mut bench, 0).is_empty());
    }
    let gait = first_moving_gait().replace(' ', "-");
    Status::read(&mut bench).assert_has(&format!("gait={gait}"));
}

#[test]
fn status_reports_the_servos_rail_if_robot_toml_names_its_pin() {
    let Some(rail) = robot().supplies().rail else {
        return assert_no_rail();
    };
    let mut bench = boot_to_walk(Fidelity::DataSheet);
    let max_volts = 5.0 * rail.divider_ratio;
    for step in 1..=40 {
        let volts = max_volts * f64::from(step) / 41.0;
        set_rail(&mut bench, &rail, volts);
        bench.run_ms(120);
        let printed_volts = Status::read(&mut bench).number("rail");
        let tolerance = rail_tolerance(&rail, volts);
        assert_near(printed_volts, volts, tolerance, "printed voltage, V");
    }
}

/// Returns the largest error of a printed rail voltage, V: one converter step each for the rail and the reference, and
/// the rounding to two decimals.
fn rail_tolerance(rail: &Rail, volts: f64) -> f64 {
    0.01 + rail.divider_ratio * 5.0 / 1024.0 + volts / 225.0
}

#[test]
fn a_sinking_rail_slows_stops_and_rests_the_robot_with_a_good_board_supply() {
    let Some(rail) = robot().supplies().rail else {
        return assert_no_rail();
    };
    let mut bench = boot_to_walk(Fidelity::DataSheet);
    let tolerance = rail_tolerance(&rail, rail.thresholds[0]);
    lower_supply_and_check_reactions(&mut bench, rail.thresholds, tolerance, |bench, volts| {
        set_rail(bench, &rail, volts);
    });
    assert_no_pulse(&mut bench, 200, "below the lowest threshold");
    let board_volts = Status::read(&mut bench).number("vcc");
    assert_near(board_volts, 5.0, BOARD_TOLERANCE_V, "board supply, V");
}
