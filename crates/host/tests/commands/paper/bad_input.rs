//! Tests of invalid input: messages, exit codes, and no incomplete output.

use serde_json::Value;

use super::HEADER;
use crate::harness::{
    assert_contains, expect_refusals, read_cases, repo_root, run_command, run_line, scratch_folder,
    with_paper,
};

#[test]
fn the_refusal_of_an_invalid_row_names_the_line_and_column() {
    let single_rows = r#"
        138,42,x,221 => line 2, column 3 (theta8): "x" is not a number
        138,42,221 => line 2, column 4 (theta5): no value
        138,,221,318 => line 2, column 2 (theta4): no value
        138,42,318,221,5 => line 2, column 5: unexpected value "5"
        nan,42,318,221 => line 2, column 1 (theta1): "nan" is not a finite number
        138,inf,318,221 => line 2, column 2 (theta4): "inf" is not a finite number
        138,42,318,1e999 => line 2, column 4 (theta5): "1e999" is not a finite number
        138,42,318,1e308 => line 2, column 4 (theta5): "1e308" is not between -1000000 and 1000000 degrees
    "#;
    let rows_after_a_blank_line = (
        "138,42,318,221\n\n138;42;318;221",
        "line 4, column 1 (theta1): \"138;42;318;221\" is not a number",
    );
    for (rows, message) in read_cases(single_rows).chain([rows_after_a_blank_line]) {
        for command in ["pose", "pose --json"] {
            let outcome = run_line(command, format!("{HEADER}{rows}\n"));
            assert_eq!(outcome.code, Some(2), "{rows}");
            assert_eq!(outcome.stderr.trim_end(), format!("lizard: {message}"));
            assert!(outcome.stdout.is_empty() || outcome.stdout.ends_with('\n'));
        }
    }
}

#[test]
fn rows_before_an_invalid_row_are_solved_completely() {
    let input = format!("{HEADER}138,42,318,221\n138,42,318,221\n?,42,318,221\n");
    let outcome = run_line("pose --json", input);
    assert_eq!((outcome.code, outcome.stdout.lines().count()), (Some(2), 2));
    let mut rows = outcome.stdout.lines().map(serde_json::from_str::<Value>);
    assert!(rows.all(|row| row.is_ok()), "{}", outcome.stdout);
}

#[test]
fn an_invalid_header_is_refused() {
    let solve = |input: &[u8]| run_line("pose --json", input);
    let headers = r#"
        A1,A2,A3,A4 => line 1, column 1: "A1" is not a column
        theta1,theta4,theta5,seconds => line 1, column 5: theta8 is missing
        theta1,theta4,theta5,theta5 => line 1, column 4: duplicate column "theta5"
    "#;
    for (header, problem) in read_cases(headers) {
        solve(format!("{header}\n").as_bytes()).expect_refusal_with(&format!(
            "lizard: {problem}; expected the header theta1,theta4,theta8,theta5 in any order, optionally with seconds"
        ));
    }
    solve(b"").expect_refusal_with(
        "lizard: line 1, column 1: the input is empty, expected the header theta1,theta4,theta8,theta5",
    );
    solve(b"theta1,theta4,\xff,theta8\n")
        .expect_refusal_with("lizard: line 1, column 3: not UTF-8 text");
    for (length, is_too_long) in [(1024, false), (1025, true), (100_000, true)] {
        let outcome = run_line("pose", vec![b'1'; length]);
        assert_eq!(outcome.code, Some(2));
        let message = "lizard: line 1, column 1: longer than 1024 bytes\n";
        assert_eq!(outcome.stderr == message, is_too_long, "{length}");
    }
}

