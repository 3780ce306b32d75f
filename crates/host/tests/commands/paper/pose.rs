//! Tests of `lizard pose`, mostly with the paper's robot.

use lizard_kinematics::{Vector, wrap};
use serde_json::Value;

use super::HEADER;
use crate::harness::{TemporaryRobot, assert_contains, run_line, with_paper};

fn solve_rows(input: &str) -> Vec<Value> {
    run_line(&with_paper("pose --json"), input).expect_json_lines()
}

#[test]
fn a_solution_has_exactly_the_documented_json_keys() {
    let solution = &solve_rows(&format!("{HEADER}138,42,318,221\n"))[0];
    let sorted_keys = |value: &Value| {
        let keys = value.as_object().unwrap().keys().map(String::as_str);
        let keys: std::collections::BTreeSet<&str> = keys.collect();
        Vec::from_iter(keys).join(" ")
    };
    assert_eq!(
        sorted_keys(solution),
        "head left legs margins right safe tail theta2 theta3 theta6 theta7 why"
    );
    assert_eq!(sorted_keys(&solution["left"]), "phi s");
    assert_eq!(sorted_keys(&solution["right"]), "phi s");
    assert_eq!(sorted_keys(&solution["legs"]), "lf lh rf rh");
    assert_eq!(sorted_keys(&solution["legs"]["lf"]), "coupler follower");
    assert_eq!(
        sorted_keys(&solution["margins"]),
        "leg_lf leg_lh leg_rf leg_rh type1_a1 type1_a2 type1_a3 type1_a4 type2_head type2_tail"
    );
    assert_eq!(solution["safe"], true);
    assert_eq!(solution["why"], Value::Array(vec![]));
}

#[test]
fn every_printed_solution_closes_all_loops() {
    let mut input = HEADER.to_string();
    let mut poses = Vec::new();
    for i in 0..2000 {
        let starts_and_strides = [(85.0, 31), (10.0, 57), (265.0, 211), (190.0, 101)];
        let pose = starts_and_strides
            .map(|(start, stride)| start + (i * stride % 997) as f64 * 90.0 / 997.0);
        input += &(pose.map(|angle| angle.to_string()).join(",") + "\n");
        poses.push(pose);
    }
    let solutions = solve_rows(&input);
    assert_eq!(solutions.len(), poses.len());
    let vector = |length: f64, degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Vector::new(length * cos, length * sin)
    };
    let assert_closed = |gap: Vector| assert!(gap.length() < 1e-9, "gap {gap:?} mm");
    for ([t1, t4, t8, t5], solution) in poses.into_iter().zip(&solutions) {
        let find_angle = |key: &str| {
            let angle = solution[key].as_f64().unwrap();
            assert!(angle > -180.0 && angle <= 180.0);
            angle
        };
        for (left, left_coupler, right_coupler, right) in
            [(t1, "theta2", "theta3", t4), (t5, "theta6", "theta7", t8)]
        {
            let [left_coupler, right_coupler] =
                [left_coupler, right_coupler].map(|key| vector(50.0, find_angle(key)));
            let [left, right] = [left, right].map(|theta| vector(30.0, theta));
            assert_closed(left + left_coupler - right_coupler - right - Vector::new(20.0, 0.0));
        }
        for (side, hind, front) in [
            ("left", t5 - 90.0, t1 + 90.0),
            ("right", t8 + 90.0, t4 - 90.0),
        ] {
            let span = 90.0 + solution[side]["s"].as_f64().unwrap();
            let slider = vector(span, solution[side]["phi"].as_f64().unwrap());
            let [hind_arm, front_arm] = [hind, front].map(|angle| vector(30.0, angle));
            assert_closed(hind_arm + slider - front_arm - Vector::new(0.0, 135.0));
        }
        let [x, y] = [0, 1].map(|axis| solution["head"][axis].as_f64().unwrap());
        let left_arm = vector(30.0, t1) + vector(50.0, find_angle("theta2"));
        assert_closed(Vector::new(-10.0, 67.5) + left_arm - Vector::new(x, y));
        for (leg, theta, sign) in [
            ("lf", t1, 1.0),
            ("rf", t4, 1.0),
            ("rh", t8, -1.0),
            ("lh", t5, -1.0),
        ] {
            let follower = solution["legs"][leg]["follower"].as_f64().unwrap();
            assert!(wrap(follower - theta).abs() < 1e-9);
            let margin = solution["margins"][format!("leg_{leg}")].as_f64().unwrap();
            assert!((margin - sign * theta.to_radians().sin()).abs() < 1e-12);
        }
        let reasons = solution["why"].as_array().unwrap();
        assert_eq!(solution["safe"], reasons.is_empty());
    }
}

