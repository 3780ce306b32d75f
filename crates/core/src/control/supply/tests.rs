//! Tests of the supply level as a function of the readings in successive frames.

use std::vec::Vec;

use proptest::prelude::*;

use super::Level::{Good, Rest, Slow, Stop};
use super::*;
use crate::sample::thresholds;

const SUPPLIES: Supplies = Supplies {
    reference_mv: 1100,
    board: thresholds([4500, 4300, 4100]),
    rail_reference_mv: 0,
    rail: thresholds([0; 3]),
};

const SUPPLIES_WITH_RAIL: Supplies = Supplies {
    rail_reference_mv: 2200,
    rail: thresholds([6400, 6200, 6000]),
    ..SUPPLIES
};

/// Computes the ADC's readings at these voltages of the board and of the servo rail, which is measured through a
/// divider by two.
fn compute_reading(board_volts: f64, rail_volts: f64) -> Reading {
    Reading {
        reference: (1.1 / board_volts * 1024.0) as u16,
        rail: (rail_volts / 2.0 / board_volts * 1024.0) as u16,
    }
}

/// Adds readings of a board without a measured rail until the level changes. Returns the number of frames and the new
/// level, or `None` if the level has not changed after 200 frames.
fn add_board_readings_until_change(supply: &mut Supply, volts: f64) -> Option<(usize, Level)> {
    add_readings_until_change(supply, compute_reading(volts, 0.0), &SUPPLIES)
}

/// Adds the same reading until the level changes. Returns the number of frames and the new level, or `None` if the
/// level has not changed after 200 frames.
fn add_readings_until_change(
    supply: &mut Supply,
    reading: Reading,
    supplies: &Supplies,
) -> Option<(usize, Level)> {
    let frame_count = (1..=200).find(|_| supply.add_reading(reading, supplies))?;
    Some((frame_count, supply.level()))
}

#[test]
fn every_voltage_is_rounded_down_to_hundredths_of_a_volt() {
    for reference in 1..=1023u16 {
        for reference_mv in [1000, 1080, 1100, 1200] {
            let supplies = Supplies {
                reference_mv,
                ..SUPPLIES
            };
            let rail = 700;
            let reading = Reading { reference, rail };
            let exact_centivolts = 1024.0 * f64::from(reference_mv) / f64::from(reference) / 10.0;
            let centivolts = Voltage::for_board(reading, &supplies).centivolts();
            // Higher voltages are limited to 81.91 V.
            let expected_centivolts = exact_centivolts.floor().min(8191.0);
            let case = (reference, reference_mv);
            assert_eq!(f64::from(centivolts), expected_centivolts, "{case:?}");
            let rail_centivolts = Voltage::for_rail(reading, &SUPPLIES_WITH_RAIL).centivolts();
            let exact_rail_centivolts = 700.0 * 2200.0 / f64::from(reference) / 10.0;
            let expected_centivolts = exact_rail_centivolts.floor().min(8191.0);
            assert_eq!(f64::from(rail_centivolts), expected_centivolts);
        }
    }
    let unknown_voltage = Voltage::for_board(Reading::default(), &SUPPLIES);
    assert_eq!(unknown_voltage.centivolts(), 0);
}

proptest! {
    #[test]
    fn voltage_comparisons_agree_with_floating_point(reference in 100u16..1023, threshold_mv in 0u16..9000) {
        let voltage = Voltage::for_board(Reading { reference, rail: 0 }, &SUPPLIES);
        let exact_mv = 1024.0 * 1100.0 / f64::from(reference);
        prop_assert_eq!(voltage.is_below(threshold_mv), exact_mv < f64::from(threshold_mv));
    }
}

#[test]
fn a_falling_supply_reaches_each_level_after_six_frames() {
    let mut supply = Supply::default();
    assert_eq!(add_board_readings_until_change(&mut supply, 5.0), None);
    for (volts, level) in [(4.45, Slow), (4.25, Stop), (4.05, Rest)] {
        let change = add_board_readings_until_change(&mut supply, volts);
        assert_eq!(change, Some((6, level)));
    }
    // A fall through all levels also takes six frames.
    let mut supply = Supply::default();
    let change = add_board_readings_until_change(&mut supply, 3.9);
    assert_eq!(change, Some((6, Rest)));
}

