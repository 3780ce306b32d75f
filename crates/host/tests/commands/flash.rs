//! Tests of `lizard flash` without a board.

use std::fs;
use std::time::{Duration, Instant};

use lizard_robot::Robot;

use crate::harness::{assert_contains, expect_refusals, robot_path, run_line_in};

/// An image of 20 bytes, as avr-objcopy writes it.
const HEX: &str = "\
:100000000C9434000C943E000C943E000C943E0082\n\
:0400100001020304E2\n\
:00000001FF\n";

/// Address of the robot's section in flash.
const ROBOT_START: usize = 0x6e00;
/// Address of the boot loader, where the space for the section ends.
const BOOT_LOADER_START: usize = 0x7e00;

#[test]
fn flash_without_built_firmware_fails_only_because_the_port_is_missing() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    fs::write(folder.path().join("a.hex"), HEX).expect("the file is written");
    let cases = "
        flash /dev/no-such-port => no-such-port
        flash /dev/no-such-port --only-robot => no-such-port
        flash /dev/no-such-port --robot large => no-such-port
        flash /dev/no-such-port --image a.hex => lizard: /dev/no-such-port does not exist; USB serial ports of this machine: ...
    ";
    expect_refusals(folder.path(), cases);
}

#[test]
fn flash_image_writes_the_image_of_any_robot_and_creates_missing_folders() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    for (name, options) in [("large", ""), ("unequal", "--only-robot")] {
        let command = format!("flash image --robot {name} {options}");
        let start = Instant::now();
        let line = format!("{command} --output new/{name}/x.hex");
        let outcome = run_line_in(folder.path(), &line);
        let duration = start.elapsed();
        assert!(duration < Duration::from_secs(20), "{duration:?}");
        assert_eq!(outcome.stderr, "");
        let output = outcome.expect_success();
        let file = format!("new/{name}/x.hex");
        assert!(output.starts_with(&format!("{file}: ")), "{output}");
        assert_contains(&output, &format!("robot {name} "));
        let text = fs::read_to_string(folder.path().join(file)).expect("the file is readable");
        let piped_text = run_line_in(folder.path(), &command).expect_success();
        assert!(piped_text == text, "the piped image equals the file");
        // The simulator's HEX reader shares no code with the writer.
        let image = simulated_uno::Image::parse_hex(&text).expect("the image is Intel HEX");
        let robot = Robot::load(robot_path(name)).expect("the robot file is valid");
        let flash = image.flash();
        assert!(flash[ROBOT_START..] == robot.section());
        let is_code = flash[..2] == [0x0c, 0x94];
        assert_eq!(is_code, options.is_empty(), "the code starts with a jump");
    }
}

#[test]
fn flash_image_prints_its_summary_as_json() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let line = "flash image --robot large --output x.hex --json";
    let summary = run_line_in(folder.path(), line).expect_json();
    let robot = Robot::load(robot_path("large")).expect("the robot file is valid");
    let hash = robot.firmware().hash();
    assert_eq!(
        summary,
        serde_json::json!({
            "file": "x.hex",
            "firmware": env!("CARGO_PKG_VERSION"),
            "robot": { "name": "large", "hash": format!("{hash:08x}") },
            "robot_bytes": robot.section().len(),
            "robot_space": BOOT_LOADER_START - ROBOT_START,
        })
    );
    run_line_in(folder.path(), "flash image --json").expect_refusal_with("--output");
}

#[test]
fn flash_image_refuses_an_invalid_robot_and_writes_no_file() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    fs::write(folder.path().join("x.toml"), "[servo]\n").expect("the file is written");
    run_line_in(folder.path(), "flash image --robot x.toml --output x.hex")
        .expect_refusal_with("x.toml");
    assert!(!folder.path().join("x.hex").exists());
}

#[test]
fn an_invalid_image_is_refused_before_a_port_is_opened() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    fs::write(folder.path().join("partial.hex"), &HEX[..60]).expect("the file is written");
    let cases = "
        flash /dev/no-such-port --image partial.hex => lizard: partial.hex: line 2 is not Intel HEX...
        flash /dev/no-such-port --image partial.hex --robot robot.toml => cannot be used with
        flash /dev/no-such-port --image partial.hex --only-robot => cannot be used with
    ";
    expect_refusals(folder.path(), cases);
}
