//! Tests that the commands print the paper's and this project's values for the paper's robot.

use lizard_robot::Robot;
use serde_json::Value;

use super::HEADER;
use crate::harness::{assert_contains, robot_path, run_line, with_paper};

/// Runs a command with the paper's robot, and parses its output as JSON.
fn run_paper_json(args: &str) -> Value {
    run_line(&with_paper(args), "").expect_json()
}

fn to_number(value: &Value) -> f64 {
    value.as_f64().expect("the value is a number")
}

/// Checks that `value` differs from `expected` by less than `tolerance`.
#[track_caller]
fn assert_near(value: &Value, expected: f64, tolerance: f64) {
    let error = to_number(value) - expected;
    assert!(error.abs() < tolerance, "expected {expected}, got {value}");
}

/// Returns the elements of a JSON array.
fn elements(value: &Value) -> &[Value] {
    value.as_array().expect("the value is an array")
}

#[test]
fn the_papers_design_has_the_printed_dimensions_and_the_printed_conditioning_as_a_mean() {
    let design = run_line("design --json", "").expect_json();
    let expected_values = [
        ("d", 100.0, 1e-9),
        ("l0", 20.0, 1e-9),
        ("l1", 30.0, 1e-9),
        ("l2", 50.0, 1e-9),
        ("area", 14_892.6, 0.05),
        ("r_mic", 30.0, 1e-9),
        ("y_mic", 48.990, 1e-3),
    ];
    for (key, value, tolerance) in expected_values {
        assert_near(&design[key], value, tolerance);
    }
    let lci = &design["lci"];
    assert_near(&lci["mean"], 0.736, 5e-4);
    assert_near(&lci["share_above"], 0.668, 1e-3);
    assert_near(&lci["radius_above"], 15.45, 0.01);
    assert!(to_number(&lci["least"]) < 1e-6);
    assert_near(&lci["most"], 1.0, 1e-6);
}

#[test]
fn a_design_of_another_size_has_the_same_shape() {
    let small = run_line("design --json --r1 0.35 --r2 0.45", "").expect_json();
    let large = run_line("design --json --r1 0.35 --r2 0.45 --l0 60", "").expect_json();
    assert!((to_number(&large["d"]) / to_number(&small["d"]) - 3.0).abs() < 1e-12);
    assert!((to_number(&large["area"]) / to_number(&small["area"]) - 9.0).abs() < 1e-9);
    for key in ["mean", "share_above"] {
        assert_near(&large["lci"][key], to_number(&small["lci"][key]), 1e-6);
    }
}

#[test]
fn the_chart_covers_the_whole_triangle_and_contains_the_papers_design() {
    let points = run_line("design --chart --json --step 0.05", "").expect_json();
    let points = elements(&points);
    // All (i, j) for which r3 = 0.9 - 0.05 (i + j) is between 0 and 0.45.
    let sums = (1..18).flat_map(|i| (1..18).map(move |j| i + j));
    let expected = sums.filter(|sum| (10..18).contains(sum)).count();
    assert_eq!(points.len(), expected);
    let is_near = |value: &Value, expected: f64| (to_number(value) - expected).abs() < 1e-9;
    let is_paper = |point: &&Value| is_near(&point["r1"], 0.3) && is_near(&point["r2"], 0.5);
    let paper = points.iter().find(is_paper).unwrap();
    assert_near(&paper["r_mic"], 0.3, 1e-9);
    assert_near(&paper["area"], 1.48926, 1e-5);
    assert_near(&paper["lci"]["mean"], 0.736, 5e-3);
}

#[test]
fn the_search_returns_designs_within_the_limits_sorted_by_score() {
    let designs = run_paper_json("design --search --json --step 0.05 --top 50");
    let designs = elements(&designs);
    assert!(!designs.is_empty());
    let mut previous_score = f64::INFINITY;
    for design in designs {
        let d = to_number(&design["d"]);
        for link in ["r1", "r2"] {
            assert!(to_number(&design[link]) * d >= 20.0 - 1e-9, "{design}");
        }
        assert!(to_number(&design["margin"]) >= 0.3 && to_number(&design["sweep"]) >= 20.0);
        assert!(to_number(&design["score"]) <= previous_score);
        previous_score = to_number(&design["score"]);
    }
}

