//! Tests of `lizard sim` and `lizard draw`: invalid input, inputs of a routine, and the picture in docs/.

use crate::program::{read_file, refusal_of, robot_path, run, scratch_folder};

#[test]
fn a_missing_firmware_is_named() {
    assert_eq!(
        refusal_of(&["sim", "--elf", "no/such.elf"]),
        "lizard: there is no firmware at no/such.elf; without --elf, the one inside this program \
         is used"
    );
}

#[test]
fn a_file_that_is_not_firmware_is_refused() {
    let program_path = env!("CARGO_BIN_EXE_lizard");
    let refusal = run(&["sim", "--elf", program_path]).expect_refusal();
    let expected = format!("lizard: {program_path}: not an ELF file of an AVR");
    assert!(refusal.starts_with(&expected), "{refusal}");
}

#[test]
fn the_refusal_of_an_invalid_script_names_file_and_line() {
    let path = scratch_folder().join("wrong-script.txt");
    std::fs::write(&path, "100 walk\nsoon stop\n").expect("the script is written");
    let path = path.display().to_string();
    let message = refusal_of(&["sim", "--script", &path]);
    assert_eq!(
        message,
        format!(
            "lizard: {path}: line 2: it begins with `soon`, not with a time in whole milliseconds"
        )
    );
}

#[test]
fn a_script_that_never_ends_is_refused() {
    assert_eq!(
        refusal_of(&["sim", "--script", "/dev/zero"]),
        "lizard: cannot read /dev/zero: it is longer than 256 MiB"
    );
}

#[test]
fn the_refusal_of_an_unknown_gait_lists_the_gaits_of_the_robot() {
    run(&["sim", "--robot", &robot_path("paper"), "--gait", "gallop"])
        .expect_refusal_with("no gait `gallop`; it has stand, walk, trot");
}

#[test]
fn a_routine_continues_when_its_inputs_are_pressed_and_the_core_agrees() {
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
    let wait_times_ms_of = |report: &serde_json::Value, input: &str| -> Vec<f64> {
        let lines = report["dialogue"].as_array().expect("there are lines");
        let text = format!("# waiting for {input}");
        let input_lines = lines.iter().filter(|line| line["text"] == text.as_str());
        input_lines
            .map(|line| line["ms"].as_f64().expect("the value is a number"))
            .collect()
    };
    let pressed_report = simulate(&["button@2", "nose@3-3.5"]);
    let wait_starts_ms = wait_times_ms_of(&pressed_report, "nose");
    assert!(
        matches!(wait_starts_ms[..], [start_ms] if (2_040.0..2_100.0).contains(&start_ms)),
        "{wait_starts_ms:?}"
    );
    assert_eq!(
        pressed_report["servos"][0]["width_error"], 0,
        "{}",
        pressed_report["servos"]
    );
    let report_without_presses = simulate(&[]);
    let wait_counts =
        ["button", "nose"].map(|input| wait_times_ms_of(&report_without_presses, input).len());
    assert_eq!(wait_counts, [1, 0]);
    let message = refusal_of(&["sim", "--robot", &robot_path("paper"), "--press", "nose@1"]);
    assert_eq!(
        message,
        "lizard: robot.toml has no [input.nose] for --press"
    );
}

#[test]
fn times_out_of_range_are_refused() {
    for duration in ["0", "-3", "nan", "1e9", "soon"] {
        run(&["sim", &format!("--duration={duration}")]).expect_refusal_with("--duration");
    }
    run(&["sim", "--duration=2"]).expect_refusal_with("at least 4 s");
}

#[test]
fn the_picture_in_docs_is_up_to_date() {
    let picture = run(&["draw", "--robot", &robot_path("paper")]).expect_success();
    assert!(read_file("docs/lizard.svg") == picture, "run `make docs`");
}
