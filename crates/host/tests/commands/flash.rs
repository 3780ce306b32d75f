//! Tests of `lizard flash` without a board.

use std::fs;
use std::time::{Duration, Instant};

use lizard_robot::Robot;

use crate::program::{robot_path, run_in};

/// An image of 20 bytes, as avr-objcopy writes it.
const HEX: &str = "\
:100000000C9434000C943E000C943E000C943E0082\n\
:0400100001020304E2\n\
:00000001FF\n";

/// Address of the robot in flash.
const ROBOT_START: usize = 0x6e00;
/// Address of the boot loader, where the space of the robot ends.
const BOOT_LOADER_START: usize = 0x7e00;

#[test]
fn flash_needs_no_built_firmware_and_fails_only_at_the_missing_port() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    for options in [&[][..], &["--only-robot"], &["--robot", "large"]] {
        let arguments = [&["flash", "/dev/no-such-port"], options].concat();
        run_in(folder.path(), &arguments, "").expect_refusal_with("no-such-port");
    }
}

#[test]
fn an_image_of_any_robot_is_made_in_an_empty_folder() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    for (name, options) in [("large", &[][..]), ("unequal", &["--only-robot"])] {
        let file_arguments = ["flash", "image", "--robot", name, "--output", "x.hex"];
        let arguments = [&file_arguments, options].concat();
        let start = Instant::now();
        let outcome = run_in(folder.path(), &arguments, "");
        assert!(
            start.elapsed() < Duration::from_secs(20),
            "{:?}",
            start.elapsed()
        );
        assert_eq!(outcome.stderr, "");
        let output = outcome.expect_success();
        assert!(
            output.starts_with("x.hex: ") && output.contains(&format!("robot {name} ")),
            "{output}"
        );
        let text = fs::read_to_string(folder.path().join("x.hex")).expect("the file is readable");
        let pipe_arguments = [&["flash", "image", "--robot", name], options].concat();
        let piped_text = run_in(folder.path(), &pipe_arguments, "").expect_success();
        assert!(piped_text == text, "the piped image equals the file");
        // The file is read by the simulator's loader, which shares no code with the writer.
        let image = simulated_uno::Image::parse_hex(&text).expect("the image is Intel HEX");
        let robot = Robot::load(robot_path(name)).expect("the robot file is valid");
        let flash = image.flash();
        assert!(flash[ROBOT_START..] == robot.section());
        let is_code = flash[..2] == [0x0c, 0x94];
        assert_eq!(is_code, options.is_empty(), "the code starts with a jump");
    }
}

#[test]
fn the_summary_of_an_image_is_printed_as_json() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let arguments = ["flash", "image", "--robot", "large", "--output", "x.hex"];
    let summary = run_in(folder.path(), &[&arguments[..], &["--json"]].concat(), "").expect_json();
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
    run_in(folder.path(), &["flash", "image", "--json"], "").expect_refusal_with("--output");
}

#[test]
fn an_invalid_robot_gives_no_image() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    fs::write(folder.path().join("x.toml"), "[servo]\n").expect("the file is written");
    let arguments = ["flash", "image", "--robot", "x.toml", "--output", "x.hex"];
    run_in(folder.path(), &arguments, "").expect_refusal_with("x.toml");
    assert!(!folder.path().join("x.hex").exists());
}

#[cfg(unix)]
#[test]
fn a_missing_port_is_named() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    fs::write(folder.path().join("a.hex"), HEX).expect("the file is written");
    let arguments = ["flash", "/dev/no-such-port", "--image", "a.hex"];
    let message = run_in(folder.path(), &arguments, "").expect_refusal();
    let expected_start =
        "lizard: there is no /dev/no-such-port; USB serial ports of this machine: ";
    assert!(message.starts_with(expected_start), "{message}");
}

#[test]
fn a_file_that_is_not_an_image_is_refused_before_any_port_is_opened() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    fs::write(folder.path().join("half.hex"), &HEX[..60]).expect("the file is written");
    let arguments = ["flash", "/dev/no-such-port", "--image", "half.hex"];
    let message = run_in(folder.path(), &arguments, "").expect_refusal();
    assert!(
        message.starts_with("lizard: half.hex: line 2 is not Intel HEX"),
        "{message}"
    );
    for conflicting_options in [&["--robot", "robot.toml"][..], &["--only-robot"]] {
        let all_arguments = [&arguments[..], conflicting_options].concat();
        run_in(folder.path(), &all_arguments, "").expect_refusal_with("cannot be used with");
    }
}