#[test]
fn the_rows_after_a_singular_row_are_solved() {
    let solutions = solve_rows(&format!(
        "{HEADER}70.528779365509308,109.47122063449069,318.59,221.41\n60,60,318,221\n138.59,41.41,318.59,221.41\n"
    ));
    assert_eq!(solutions.len(), 3);
    assert_eq!(solutions[0]["safe"], false);
    assert_contains(solutions[0]["why"][0].as_str().unwrap(), "singular");
    assert!(solutions[0]["theta2"].is_null());
    let reason = &solutions[1]["why"][0];
    assert_eq!(reason, "margin type1_a1 -0.317 is below 0.300");
    assert_eq!(solutions[2]["safe"], true);
}

#[test]
fn column_order_line_endings_and_quotes_do_not_matter() {
    let plain_solutions = solve_rows(&format!("{HEADER}138,42,318,221\n"));
    let reordered_input = "\u{feff}theta8, theta1,theta4,\"theta5\"\r\n\r\n318,138,42,\"221\"";
    assert_eq!(plain_solutions, solve_rows(reordered_input));
}

#[test]
fn angles_from_options_and_from_input_have_the_same_solution() {
    let command = with_paper("pose --json --theta1 138 --theta4 42 --theta8 -42 --theta5 -139");
    assert_eq!(
        run_line(&command, "").expect_json(),
        solve_rows(&format!("{HEADER}138,42,-42,-139\n"))[0]
    );
}

#[test]
fn solutions_of_a_long_stream_keep_their_order() {
    let mut input = HEADER.to_string();
    for i in 0..30_000 {
        input += &format!("{},42,318,221\n", 100.0 + f64::from(i) / 1000.0);
    }
    let solutions = solve_rows(&input);
    assert_eq!(solutions.len(), 30_000);
    for (i, solution) in solutions.iter().enumerate() {
        let follower = solution["legs"]["lf"]["follower"].as_f64().unwrap();
        assert!((follower - 100.0 - i as f64 / 1000.0).abs() < 1e-9);
    }
}

#[test]
fn the_table_is_aligned_and_marks_safe_poses() {
    let input = format!("{HEADER}138,42,318,221\n60,60,318,221\n");
    let table = run_line(&with_paper("pose"), input).stdout;
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 3);
    let bar_columns =
        |line: &str| -> Vec<usize> { line.match_indices('|').map(|(i, _)| i).collect() };
    assert_eq!(bar_columns(lines[0]), bar_columns(lines[1]));
    assert_eq!(bar_columns(lines[0]), bar_columns(lines[2]));
    assert!(lines[1].ends_with("safe"));
}

#[test]
fn without_a_header_the_columns_are_the_servos_in_order() {
    let named_solutions = solve_rows(&format!("{HEADER}138,42,318,221\n100,40,-50,220\n"));
    assert_eq!(
        solve_rows("138,42,318,221\n100,40,-50,220\n"),
        named_solutions
    );
    let quoted_input = "\u{feff}138,42,318,221\n\"100\",40,-50,220";
    assert_eq!(solve_rows(quoted_input), named_solutions);
}

#[test]
fn the_times_of_rows_are_copied_to_the_output() {
    let solutions = solve_rows("theta1,seconds,theta4,theta8,theta5\n138,0.02,42,318,221\n");
    assert_eq!(solutions[0]["seconds"], 0.02);
    let input = "seconds,theta1,theta4,theta8,theta5\n0.02,138,42,318,221\n";
    let table = run_line(&with_paper("pose"), input).stdout;
    let rows: Vec<&str> = table.lines().map(str::trim_start).collect();
    assert!(rows[0].starts_with("seconds |"), "{table}");
    assert!(rows[1].starts_with("0.02 |"), "{table}");
    let mut safe_columns = table.lines().map(|row| row.find("| safe"));
    assert_eq!(safe_columns.next(), safe_columns.next());
}

