//! Tests of `lizard sim` and `lizard draw`: invalid input, the inputs of a routine, and the drawing in docs/.

use crate::program::{read_file, robot_path, run, scratch_folder};

#[test]
fn the_refusal_of_a_missing_elf_file_names_the_file() {
    assert_eq!(
        run(&["sim", "--elf", "no/such.elf"]).expect_refusal(),
        "lizard: no/such.elf does not exist; omit --elf to run the built-in firmware"
    );
}

#[test]
fn sim_refuses_an_elf_file_of_another_processor() {
    let program_path = env!("CARGO_BIN_EXE_lizard");
    let refusal = run(&["sim", "--elf", program_path]).expect_refusal();
    let expected = format!("lizard: {program_path}: not an AVR ELF file");
    assert!(refusal.starts_with(&expected), "{refusal}");
}

#[test]
fn the_refusal_of_an_invalid_script_names_the_file_and_line() {
    let path = scratch_folder().join("wrong-script.txt");
    std::fs::write(&path, "100 walk\nsoon stop\n").expect("the script is written");
    let path = path.display().to_string();
    let message = run(&["sim", "--script", &path]).expect_refusal();
    assert_eq!(
        message,
        format!("lizard: {path}: line 2: expected a time in whole milliseconds, got `soon`")
    );
}

#[test]
fn sim_refuses_an_endless_script() {
    assert_eq!(
        run(&["sim", "--script", "/dev/zero"]).expect_refusal(),
        "lizard: cannot read /dev/zero: the file is longer than 256 MiB"
    );
}

#[test]
fn the_refusal_of_an_unknown_gait_lists_the_gaits_of_the_robot() {
    run(&["sim", "--robot", &robot_path("paper"), "--gait", "gallop"])
        .expect_refusal_with("no gait `gallop`; allowed values: stand, walk, trot");
}

#[test]
fn a_routine_continues_when_its_inputs_are_pressed() {
    let [patrol_path, script, svg] = ["patrol.toml", "patrol.txt", "patrol.svg"]
        .map(|name| scratch_folder().join(name).display().to_string());
    let gaits = read_file("docs/gaits.md");
    let mut blocks = gaits.split("```toml\n");
    let patrol = blocks.find(|block| block.starts_with("[input.button]"));
    let patrol = patrol.and_then(|block| block.split("```").next());
    let patrol = patrol.expect("the page has a patrol");
    let text = format!("{}\n{patrol}", read_file("robots/paper.toml"));
    std::fs::write(&patrol_path, text).expect("the robot is written");
    std::fs::write(&script, "1000 patrol\n").expect("the script is written");
    let simulate = |presses: &[&str]| {
        let mut arguments = vec!["sim", "--json", "--duration=5", "--svg", &svg];
        arguments.extend(["--robot", &patrol_path, "--script", &script]);
        arguments.extend(presses.iter().flat_map(|press| ["--press", press]));
        run(&arguments).expect_json()
    };
    let find_wait_times_ms = |report: &serde_json::Value, input: &str| -> Vec<f64> {
        let lines = report["dialogue"].as_array().expect("there are lines");
        let text = format!("# waiting for {input}");
        let input_lines = lines.iter().filter(|line| line["text"] == text.as_str());
        input_lines
            .map(|line| line["ms"].as_f64().expect("the value is a number"))
            .collect()
    };
    let pressed_report = simulate(&["button@2", "nose@3-3.5"]);
    let wait_starts_ms = find_wait_times_ms(&pressed_report, "nose");
    assert!(
        matches!(wait_starts_ms[..], [start_ms] if (2_040.0..2_100.0).contains(&start_ms)),
        "waits start at {wait_starts_ms:?} ms"
    );
    let servos = &pressed_report["servos"];
    assert_eq!(servos[0]["width_error"], 0, "{servos}");
    let report_without_presses = simulate(&[]);
    let wait_counts =
        ["button", "nose"].map(|input| find_wait_times_ms(&report_without_presses, input).len());
    assert_eq!(wait_counts, [1, 0]);
    let arguments = ["sim", "--robot", &robot_path("paper"), "--press", "nose@1"];
    let message = run(&arguments).expect_refusal();
    let expected = "lizard: robot.toml has no [input.nose] for --press";
    assert_eq!(message, expected);
}

#[test]
fn sim_refuses_a_duration_out_of_range() {
    for duration in ["0", "-3", "nan", "1e9", "soon"] {
        run(&["sim", &format!("--duration={duration}")]).expect_refusal_with("--duration");
    }
    run(&["sim", "--duration=2"]).expect_refusal_with("at least 4 s");
}

#[test]
fn the_drawing_in_docs_is_up_to_date() {
    let drawing = run(&["draw", "--robot", &robot_path("paper")]).expect_success();
    assert!(read_file("docs/lizard.svg") == drawing, "run `make docs`");
}