#[test]
fn the_body_has_four_degrees_of_freedom_and_each_leg_has_one() {
    let mechanisms = run_paper_json("pose --show freedoms --json");
    let mechanisms = elements(&mechanisms);
    assert_eq!(mechanisms.len(), 5);
    for (mechanism, freedoms) in mechanisms.iter().zip([4, 1, 1, 1, 1]) {
        assert_eq!(mechanism["gruebler"], freedoms, "{mechanism}");
        assert_eq!(mechanism["freedoms"], freedoms, "{mechanism}");
    }
    assert_eq!(mechanisms[0]["rank"], 32);
    // A flat leg gains a degree of freedom that the Gruebler count does not show.
    let flat_leg = "--theta1 138 --theta4 0 --theta5 221 --theta8 318";
    let flat_leg_mechanisms = run_paper_json(&format!("pose --show freedoms --json {flat_leg}"));
    assert_eq!(flat_leg_mechanisms[2]["gruebler"], 1);
    assert_eq!(flat_leg_mechanisms[2]["freedoms"], 2);
}

#[test]
fn the_determinant_matches_its_factors_and_the_nearest_poses_are_singular() {
    let report = run_paper_json(
        "pose --show singularities --json --theta1 120 --theta4 70 --theta5 230 --theta8 310",
    );
    let [eliminated, factored] = ["determinant", "factored"].map(|key| to_number(&report[key]));
    assert!((eliminated / factored - 1.0).abs() < 1e-9);
    let start_angles = [120.0, 70.0, 310.0, 230.0];
    let mut previous_distance = 0.0;
    for singular_pose in elements(&report["nearest"]) {
        let distance = to_number(&singular_pose["distance"]);
        assert!(distance >= previous_distance);
        previous_distance = distance;
        let [a1, a2, a3, a4] =
            [0, 1, 2, 3].map(|i| start_angles[i] + to_number(&singular_pose["turn"][i]));
        let pose = format!("{HEADER}{a1},{a2},{a3},{a4}\n");
        let solution = run_line(&with_paper("pose --json"), pose).expect_json();
        let min_margin = solution["margins"].as_object().map_or(0.0, |margins| {
            let margins = margins.values().map(to_number);
            margins.map(f64::abs).fold(1.0, f64::min)
        });
        let name = &singular_pose["what"];
        assert!(min_margin < 1e-4, "{name}: margin {min_margin}");
    }
}

#[test]
fn rates_match_difference_quotients_of_positions() {
    let options = "--omega1 120 --omega4 -80 --omega5 60 --omega8 90 --alpha1 500 --alpha8 -700";
    let rows = run_paper_json(&format!("pose --show rates --json {options}"));
    for row in elements(&rows) {
        for (key, offset) in [("rate", 1.0), ("acceleration", 100.0)] {
            let tolerance = 1e-6 * (offset + to_number(&row[key]).abs());
            assert_near(&row[format!("{key}_deviation")], 0.0, tolerance);
        }
    }
}

#[test]
fn rates_of_any_size_match_difference_quotients() {
    for options in [
        "--omega1 1e6 --omega8 -3e5",
        "--alpha4 1e9",
        "--omega1 1e-3 --alpha5 1e-3",
    ] {
        let rows = run_line(&with_paper(&format!("pose --show rates {options}")), "").stdout;
        let agrees = |row: &&str| row.ends_with("agree to 1e-6");
        let verdict_count = rows.lines().skip(1).filter(agrees).count();
        assert_eq!(verdict_count, 12, "{options}\n{rows}");
    }
}

#[test]
fn the_solutions_for_a_point_reach_the_point() {
    // The last two points are reachable only through a leg's change point.
    for (point, is_safe) in [
        ("5 120", true),
        ("-6 118", true),
        ("0 139", true),
        ("-22 110", false),
        ("20 105.5", false),
    ] {
        let report = run_paper_json(&format!("pose --json --head {point}"));
        let modes = elements(&report["head"]["working_modes"]);
        assert_eq!(modes.len(), 4);
        for mode in modes {
            assert!(to_number(&mode["error_mm"]) < 1e-9, "{point}");
        }
        assert_eq!(modes[0]["reachable"], is_safe, "{point}");
        assert_eq!(report["safe"], is_safe, "{point}");
        assert_eq!(modes[3]["reachable"], false, "{point}");
    }
}