#[test]
fn every_pose_in_the_trace_of_every_gait_is_safe() {
    // This holds for any robot.toml, since every gait of a valid file respects the file's limits.
    for gait in run_line("gaits --json", "").expect_json_lines() {
        let name = gait["gait"].as_str().unwrap();
        let trace = run_line(&format!("gaits --trace {name}"), "").stdout;
        let solutions = run_line("pose --json", &trace).expect_json_lines();
        assert_eq!(solutions.len(), trace.lines().count() - 1);
        for (solution, row) in solutions.iter().zip(trace.lines().skip(1)) {
            let fields: Vec<f64> = row.split(',').map(|field| field.parse().unwrap()).collect();
            assert_eq!(solution["seconds"], fields[0], "{name}");
            assert_eq!(solution["safe"], true, "{name} {row}: {solution}");
            // The columns are in the order of the legs.
            for (leg, angle) in ["lf", "rf", "rh", "lh"].iter().zip(&fields[1..]) {
                let follower = solution["legs"][leg]["follower"].as_f64().unwrap();
                assert!(wrap(follower - angle).abs() < 1e-9, "{name} {row}: {leg}");
            }
        }
    }
}

#[test]
fn an_angle_beyond_a_servos_travel_is_not_safe() {
    // In one direction, A3 can turn only 20 degrees from neutral: 400 us at 20 us per degree.
    let robot = TemporaryRobot::from_paper(&[(
        "pin = \"D11\"\nneutral = 318.590378\nneutral_us = 1500.0\nus_per_degree = 10.0\nmin_us = 600.0\nmax_us = 2400.0",
        "pin = \"D11\"\nneutral = 318.590378\nneutral_us = 2050.0\nus_per_degree = 20.0\nmin_us = 1000.0\nmax_us = 2450.0",
    )]);
    let run = |line: &str, input: &str| run_line(&robot.add_option(line), input);
    let pose = "pose --theta1 138.59 --theta4 41.41 --theta5 221.41 --theta8";
    let [end_of_travel, beyond_travel] = [20.0, 20.1].map(|turn| {
        let line = format!("{pose} {} --json", 318.590378 + turn);
        run(&line, "").expect_json()
    });
    assert_eq!(end_of_travel["safe"], true);
    assert_eq!(beyond_travel["safe"], false);
    assert_eq!(
        beyond_travel["why"][0],
        "servo A3 would turn +20.1 deg from neutral to 338.7 deg; its travel is 266.1 to 338.6 deg"
    );
    let text = run(&format!("{pose} 338.8"), "").stdout;
    assert_contains(&text, "safe     no, servo A3 would turn +20.2");
    let table = run("pose", "138.59,41.41,338.8,221.41\n").stdout;
    assert_contains(&table, "| servo A3 would turn");
    // The inverse kinematics also reports the tail point of this pose as unreachable.
    let [x, y] = [0, 1].map(|axis| beyond_travel["tail"][axis].as_f64().unwrap());
    let inverse = run(&format!("pose --json --tail {x} {y}"), "").expect_json();
    assert_eq!(inverse["safe"], false);
    let mut reasons = inverse["why"].as_array().unwrap().iter();
    let is_about_servo = |reason: &Value| reason.as_str().unwrap().starts_with("servo A3");
    assert!(reasons.any(is_about_servo), "{inverse}");
    assert_eq!(inverse["tail"]["working_modes"][0]["reachable"], false);
}

#[test]
fn zero_is_printed_without_a_sign() {
    for args in [
        "pose --theta1 138.59038 --theta4 41.40962 --theta8 318.59038 --theta5 221.40962",
        "pose --theta1 180 --theta4 0 --theta8 -0 --theta5 -180",
        "pose --show rates --omega1 -0.00001 --alpha5 -0.00001",
        "pose --show singularities",
        "pose --head -0.0001 120 --tail -0.0001 -120",
    ] {
        let text = run_line(&with_paper(args), "").stdout;
        let mut words = text.split(|c: char| c.is_whitespace() || "(),|".contains(c));
        let is_zero = |digits: &str| digits.bytes().all(|digit| digit == b'0');
        let is_negative_zero = |word: &str| word.strip_prefix("-0.").is_some_and(is_zero);
        assert!(!words.any(is_negative_zero), "{args}\n{text}");
    }
}
