//! `lizard twin` on routines, and on wrong input.

use serde_json::Value;

use crate::program::{RobotFile, lizard, paper};

/// The object that a command prints for this name.
fn object(line: &str, key: &str, name: &str) -> Value {
    let printed = lizard(line, "").success();
    let mut objects = printed
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).expect("JSON"));
    objects.find(|object| object[key] == name).expect(line)
}

#[test]
fn a_round_of_a_routine_leads_as_far_as_lizard_gaits_says_of_the_same_servos() {
    const ROUTINES: &str = "[routine.tour]\nsteps = [\"walk 2\", \"rest 1 s\", \"left 2\", \"trot 1\", \"arc-left 2\"]\n\
         [routine.gaze]\nsteps = [\"look 1\"]\n[gait.stand]";
    let robot = RobotFile::with("routines", &[("[gait.stand]", ROUTINES)]);
    let twin = |routine: &str, servo: &str| {
        let line = format!("twin --json --gait {routine} --servo {servo}");
        object(&robot.of(&line), "command", &format!("{routine} 1"))
    };
    let tour = object(&robot.of("gaits --json"), "routine", "tour");
    let part = |path: &Value, name: &str| path[name].as_f64().expect(name);
    for (servo, key) in [("own", "by_servos"), ("ideal", "predicted")] {
        let walked = twin("tour", servo);
        assert_eq!(walked["round"], tour[key], "{servo}");
        for name in ["forward", "left", "turn"] {
            let error = part(&walked["way"], name) - part(&tour[key], name);
            assert!(error.abs() < 0.2, "{servo}, {name}: {error}");
        }
    }
    let lost = part(&tour["predicted"], "turn") - part(&tour["by_servos"], "turn");
    assert!(lost > 1.0, "servos with a mass to turn lose some: {lost}");
    // Two feet pull against two: neither may name a distance.
    let gaze = object(&robot.of("gaits --json"), "routine", "gaze");
    for path in [&twin("gaze", "own")["way"], &gaze["by_servos"]] {
        assert!(path["forward"].is_null() && path["turn"].is_f64(), "{path}");
    }
}

#[test]
fn an_unknown_gait_is_refused_with_a_list_of_the_gaits() {
    for (gait, words) in [
        (
            "jump",
            "lizard: robot.toml has no gait `jump`; those that move are walk, trot, crawl, back, \
             left, right, arc-left, arc-right, look",
        ),
        ("stand", "lizard: the gait `stand` moves no servo"),
    ] {
        let line = paper(&format!("twin --gait {gait}"));
        assert_eq!(lizard(&line, "").refusal(), words);
    }
}
