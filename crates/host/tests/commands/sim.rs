//! Tests of `lizard sim` and `lizard draw`: invalid input, the inputs of a routine, and the drawing in docs/.

use crate::harness::{expect_refusals, read_file, robot_path, run, run_line_in, scratch_folder};

#[test]
fn sim_refuses_invalid_input() {
    let script = scratch_folder().join("wrong.txt");
    std::fs::write(script, "100 walk\nsoon stop\n").expect("the script is written");
    let code = read_file("firmware/code.hex");
    std::fs::write(scratch_folder().join("code.hex"), code).expect("the image is written");
    let cases = "
        sim --elf no/such.elf => lizard: there is no file no/such.elf; omit --elf to run the built-in firmware
        sim --pty --boot-loader no/such.elf => lizard: cannot read no/such.elf: No such file or directory (os error 2)
        sim bench --elf no/such.elf => lizard: cannot read no/such.elf: ...; `make firmware` builds the firmware
        sim bench --robot paper --elf code.hex => lizard: code.hex has no function names; give the ELF file...
        sim --script wrong.txt => lizard: wrong.txt: line 2: expected a time in whole milliseconds, got `soon`
        sim --script /dev/zero => lizard: cannot read /dev/zero: the file is longer than 256 MiB
        sim --robot paper --gait gallop => no gait `gallop`; allowed values: stand, walk, trot
        sim --robot paper --press nose@1 => lizard: robot.toml has no [input.nose] for --press
        sim --duration=0 => --duration
        sim --duration=-3 => --duration
        sim --duration=nan => --duration
        sim --duration=1e9 => --duration
        sim --duration=soon => --duration
        sim --duration=2 => at least 4 s
    ";
    expect_refusals(scratch_folder(), cases);
    let program_path = env!("CARGO_BIN_EXE_lizard");
    let message = format!("lizard: {program_path}: not an AVR ELF file...");
    run(&["sim", "--elf", program_path]).expect_refusal_with(&message);
}

#[test]
fn a_routine_continues_when_its_inputs_are_pressed() {
    let folder = scratch_folder();
    let page = read_file("docs/gaits.md");
    let mut blocks = page.split("```toml\n");
    let patrol = blocks.find(|block| block.starts_with("[input.button]"));
    let patrol = patrol.and_then(|block| block.split("```").next());
    let patrol = patrol.expect("the page has a patrol");
    let text = format!("{}\n{patrol}", read_file("robots/paper.toml"));
    std::fs::write(folder.join("patrol.toml"), text).expect("the robot is written");
    std::fs::write(folder.join("patrol.txt"), "1000 patrol\n").expect("the script is written");
    let simulate = |presses: &str| {
        let files = "--svg patrol.svg --robot patrol.toml --script patrol.txt";
        let line = format!("sim --json --duration=5 {files} {presses}");
        run_line_in(folder, &line).expect_json()
    };
    let find_wait_times_ms = |report: &serde_json::Value, input: &str| -> Vec<f64> {
        let lines = report["dialogue"].as_array().expect("there are lines");
        let text = format!("# waiting for {input}");
        let input_lines = lines.iter().filter(|line| line["text"] == text);
        let times_ms = input_lines.map(|line| line["ms"].as_f64());
        let times_ms: Option<_> = times_ms.collect();
        times_ms.expect("the times are numbers")
    };
    let pressed_report = simulate("--press button@2 --press nose@3-3.5");
    let wait_starts_ms = find_wait_times_ms(&pressed_report, "nose");
    assert!(
        matches!(wait_starts_ms[..], [start_ms] if (2_040.0..2_100.0).contains(&start_ms)),
        "waits start at {wait_starts_ms:?} ms"
    );
    let servos = &pressed_report["servos"];
    assert_eq!(servos[0]["width_error"], 0, "{servos}");
    let report_without_presses = simulate("");
    let wait_counts =
        ["button", "nose"].map(|input| find_wait_times_ms(&report_without_presses, input).len());
    assert_eq!(wait_counts, [1, 0]);
}

#[test]
fn the_drawing_in_docs_is_up_to_date() {
    let drawing = run(&["draw", "--robot", &robot_path("paper")]).expect_success();
    assert!(read_file("docs/lizard.svg") == drawing, "run `make docs`");
}
