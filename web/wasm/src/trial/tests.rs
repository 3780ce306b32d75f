//! Tests of an edited gait: converted to bars, tried, refused and written.

use super::*;
use crate::paper::{TEXT, paper, with_twin};

fn bars(robot: &Robot, name: &str) -> Bars {
    robot.gait(name).expect(name).bars().expect("bars")
}

fn trial(bars: &Bars, twin: &Twin) -> Result<Trial, NoTrial> {
    let made = EditedGait::Bars(bars.clone());
    made.trial(twin).expect("bars always have a table")
}

/// Puts a gait into the text of a robot.toml.
fn put_into(bars: &Bars, text: &str) -> String {
    let made = EditedGait::Bars(bars.clone());
    made.put_into(text, &paper()).expect("a table")
}

#[test]
fn a_gait_taken_apart_and_put_together_is_the_same() {
    let (robot, twin) = with_twin();
    for name in ["walk", "trot", "crawl", "left", "arc-left", "arc-right"] {
        let gait = robot.gait(name).expect(name);
        let known = trial(&bars(&robot, name), &twin).expect("it walks");
        assert_eq!(known.outlook, GaitPrediction::of(&twin, gait), "{name}");
        assert_eq!(known.speed, gait.audit().peak.speed, "{name}");
    }
    for name in ["stand", "look"] {
        let gait = robot.gait(name).expect(name);
        assert_eq!(gait.bars(), None, "{name}");
    }
}

/// `back` is `walk` in reverse, so its distance can be computed in two ways.
#[test]
fn a_reversed_gait_walks_as_the_core_in_reverse() {
    let (robot, twin) = with_twin();
    let back = robot.gait("back").expect("there");
    let known = GaitPrediction::of(&twin, back)
        .movement
        .forward()
        .expect("decided");
    let tried = trial(&bars(&robot, "back"), &twin).expect("it walks");
    let movement = tried.outlook.movement.forward().expect("decided");
    assert!(
        known < -5.0 && (movement - known).abs() < 0.1,
        "{movement} and {known} mm"
    );
    assert!((tried.speed - back.audit().peak.speed).abs() < 2.0);
    for name in ["walk", "crawl", "arc-left"] {
        let bars = bars(&robot, name);
        let ahead = trial(&bars, &twin).expect("it walks");
        let turned = trial(&bars.reversed(), &twin).expect("it walks");
        let [ahead, turned] = [ahead, turned].map(|t| t.outlook.movement.forward());
        let sum = ahead.expect("decided") + turned.expect("decided");
        assert!(sum.abs() < 0.2, "{name}: {ahead:?} and {turned:?} mm");
        let again = bars.reversed().reversed();
        assert_eq!(again.gain, bars.gain, "{name}");
        for (again, start) in again.start.into_iter().zip(bars.start) {
            let error = (again - start).rem_euclid(1.0);
            assert!(error.min(1.0 - error) < 1e-9, "{name}: {again} and {start}");
        }
    }
}

#[test]
fn a_refusal_offers_the_nearest_values_that_are_possible() {
    let (robot, twin) = with_twin();
    let wanted = Bars {
        amplitude: 60.0,
        ..bars(&robot, "walk")
    };
    {
        let no = trial(&wanted, &twin).expect_err("refused");
        assert!(no.refused.key.starts_with("gait.walk"), "{:?}", no.refused);
        assert!(!no.instead.is_empty(), "{:?}", no.refused);
        for Alternative { what, value } in no.instead {
            let with = |value: f64| match what {
                "amplitude" => Bars {
                    amplitude: value,
                    ..wanted.clone()
                },
                _ => Bars {
                    period: value,
                    ..wanted.clone()
                },
            };
            let towards = if what == "amplitude" { 0.1 } else { -0.01 };
            assert!(trial(&with(value), &twin).is_ok(), "{what} {value}");
            assert!(
                trial(&with(value + towards), &twin).is_err(),
                "{what} {value}"
            );
        }
    }
}

#[test]
fn the_table_is_valid_in_a_robot_toml() {
    let robot = paper();
    let mine = Bars {
        name: "mine".to_string(),
        amplitude: 18.5,
        ..bars(&robot, "arc-left")
    };
    let robot = Robot::parse(&format!("{TEXT}\n{}", mine.table())).expect("right");
    assert_eq!(bars(&robot, "mine"), mine);
}

#[test]
fn a_gait_takes_the_place_of_the_one_of_its_name() {
    let robot = paper();
    let walk = Bars {
        amplitude: 15.0,
        ..bars(&robot, "walk")
    };
    let text = put_into(&walk, TEXT);
    let changed = Robot::parse(&text).expect("right");
    assert_eq!(bars(&changed, "walk"), walk);
    let names = |robot: &Robot| -> Vec<_> {
        let names = robot.gaits().iter().map(|gait| gait.name().to_string());
        names.collect()
    };
    assert_eq!(names(&changed), names(&robot));
    let mine = Bars {
        name: "mine".to_string(),
        ..walk
    };
    let more = Robot::parse(&put_into(&mine, &text)).expect("right");
    assert_eq!(names(&more).len(), names(&robot).len() + 1);
    assert_eq!(bars(&more, "mine"), mine);
}

#[test]
fn an_invalid_name_is_refused_without_other_values() {
    let (robot, twin) = with_twin();
    let no = trial(
        &Bars {
            name: "Wa lk".to_string(),
            ..bars(&robot, "walk")
        },
        &twin,
    );
    assert_eq!(no.expect_err("refused").instead, []);
}
