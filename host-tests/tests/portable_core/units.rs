//! Conversions between the core's integers and a person's numbers, each over
//! everything that it can be given.

use lizard::answer;
use lizard::pose::Pose;
use lizard::robot::SERVOS;
use lizard::units::{
    angle_from_centideg, centideg_from_angle, hundredths_from_length, thousandths_from_phase,
    thousandths_from_q15,
};
use lizard_host_tests::robot;
use proptest::prelude::*;

use crate::truth::{Spread, degrees};

/// The distance of two angles, deg, the short way round.
fn apart(a: f64, b: f64) -> f64 {
    let off = (a - b).rem_euclid(360.0);
    off.min(360.0 - off)
}

#[test]
fn an_angle_of_the_console_is_within_seven_tenths_of_a_step() {
    for centideg in -71_999..72_000 {
        let angle = angle_from_centideg(centideg);
        let off = apart(degrees(angle), f64::from(centideg) / 100.0);
        // Half a step is 0.0027 deg.
        assert!(off <= 0.004, "{centideg}: {off} deg");
    }
}

#[test]
fn every_hundredth_of_a_degree_comes_back_as_it_went() {
    for centideg in 0..36_000u16 {
        let angle = angle_from_centideg(centideg.into());
        assert_eq!(centideg_from_angle(angle), centideg);
    }
}

#[test]
fn every_angle_is_told_to_the_nearest_hundredth_of_a_degree() {
    for angle in 0..=u16::MAX {
        let centideg = centideg_from_angle(angle);
        assert!(centideg < 36_000);
        assert!(apart(f64::from(centideg) / 100.0, degrees(angle)) <= 0.005 + 1e-9);
    }
}

#[test]
fn lengths_margins_and_phases_are_told_to_the_nearest_digit() {
    for raw in i16::MIN..=i16::MAX {
        let value = f64::from(raw);
        let hundredths = f64::from(hundredths_from_length(raw));
        assert!((hundredths - value * 100.0 / 256.0).abs() <= 0.5, "{raw}");
        let thousandths = f64::from(thousandths_from_q15(raw));
        assert!(
            (thousandths - value * 1000.0 / 32768.0).abs() <= 0.5,
            "{raw}"
        );
    }
    for phase in (0..1 << 24).step_by(97) {
        let thousandths = thousandths_from_phase(phase);
        // Rounded down, so that no phase is told as a whole cycle.
        let below = f64::from(phase) * 1000.0 / f64::from(1 << 24) - f64::from(thousandths);
        assert!((0.0..1.02).contains(&below), "{phase}");
        assert!(thousandths < 1000);
    }
}

#[test]
fn a_pulse_is_within_a_cycle_of_what_the_file_asks_for_in_all_of_the_travel() {
    let mut spread = Spread::default();
    for (servo, float) in SERVOS.iter().zip(&robot().servos) {
        for sweep in servo.min_sweep..=servo.max_sweep {
            let width = f64::from(servo.width(sweep));
            let us = float.neutral_us + float.us_per_degree * f64::from(sweep) * 360.0 / 65536.0;
            spread.add(width - 16.0 * us);
            assert!((16.0 * float.min_us..=16.0 * float.max_us).contains(&width));
        }
        // The ends of the travel are the ends of the pulse, to a step.
        for (sweep, us) in [
            (servo.min_sweep, float.min_us),
            (servo.max_sweep, float.max_us),
        ] {
            assert!((f64::from(servo.width(sweep)) - 16.0 * us).abs() <= 1.0);
        }
    }
    println!("pulse widths: {spread} cycles");
    assert!(spread.max < 1.0);
}

#[test]
fn a_neutral_angle_is_the_files_to_the_nearest_step() {
    for (servo, float) in SERVOS.iter().zip(&robot().servos) {
        assert!(apart(degrees(servo.neutral), float.neutral) <= 0.002_75);
        assert_eq!(f64::from(servo.neutral_cycles), 16.0 * float.neutral_us);
    }
    for (n, servo) in SERVOS.iter().enumerate() {
        assert_eq!(Pose::NEUTRAL.angle(n), servo.neutral);
    }
}

#[test]
fn a_servo_reaches_its_travel_and_not_a_step_more() {
    for servo in &SERVOS {
        for sweep in i16::MIN..=i16::MAX {
            let within = (servo.min_sweep..=servo.max_sweep).contains(&sweep);
            assert_eq!(servo.reaches(sweep), within);
            assert_eq!(servo.sweep_to(servo.angle_at(sweep)), sweep);
        }
    }
}

/// A number as the console prints it.
fn printed(value: u32, decimals: usize) -> String {
    let mut text = String::new();
    let Ok(()) = answer::number(&mut text, value, decimals);
    text
}

/// The same with the standard library: digits, and a point before the last.
fn expected(value: u32, decimals: usize) -> String {
    let digits = format!("{value:0>width$}", width = decimals + 1);
    let (whole, rest) = digits.split_at(digits.len() - decimals);
    if decimals == 0 {
        whole.to_owned()
    } else {
        format!("{whole}.{rest}")
    }
}

#[test]
fn numbers_are_printed_as_the_standard_library_would() {
    let edges = (0..10).flat_map(|n| {
        let decade = 10u32.pow(n);
        [decade - 1, decade, decade + 1]
    });
    for value in edges.chain([u32::MAX - 1, u32::MAX]) {
        for decimals in 0..=3 {
            assert_eq!(printed(value, decimals), expected(value, decimals));
        }
    }
    for value in i16::MIN..=i16::MAX {
        let mut text = String::new();
        let Ok(()) = answer::signed(&mut text, value, 3);
        let sign = if value < 0 { "-" } else { "" };
        assert_eq!(
            text,
            format!("{sign}{}", expected(value.unsigned_abs().into(), 3))
        );
    }
}

proptest! {
    #[test]
    fn any_number_is_printed_as_the_standard_library_would(value: u32, decimals in 0usize..=3) {
        prop_assert_eq!(printed(value, decimals), expected(value, decimals));
    }
}