#[test]
fn six_low_readings_worsen_the_level_only_as_far_as_the_highest_of_them() {
    for (usual_volts, outlier_volts, level) in
        [(4.45, 3.5, Slow), (4.25, 3.5, Stop), (3.5, 4.45, Slow)]
    {
        for outlier_frame in 0..6 {
            let mut supply = Supply::default();
            for frame in 0..6 {
                let volts = match frame == outlier_frame {
                    true => outlier_volts,
                    false => usual_volts,
                };
                supply.add_reading(compute_reading(volts, 0.0), &SUPPLIES);
            }
            let case = std::format!(
                "{outlier_volts} V in frame {outlier_frame}, otherwise {usual_volts} V"
            );
            assert_eq!(supply.level(), level, "{case}");
        }
    }
}

#[test]
fn fifty_high_readings_improve_the_level_only_as_far_as_the_lowest_of_them() {
    for outlier_frame in 0..50 {
        let mut supply = Supply::default();
        add_board_readings_until_change(&mut supply, 4.2);
        for frame in 0..50 {
            let volts = if frame == outlier_frame { 4.5 } else { 5.0 };
            supply.add_reading(compute_reading(volts, 0.0), &SUPPLIES);
        }
        assert_eq!(supply.level(), Slow, "4.5 V in frame {outlier_frame}");
    }
}

#[test]
fn dips_of_five_frames_do_not_change_the_level() {
    let mut supply = Supply::default();
    for _ in 0..100 {
        for volts in [4.0, 4.0, 4.0, 4.0, 4.0, 5.0] {
            assert!(!supply.add_reading(compute_reading(volts, 0.0), &SUPPLIES));
        }
    }
    assert_eq!(supply.level(), Good);
}

#[test]
fn the_level_improves_one_second_after_the_voltage_exceeds_the_threshold_plus_hysteresis() {
    let mut supply = Supply::default();
    add_board_readings_until_change(&mut supply, 4.2);
    assert_eq!(supply.level(), Stop);
    // Between the threshold and 0.15 V above the threshold, the level does not change.
    assert_eq!(add_board_readings_until_change(&mut supply, 4.40), None);
    let slow_change = add_board_readings_until_change(&mut supply, 4.5);
    assert_eq!(slow_change, Some((50, Slow)));
    assert_eq!(add_board_readings_until_change(&mut supply, 4.6), None);
    let good_change = add_board_readings_until_change(&mut supply, 4.7);
    assert_eq!(good_change, Some((50, Good)));
}

#[test]
fn a_supply_that_oscillates_around_a_threshold_changes_its_level_only_once() {
    let mut supply = Supply::default();
    let mut levels = Vec::new();
    for frame in 0..2000 {
        let volts = if frame % 20 < 10 { 4.47 } else { 4.60 };
        if supply.add_reading(compute_reading(volts, 0.0), &SUPPLIES) {
            levels.push(supply.level());
        }
    }
    assert_eq!(levels, [Slow]);
}

#[test]
fn the_supply_with_the_worse_level_determines_the_level_and_is_reported() {
    let supplies = SUPPLIES_WITH_RAIL;
    for (board_volts, rail_volts, level, limiting_volts) in [
        (5.0, 6.6, Good, 5.0),
        (5.0, 6.3, Slow, 6.3),
        (4.25, 6.3, Stop, 4.25),
        (4.45, 5.0, Rest, 5.0),
    ] {
        let mut supply = Supply::default();
        let reading = compute_reading(board_volts, rail_volts);
        add_readings_until_change(&mut supply, reading, &supplies);
        assert_eq!(supply.level(), level);
        let reported_volts = f64::from(supply.limiting_voltage(&supplies).centivolts()) / 100.0;
        let case = std::format!("reported {reported_volts} V for {limiting_volts} V");
        assert!((reported_volts - limiting_volts).abs() < 0.05, "{case}");
    }
}

#[test]
fn an_unmeasured_supply_is_not_low() {
    let mut supply = Supply::default();
    let change = add_readings_until_change(&mut supply, Reading::default(), &SUPPLIES_WITH_RAIL);
    assert_eq!(change, None);
}
