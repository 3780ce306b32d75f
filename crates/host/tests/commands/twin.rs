//! Tests of `lizard twin`: routines, the speeds in docs/gaits.md, the spread, and invalid input.

use serde_json::Value;

use crate::harness::{TemporaryRobot, read_file, run_line, with_paper};

/// Runs a command; returns the printed JSON object whose `key` has this value.
fn find_object(line: &str, key: &str, value: &str) -> Value {
    let mut objects = run_line(line, "").expect_json_lines().into_iter();
    objects.find(|object| object[key] == value).expect(line)
}

#[test]
fn a_round_of_a_routine_matches_the_prediction_of_lizard_gaits() {
    const ROUTINES: &str = "[routine.tour]\nsteps = [\"walk 2\", \"rest 1 s\", \"left 2\", \"trot 1\", \"arc-left 2\"]\n\
         [routine.gaze]\nsteps = [\"look 1\"]\n[gait.stand]";
    let robot = TemporaryRobot::from_paper(&[("[gait.stand]", ROUTINES)]);
    let run_twin = |routine: &str, servo: &str| {
        let line = format!("twin --json --gait {routine} --servo {servo}");
        let command = format!("{routine} 1");
        find_object(&robot.add_option(&line), "command", &command)
    };
    let tour = find_object(&robot.add_option("gaits --json"), "routine", "tour");
    let component = |displacement: &Value, name: &str| displacement[name].as_f64().expect(name);
    for (servo, prediction) in [("own", "by_servos"), ("ideal", "predicted")] {
        let report = run_twin("tour", servo);
        assert_eq!(report["round"], tour[prediction], "{servo}");
        for name in ["forward", "left", "turn"] {
            let difference = component(&report["way"], name) - component(&tour[prediction], name);
            assert!(difference.abs() < 0.2, "{servo}, {name}: {difference}");
        }
    }
    let lost_turn_deg =
        component(&tour["predicted"], "turn") - component(&tour["by_servos"], "turn");
    assert!(
        lost_turn_deg > 1.0,
        "real servos turn the robot by only {lost_turn_deg} deg less than ideal servos"
    );
    // In `gaze` two feet pull against the other two. The distance is then undetermined, and neither command may print
    // one.
    let gaze = find_object(&robot.add_option("gaits --json"), "routine", "gaze");
    for displacement in [&run_twin("gaze", "own")["way"], &gaze["by_servos"]] {
        assert!(displacement["forward"].is_null(), "{displacement}");
        assert!(displacement["turn"].is_f64(), "{displacement}");
    }
}

#[test]
fn robots_with_grained_pads_walk_and_turn_as_fast_as_docs_state() {
    let page = read_file("docs/gaits.md");
    for (name, servo, friction, is_fast) in [
        ("SG-90", "\"SG-90\"", "0.7", true),
        ("copy on 4.2 V", "\"copy\"\nvolts = 4.2", "1.0", true),
        // With this servo, `run` stays below 90 mm/s.
        ("digital", "\"digital\"", "0.7", false),
    ] {
        let servo = format!("[servo]\nmodel = {servo}\n[servo.A1]");
        let friction_key = format!("friction = {friction}");
        let changes = [("[servo.A1]", &*servo), ("# friction = 0.7", &friction_key)];
        let robot = TemporaryRobot::from_file("robots/grain.toml", &changes);
        let rows = run_line(&robot.add_option("twin --json"), "").expect_json_lines();
        let find_value = |gait: &str, pointer: &str| {
            let row = rows.iter().find(|row| row["command"] == gait);
            let value = row.and_then(|row| row.pointer(pointer));
            value.and_then(Value::as_f64).expect(gait)
        };
        let run_speed = find_value("run", "/cycle/speed");
        let [run_mm, back_mm] = ["run", "back"].map(|gait| find_value(gait, "/cycle/way/forward"));
        let [left_deg, arc_deg] =
            ["left", "arc left"].map(|gait| find_value(gait, "/cycle/way/turn"));
        let row = format!(
            "| {name} | {friction} | {run_speed:.0} | {left_deg:.1} | {arc_deg:.1} | {back_mm:.1} |\n"
        );
        assert!(page.contains(&row), "docs/gaits.md has no {row}");
        assert_eq!(run_speed >= 90.0, is_fast, "{name}: {run_speed} mm/s");
        // A cycle of `run` takes 0.27 s, which is 13.5 frames.
        let difference_mm = run_mm - 0.27 * run_speed;
        assert!(difference_mm.abs() < 0.5, "{name}: {run_mm} mm");
        assert!(
            left_deg > 9.0 && arc_deg > 6.0,
            "{name}: `left` turns by {left_deg} deg, `arc left` by {arc_deg} deg"
        );
    }
}

#[test]
fn the_refusal_of_an_unknown_gait_lists_the_gaits() {
    run_line(&with_paper("twin --gait jump"), "").expect_refusal_with(
        "lizard: the robot has no gait `jump`; allowed values: walk, trot, crawl, back, \
         left, right, arc-left, arc-right, look",
    );
    run_line(&with_paper("twin --gait stand"), "")
        .expect_refusal_with("lizard: the gait `stand` moves no servo");
}

#[test]
fn the_spread_covers_a_gait_with_a_count_and_a_table_without_rows_is_not_printed() {
    for (command, expected) in [("walk 2", "\nwalk    "), ("rest", "\nno spread: ")] {
        let script = format!("100 {command}\n3000 stop");
        let stdout = run_line(&with_paper("twin /dev/stdin --robust 2"), script).expect_success();
        assert!(stdout.contains(expected), "{command}: {stdout}");
        assert!(!stdout.contains("by ideal servos"), "{command}: {stdout}");
    }
}
