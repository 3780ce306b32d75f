//! Tests of edited gaits: conversion to bars, trial, refusal and tables.

use lizard_twin::ServoModel;

use super::*;
use crate::paper::{PAPER_TOML, load_paper_robot, load_paper_robot_and_twin};

fn read_bars(robot: &Robot, name: &str) -> Bars {
    let gait = robot.gait(name).expect("the robot has this gait");
    gait.bars().expect("the gait has bars")
}

fn try_bars(bars: &Bars, twin: &Twin) -> Result<Trial, RefusedTrial> {
    let gait = EditedGait::Bars(bars.clone());
    gait.try_on(twin).expect("bars always have a table")
}

/// Puts a gait into the text of a robot.toml.
fn put_into(bars: &Bars, text: &str) -> String {
    let gait = EditedGait::Bars(bars.clone());
    let text = gait.put_into(text, &load_paper_robot());
    text.expect("bars always have a table")
}

#[test]
fn a_gait_rebuilt_from_its_bars_has_the_same_prediction() {
    let (robot, twin) = load_paper_robot_and_twin();
    for name in ["walk", "trot", "crawl", "left", "arc-left", "arc-right"] {
        let gait = robot.gait(name).expect("the robot has this gait");
        let trial = try_bars(&read_bars(&robot, name), &twin).expect("the gait is valid");
        let prediction = GaitPrediction::predict(&twin, gait);
        assert_eq!(trial.prediction, prediction, "{name}");
        let peak_speed = gait.audit().peak_speed.speed;
        assert_eq!(trial.max_servo_speed, peak_speed, "{name}");
    }
    for name in ["stand", "look"] {
        let gait = robot.gait(name).expect("the robot has this gait");
        assert_eq!(gait.bars(), None, "{name}");
    }
}

/// The robot has a reversed gait, `back`; therefore its distance can be computed in two ways.
#[test]
fn a_reversed_gait_walks_the_same_distance_backward() {
    let (robot, twin) = load_paper_robot_and_twin();
    let back = robot.gait("back").expect("the robot has this gait");
    let forward_mm = |prediction: GaitPrediction| {
        let forward = prediction.displacement.forward;
        forward.expect("the distance is determined")
    };
    let predicted_mm = forward_mm(GaitPrediction::predict(&twin, back));
    let trial = try_bars(&read_bars(&robot, "back"), &twin).expect("the gait is valid");
    let trial_mm = forward_mm(trial.prediction);
    assert!(
        predicted_mm < -5.0 && (trial_mm - predicted_mm).abs() < 0.1,
        "trial {trial_mm} mm, predicted {predicted_mm} mm"
    );
    assert!((trial.max_servo_speed - back.audit().peak_speed.speed).abs() < 2.0);
    for name in ["walk", "crawl", "arc-left"] {
        let bars = read_bars(&robot, name);
        let [own_mm, reversed_mm] = [bars.clone(), bars.reversed()].map(|bars| {
            let trial = try_bars(&bars, &twin).expect("the gait is valid");
            forward_mm(trial.prediction)
        });
        assert!(
            (own_mm + reversed_mm).abs() < 0.2,
            "{name}: {own_mm} mm, reversed {reversed_mm} mm"
        );
        let twice_reversed = bars.reversed().reversed();
        assert_eq!(twice_reversed.gain, bars.gain, "{name}");
        for (twice_start, start) in twice_reversed.start.into_iter().zip(bars.start) {
            let error = (twice_start - start).rem_euclid(1.0);
            let is_equal = error.min(1.0 - error) < 1e-9;
            assert!(is_equal, "{name}: {twice_start} and {start}");
        }
    }
}

#[test]
fn a_refusal_offers_the_nearest_valid_values() {
    let (robot, twin) = load_paper_robot_and_twin();
    let too_large_gait = Bars {
        amplitude: 60.0,
        ..read_bars(&robot, "walk")
    };
    let refused_trial = try_bars(&too_large_gait, &twin).expect_err("the gait is too large");
    let refusal = refused_trial.refusal;
    assert!(refusal.key.starts_with("gait.walk"), "{refusal:?}");
    assert!(!refused_trial.alternatives.is_empty(), "{refusal:?}");
    for Alternative { parameter, value } in refused_trial.alternatives {
        let is_valid_with = |value: f64| {
            let mut bars = too_large_gait.clone();
            match parameter {
                "amplitude" => bars.amplitude = value,
                _ => bars.period = value,
            }
            try_bars(&bars, &twin).is_ok()
        };
        let step = if parameter == "amplitude" { 0.1 } else { -0.01 };
        assert!(is_valid_with(value), "{parameter} {value}");
        assert!(!is_valid_with(value + step), "{parameter} {value}");
    }
}

#[test]
fn slow_servos_are_offered_a_long_period() {
    let (stand, _) = PAPER_TOML
        .split_once("[gait.walk]")
        .expect("the robot walks");
    let slow_toml = stand.replace("gait_slew = 310.0", "gait_slew = 10.0");
    let slow_robot = Robot::parse(&slow_toml).expect("the standing robot is valid");
    let twin = Twin::new(&slow_robot, ServoModel::Ideal);
    let walk = read_bars(&load_paper_robot(), "walk");
    let refused_trial = try_bars(&walk, &twin).expect_err("the gait is too fast");
    let mut alternatives = refused_trial.alternatives.iter();
    let offer = alternatives.find(|alternative| alternative.parameter == "period");
    let period = offer.expect("a longer period is offered").value;
    assert!((20.0..30.0).contains(&period), "{period} s");
}

#[test]
fn a_gait_replaces_the_gait_of_the_same_name_or_else_is_added() {
    let robot = load_paper_robot();
    let walk = Bars {
        amplitude: 15.0,
        ..read_bars(&robot, "walk")
    };
    let text = put_into(&walk, PAPER_TOML);
    let changed_robot = Robot::parse(&text).expect("the changed robot is valid");
    assert_eq!(read_bars(&changed_robot, "walk"), walk);
    let gait_names = |robot: &Robot| -> Vec<_> {
        let names = robot.gaits().iter().map(|gait| gait.name().to_string());
        names.collect()
    };
    assert_eq!(gait_names(&changed_robot), gait_names(&robot));
    let mine = Bars {
        name: "mine".to_string(),
        amplitude: 18.5,
        ..read_bars(&robot, "arc-left")
    };
    let extended_robot = Robot::parse(&put_into(&mine, &text));
    let extended_robot = extended_robot.expect("the extended robot is valid");
    let gait_count = extended_robot.gaits().len();
    assert_eq!(gait_count, robot.gaits().len() + 1);
    assert_eq!(read_bars(&extended_robot, "mine"), mine);
}

#[test]
fn an_invalid_name_is_refused_with_its_rule_and_without_alternatives() {
    let (robot, twin) = load_paper_robot_and_twin();
    for name in ["Wa lk", "läuft", ""] {
        let misnamed_gait = Bars {
            name: name.to_string(),
            ..read_bars(&robot, "walk")
        };
        let refused_trial = try_bars(&misnamed_gait, &twin).expect_err("the name is invalid");
        let expected_start = format!("gait.{name}: is not a gait name: ");
        let reason = refused_trial.refusal.reason;
        assert!(reason.starts_with(&expected_start), "{reason}");
        assert_eq!(refused_trial.alternatives, []);
    }
}