#[test]
fn the_refusal_of_invalid_arguments_states_the_reason() {
    let cases = "
        pose --theta1 138 => --theta4
        pose --theta1 138 --theta4 42 --theta5 x --theta8 318 => it is not a number
        pose --theta1 138 --theta4 42 --theta5 inf --theta8 318 => it is not a finite number
        pose --head 5 120 --show rates => cannot be used with
        pose --head 5 => 2 values
        pose --head 5 nan => it is not a finite number
        pose --head 5 1e308 => it is not between -1000000 and 1000000 mm
        pose --theta1 1e308 --theta4 42 --theta8 318 --theta5 221 => it is not between -1000000 and 1000000 degrees
        pose --show rates --omega8 1e200 => it is not between -1000000 and 1000000 deg/s
        pose --show rates --alpha5 -1e200 => it is not between -1000000000 and 1000000000 deg/s^2
        design --l0 1e308 => it is not between -1000000 and 1000000 mm
        design --r1 0.4 --r3 1e-300 => r3 is 1.0e-300, but must be at least 0.001
        gaits --robot /dev/zero => /dev/zero: is longer than 1 MiB, so it is not a robot file
        gaits --robot / => cannot be read
        pose --show rates --omega1 fast => it is not a number
        pose --omega1 5 => the servos' rates and accelerations require --show rates
        pose --head 5 120 --alpha5 -5 => the servos' rates and accelerations require --show rates
        prove --one-in 4 --offset 4 => --offset is 4, but must be less than --one-in, which is 4
        design --r1 0.3 => give two or three of --r1, --r2, --r3, or none
        design --r1 0.3 --r2 0.3 --r3 0.1 => but must be 0.9; the same shape has r1 0.385714
        design --r1 0.1 --r2 0.2 --r3 0.6 => r3 is 0.6, but must be greater than 0 and less than 0.45
        design --l0 -5 => must be at least 0.001 mm
        design --l0 0 => must be at least 0.001 mm
        design --chart --step 0 => must be between 0.002 and 0.2
        design --step 0.1 => <--chart|--search>
        design --top 3 => --search
        design --chart --top 3 => cannot be used with
        design --chart --search => cannot be used with
        errata --samples 0 => must be a whole number from 1 to 10000000
        pose --robot no/such/robot.toml => no/such/robot.toml
        draw charts => <DIR>
        walk => walk
    ";
    expect_refusals(&repo_root(), cases);
}

#[test]
fn an_impossible_request_ends_with_code_1() {
    let cases = "
        pose --head 0 200 => head: the point is 132.877 mm from the left shaft
        pose --show rates --theta1 70.528779365509308 --theta4 109.47122063449069 --theta5 221 --theta8 318 => singular
        draw charts /proc/no/such/folder => cannot write /proc/no/such/folder
        parts README.md => cannot write README.md: a file exists where a folder is needed
        sim --svg README.md/a.svg => cannot write README.md: a file exists where a folder is needed
    ";
    for (args, message) in read_cases(cases) {
        let outcome = run_line(&with_paper(args), "");
        assert_eq!(outcome.code, Some(1), "{args}: {}", outcome.stderr);
        assert_contains(&outcome.stderr, message);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_an_error() {
    let script = format!(
        "'{}' draw charts '{}' > /dev/full",
        env!("CARGO_BIN_EXE_lizard"),
        scratch_folder().join("charts-on-a-full-device").display()
    );
    let mut bash = std::process::Command::new("bash");
    let outcome = run_command(bash.args(["-c", &script]), "");
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert_contains(&outcome.stderr, "No space left");
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_is_not_an_error() {
    let input = HEADER.to_owned() + &"138,42,318,221\n".repeat(50_000);
    let file = scratch_folder().join("poses.csv");
    std::fs::write(&file, input).unwrap();
    let script = format!(
        "'{}' pose --json < '{}' | head -n 1; exit ${{PIPESTATUS[0]}}",
        env!("CARGO_BIN_EXE_lizard"),
        file.display()
    );
    let mut bash = std::process::Command::new("bash");
    let outcome = run_command(bash.args(["-c", &script]), "");
    assert_eq!(outcome.stderr, "");
    outcome.expect_success();
}
