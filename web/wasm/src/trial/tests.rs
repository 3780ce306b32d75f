//! A gait of the page: taken apart, tried, refused and written.

use super::*;
use crate::paper::{TEXT, paper, with_twin};

fn bars(robot: &Robot, name: &str) -> Bars {
    let gait = robot.gaits().iter().find(|gait| gait.name() == name);
    Bars::of(gait.expect("there")).expect("bars")
}

#[test]
fn a_gait_taken_apart_and_put_together_is_the_same() {
    let (robot, twin) = with_twin();
    for name in ["walk", "trot", "crawl", "left", "arc-left", "arc-right"] {
        let gait = robot
            .gaits()
            .iter()
            .find(|gait| gait.name() == name)
            .expect("there");
        let known = trial(TEXT, &bars(&robot, name), &twin).expect("it walks");
        assert_eq!(known.outlook, Outlook::of(&twin, gait), "{name}");
        assert_eq!(known.speed, gait.audit().peak.speed, "{name}");
    }
    for name in ["stand", "look"] {
        let gait = robot
            .gaits()
            .iter()
            .find(|gait| gait.name() == name)
            .expect("there");
        assert_eq!(Bars::of(gait), None, "{name}");
    }
}

/// `back` is `walk` in reverse, so two programs know where it leads.
#[test]
fn a_gait_that_is_turned_round_walks_as_the_core_in_reverse() {
    let (robot, twin) = with_twin();
    let back = robot.gait("back").expect("there");
    let known = Outlook::of(&twin, back).way.forward().expect("decided");
    let tried = trial(TEXT, &bars(&robot, "back"), &twin).expect("it walks");
    let way = tried.outlook.way.forward().expect("decided");
    assert!(
        known < -5.0 && (way - known).abs() < 0.1,
        "{way} and {known} mm"
    );
    assert!((tried.speed - back.audit().peak.speed).abs() < 2.0);
    for name in ["walk", "crawl", "arc-left"] {
        let bars = bars(&robot, name);
        let ahead = trial(TEXT, &bars, &twin).expect("it walks");
        let turned = trial(TEXT, &bars.turned_round(), &twin).expect("it walks");
        let [ahead, turned] = [ahead, turned].map(|t| t.outlook.way.forward());
        let sum = ahead.expect("decided") + turned.expect("decided");
        assert!(sum.abs() < 0.2, "{name}: {ahead:?} and {turned:?} mm");
        let again = bars.turned_round().turned_round();
        assert_eq!(again.gain, bars.gain, "{name}");
        for (again, start) in again.start.into_iter().zip(bars.start) {
            let off = (again - start).rem_euclid(1.0);
            assert!(off.min(1.0 - off) < 1e-9, "{name}: {again} and {start}");
        }
    }
}

#[test]
fn what_is_refused_comes_with_values_that_do_and_are_the_nearest() {
    let (robot, twin) = with_twin();
    let wanted = Bars {
        amplitude: 60.0,
        ..bars(&robot, "walk")
    };
    {
        let no = trial(TEXT, &wanted, &twin).expect_err("refused");
        assert!(no.refused.key.starts_with("gait.walk"), "{:?}", no.refused);
        assert!(!no.instead.is_empty(), "{:?}", no.refused);
        for Instead { what, value } in no.instead {
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
            assert!(trial(TEXT, &with(value), &twin).is_ok(), "{what} {value}");
            assert!(
                trial(TEXT, &with(value + towards), &twin).is_err(),
                "{what} {value}"
            );
        }
    }
}

#[test]
fn the_table_stands_in_a_robot_toml() {
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
    let text = walk.put_into(TEXT);
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
    let more = Robot::parse(&mine.put_into(&text)).expect("right");
    assert_eq!(names(&more).len(), names(&robot).len() + 1);
    assert_eq!(bars(&more, "mine"), mine);
}

#[test]
fn a_name_that_cannot_be_is_refused_without_other_values() {
    let (robot, twin) = with_twin();
    let no = trial(
        TEXT,
        &Bars {
            name: "Wa lk".to_string(),
            ..bars(&robot, "walk")
        },
        &twin,
    );
    assert_eq!(no.expect_err("refused").instead, []);
}
