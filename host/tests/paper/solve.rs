//! `lizard solve`.

use lizard_kinematics::wrap;
use serde_json::Value;

use crate::program::lizard;

const HEADER: &str = "theta1,theta4,theta5,theta8\n";

fn lines(input: &str) -> Vec<Value> {
    let outcome = lizard("solve --json", input);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    outcome
        .out
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect()
}

#[test]
fn the_object_has_exactly_the_promised_keys() {
    let one = &lines(&format!("{HEADER}138,42,221,318\n"))[0];
    let keys = |value: &Value| {
        let mut keys: Vec<&str> = value
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        keys.sort_unstable();
        keys.join(" ")
    };
    assert_eq!(
        keys(one),
        "head left legs margins right safe tail theta2 theta3 theta6 theta7 why"
    );
    assert_eq!(keys(&one["left"]), "phi s");
    assert_eq!(keys(&one["right"]), "phi s");
    assert_eq!(keys(&one["legs"]), "lf lh rf rh");
    assert_eq!(keys(&one["legs"]["lf"]), "coupler follower");
    assert_eq!(
        keys(&one["margins"]),
        "leg_lf leg_lh leg_rf leg_rh type1_a1 type1_a2 type1_a3 type1_a4 type2_head type2_tail"
    );
    assert_eq!(one["safe"], true);
    assert_eq!(one["why"], Value::Array(vec![]));
}

#[test]
fn what_it_prints_closes_every_loop() {
    let mut input = HEADER.to_string();
    let mut poses = Vec::new();
    for i in 0..2000 {
        let at = |least: f64, k: usize| least + (i * k % 997) as f64 * 90.0 / 997.0;
        let pose = [at(85.0, 31), at(10.0, 57), at(190.0, 101), at(265.0, 211)];
        input += &format!("{},{},{},{}\n", pose[0], pose[1], pose[2], pose[3]);
        poses.push(pose);
    }
    let solved = lines(&input);
    assert_eq!(solved.len(), poses.len());
    let cis = |length: f64, degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        [length * cos, length * sin]
    };
    for ([t1, t4, t5, t8], one) in poses.into_iter().zip(&solved) {
        let angle = |key: &str| {
            let angle = one[key].as_f64().unwrap();
            assert!(angle > -180.0 && angle <= 180.0);
            angle
        };
        let close = |links: [[f64; 2]; 4], rest: [f64; 2]| {
            let [a, b, c, d] = links;
            let x = a[0] + b[0] - c[0] - d[0] - rest[0];
            let y = a[1] + b[1] - c[1] - d[1] - rest[1];
            assert!(x.hypot(y) < 1e-9, "{x} {y}");
        };
        close(
            [
                cis(30.0, t1),
                cis(50.0, angle("theta2")),
                cis(50.0, angle("theta3")),
                cis(30.0, t4),
            ],
            [20.0, 0.0],
        );
        close(
            [
                cis(30.0, t5),
                cis(50.0, angle("theta6")),
                cis(50.0, angle("theta7")),
                cis(30.0, t8),
            ],
            [20.0, 0.0],
        );
        for (side, rear, front) in [
            ("left", t5 - 90.0, t1 + 90.0),
            ("right", t8 + 90.0, t4 - 90.0),
        ] {
            let span = 90.0 + one[side]["s"].as_f64().unwrap();
            let slider = cis(span, one[side]["phi"].as_f64().unwrap());
            close(
                [cis(30.0, rear), slider, cis(30.0, front), [0.0, 0.0]],
                [0.0, 135.0],
            );
        }
        let head = cis(30.0, t1);
        let coupler = cis(50.0, angle("theta2"));
        let x = one["head"][0].as_f64().unwrap() - (-10.0 + head[0] + coupler[0]);
        let y = one["head"][1].as_f64().unwrap() - (67.5 + head[1] + coupler[1]);
        assert!(x.hypot(y) < 1e-9);
        for (leg, theta, sign) in [
            ("lf", t1, 1.0),
            ("rf", t4, 1.0),
            ("rh", t8, -1.0),
            ("lh", t5, -1.0),
        ] {
            let follower = one["legs"][leg]["follower"].as_f64().unwrap();
            assert!(wrap(follower - theta).abs() < 1e-9);
            let margin = one["margins"][format!("leg_{leg}")].as_f64().unwrap();
            assert!((margin - sign * theta.to_radians().sin()).abs() < 1e-12);
        }
        assert_eq!(
            one["safe"].as_bool().unwrap(),
            one["why"].as_array().unwrap().is_empty()
        );
    }
}

#[test]
fn a_singular_row_says_why_and_the_stream_goes_on() {
    let solved = lines(&format!(
        "{HEADER}70.528779365509308,109.47122063449069,221.41,318.59\n60,60,221,318\n138.59,41.41,221.41,318.59\n"
    ));
    assert_eq!(solved.len(), 3);
    assert_eq!(solved[0]["safe"], false);
    assert!(solved[0]["why"][0].as_str().unwrap().contains("singular"));
    assert!(solved[0]["theta2"].is_null());
    assert_eq!(solved[1]["why"][0], "margin type1_a1 -0.317 is below 0.300");
    assert_eq!(solved[2]["safe"], true);
}

#[test]
fn columns_come_in_any_order_and_line_ends_and_quotes_do_not_matter() {
    let plain = lines(&format!("{HEADER}138,42,221,318\n"));
    let other = lines("\u{feff}theta8, theta1,theta4,\"theta5\"\r\n\r\n318,138,42,\"221\"");
    assert_eq!(plain, other);
}

#[test]
fn flags_and_stream_agree() {
    let flags = lizard(
        "solve --json --theta1 138 --theta4 42 --theta5 -139 --theta8 -42",
        "",
    )
    .json();
    assert_eq!(flags, lines(&format!("{HEADER}138,42,-139,-42\n"))[0]);
}

#[test]
fn a_long_stream_keeps_its_order() {
    let mut input = HEADER.to_string();
    for i in 0..30_000 {
        input += &format!("{},42,221,318\n", 100.0 + f64::from(i) / 1000.0);
    }
    let solved = lines(&input);
    assert_eq!(solved.len(), 30_000);
    for (i, one) in solved.iter().enumerate() {
        let follower = one["legs"]["lf"]["follower"].as_f64().unwrap();
        assert!((follower - 100.0 - i as f64 / 1000.0).abs() < 1e-9);
    }
}

#[test]
fn what_a_reader_sees_is_aligned_and_says_safe() {
    let outcome = lizard("solve", format!("{HEADER}138,42,221,318\n60,60,221,318\n"));
    let lines: Vec<&str> = outcome.out.lines().collect();
    assert_eq!(lines.len(), 3);
    let bars = |line: &str| -> Vec<usize> { line.match_indices('|').map(|(i, _)| i).collect() };
    assert_eq!(bars(lines[0]), bars(lines[1]));
    assert_eq!(bars(lines[0]), bars(lines[2]));
    assert!(lines[1].ends_with("safe"));
}