#[test]
fn the_conditioning_of_the_papers_gesture_look_is_at_least_0_7() {
    let robot = Robot::load(robot_path("paper")).expect("the robot file is valid");
    let look = robot.gait("look").expect("the robot has the gesture");
    for i in 0..1000 {
        let pose = look.pose(f64::from(i) / 1000.0);
        let head = robot.lizard().solve(&pose).unwrap().head;
        let lci = head.conditioning_index();
        assert!(lci >= 0.7, "conditioning {lci}");
    }
}

#[test]
fn the_end_point_is_loose_in_a_type_2_singularity() {
    let find_freedoms = |pose: &str| run_paper_json(&format!("pose --show freedoms --json {pose}"));
    let home_mechanisms = find_freedoms("");
    for mechanism in elements(&home_mechanisms) {
        assert_eq!(mechanism["locked_freedoms"], 0, "{mechanism}");
    }
    // At these angles, the crank tips coincide to about six digits.
    let head_pose = "--theta1 70.528779 --theta4 109.471221 --theta8 318.59 --theta5 221.41";
    let head_body = &find_freedoms(head_pose)[0];
    assert_eq!(head_body["freedoms"], 4);
    assert_eq!(head_body["locked_freedoms"], 1);
    let tail_pose = "--theta1 138.59 --theta4 41.41 --theta8 -109.471221 --theta5 -70.528779";
    for (end, body) in [("head", head_body), ("tail", &find_freedoms(tail_pose)[0])] {
        let expected = format!("the {end}'s end point is loose (type 2)");
        assert_eq!(body["loose"][0], expected);
    }
    let line = format!("pose --show freedoms {head_pose}");
    let text = run_line(&with_paper(&line), "").stdout;
    assert!(!text.contains("four servos hold the body"), "{text}");
    assert_contains(&text, "the head's end point is loose");
    // A flat leg is loose even if its crank is locked.
    let flat_leg_mechanisms = find_freedoms("--theta1 138 --theta4 0 --theta8 318 --theta5 221");
    assert_eq!(flat_leg_mechanisms[2]["locked_freedoms"], 1);
}

#[test]
fn a_design_with_a_wide_base_has_an_inscribed_circle() {
    let design = run_line("design --json --r1 0.2 --r2 0.3", "").expect_json();
    assert_near(&design["r_mic"], 2.5, 1e-9);
    assert_eq!(to_number(&design["y_mic"]), 0.0);
    let points = run_line("design --chart --json --step 0.05", "").expect_json();
    for point in elements(&points) {
        assert!(to_number(&point["r_mic"]) > 0.0, "{point}");
    }
}

#[test]
fn matrices_name_their_rows_and_columns_in_servo_order() {
    let report = run_line("pose --show singularities --json", "").expect_json();
    let servo_order = serde_json::json!(["theta1", "theta4", "theta8", "theta5"]);
    assert_eq!(report["k"]["columns"], servo_order);
    for (matrix, columns) in [("k", 4), ("k_star", 8)] {
        let matrix = &report[matrix];
        assert_eq!(elements(&matrix["rows"]).len(), 8);
        assert_eq!(elements(&matrix["columns"]).len(), columns);
        for row in elements(&matrix["values"]) {
            assert_eq!(elements(row).len(), columns);
        }
    }
    // The head's rows depend only on the front servos, the tail's rows only on the hind servos.
    for (row, is_front) in [(0, true), (1, true), (2, false), (3, false)] {
        for column in 0..4 {
            let entry = to_number(&report["k"]["values"][row][column]);
            let depends = entry != 0.0;
            let may_depend = (column < 2) == is_front;
            assert_eq!(depends, may_depend, "row {row}, column {column}: {entry}");
        }
    }
}
