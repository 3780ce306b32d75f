//! Tests of `lizard flash --only-robot`, which writes only the robot's section in flash to a board that already has the
//! firmware.

use super::*;

/// Sends a text, which may be empty, runs the board for `ms` simulated milliseconds, and returns the board's output.
fn send_text(board: &mut ConnectedBoard, text: &str, ms: u64) -> String {
    board.uno.take_transmitted();
    board.uno.send(text.as_bytes());
    board.uno.run_ms(ms);
    decode_text(&board.uno.take_transmitted())
}

/// Checks that flash up to the end of the robot's section is the firmware with this robot.
#[track_caller]
fn assert_robot_written(board: &ConnectedBoard, robot: &Robot) {
    let end = usize::from(START_ADDRESS) + robot.section().len();
    assert_flashed_with_robot(board, robot, end);
}

#[test]
fn only_the_robot_is_written_to_a_board_with_the_firmware_and_its_trims_are_kept() {
    let (name, other_robot) = load_another_robot();
    let mut board = prepare_board_with_firmware();
    board.uno.power_cycle();
    assert!(send_text(&mut board, "", 2500).contains("# lizard "));
    assert!(send_text(&mut board, "trim 1 3.5\n", 200).contains("ok"));
    assert!(send_text(&mut board, "save\n", 500).contains("ok"));
    replug(&mut board);
    let eeprom_before = board.uno.eeprom();

    let shell = start_lizard_flash(&board, &["--only-robot", "--robot", name]);
    board.wait_for_text(&shell, "written and verified");
    assert_eeprom_kept(&board, &eeprom_before);
    let screen = board.run_until_exit(&shell);
    let [first_label, other_label] =
        [robot(), &other_robot].map(|robot| format_robot_label(robot.firmware()));
    assert_contains(&screen, &format!(" robot {first_label}\n"));
    let banner = screen.lines().find(|line| line.starts_with("# lizard "));
    assert!(
        banner.is_some_and(|line| line.contains(&format!(" robot {other_label}"))),
        "{screen}"
    );
    assert_robot_written(&board, &other_robot);

    // Then the first robot is written again, with `--json`. Its trims are unchanged.
    let screen = run_lizard_flash(&mut board, &["--only-robot", "--json"]);
    let pieces = first_label.split_once(' ');
    let (first_name, first_hash) = pieces.expect("the label has a name and a hash");
    let version = env!("CARGO_PKG_VERSION");
    let expected_end = format!(
        r#","firmware":"{version}","robot":{{"name":"{first_name}","hash":"{first_hash}"}}}}"#
    );
    let json_line = screen.lines().find(|line| line.starts_with(r#"{"port":""#));
    let is_expected =
        |line: &str| line.contains(r#""bytes_written":"#) && line.ends_with(&expected_end);
    assert!(json_line.is_some_and(is_expected), "{screen}");
    assert!(!screen.contains("\n# lizard"), "{screen}");
    assert_eeprom_kept(&board, &eeprom_before);
    let answer = send_text(&mut board, "cal\n", 500);
    assert!(answer.contains("3.5"), "{answer}");
}

#[test]
fn a_board_unplugged_during_a_write_has_no_robot_until_the_next_upload() {
    let (name, other_robot) = load_another_robot();
    let mut board = prepare_board_with_firmware();
    let arguments = ["--only-robot", "--robot", name];
    let shell = start_lizard_flash(&board, &arguments);
    let section = other_robot.section();
    // Waits until the third page of the robot is written.
    let third_page = usize::from(START_ADDRESS) + 0x100;
    let is_in_time = board.run_until(|uno| {
        uno.flash()[third_page..third_page + 0x80] == section[0x100..0x180] || shell.has_ended()
    });
    assert!(is_in_time && !shell.has_ended(), "{}", shell.screen());
    replug(&mut board);
    let screen = board.run_until_exit(&shell);
    assert!(screen.contains("the port is gone"), "{screen}");
    assert!(screen.contains("an incomplete robot"), "{screen}");

    // After the board is plugged in again, the firmware reports the missing robot, and no servo moves.
    board.uno.power_cycle();
    board.uno.take_edges();
    let output_text = send_text(&mut board, "", 2500);
    assert_contains(&output_text, "no robot in the flash");
    let output_text = send_text(&mut board, "walk\n", 300);
    assert!(output_text.contains("err "), "{output_text}");
    assert!(send_text(&mut board, "status\n", 300).contains("fault=robot"));
    let edges = board.uno.take_edges();
    let pins = servo_pins(&other_robot);
    let has_pulse = edges.iter().any(|edge| pins.contains(&edge.pin));
    assert!(!has_pulse, "{edges:?}");
    replug(&mut board);

    let screen = run_lizard_flash(&mut board, &arguments);
    assert!(screen.contains(" without a robot\n"), "{screen}");
    let other_label = format_robot_label(other_robot.firmware());
    assert_contains(&screen, &format!(" robot {other_label}"));
    assert_robot_written(&board, &other_robot);
}

#[test]
fn no_robot_is_written_to_a_board_with_another_program() {
    let mut board = prepare_board_with_firmware();
    // A sketch replaces the firmware. avrdude writes only the sketch's pages, so the robot's section remains in flash.
    board.uno.write_flash(0, &SENDER_IMAGE.flash());
    let flash_before = board.uno.flash().to_vec();
    let screen = run_lizard_flash(&mut board, &["--only-robot"]);
    assert!(screen.contains("the board has another program"), "{screen}");
    assert!(screen.contains("Nothing was written"), "{screen}");
    assert!(board.uno.flash() == flash_before);
}

#[test]
fn avrdude_writes_the_robot_file_made_by_lizard_flash_image() {
    let (name, other_robot) = load_another_robot();
    let mut board = prepare_board_with_firmware();
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let hex_path = folder.path().join("robot.hex").display().to_string();
    let shell = start_lizard(&[
        "flash",
        "image",
        "--only-robot",
        "--robot",
        name,
        "--output",
        &hex_path,
    ]);
    board.run_until_exit(&shell);
    let write_option = format!("flash:w:{hex_path}:i");
    let port = board.port_path();
    let options = ["-D", "-c", "arduino", "-p", "atmega328p", "-b", "115200"];
    let arguments = [&options[..], &["-P", &port, "-U", &write_option]].concat();
    let shell = Shell::start("avrdude", &arguments, &[]);
    let screen = board.run_until_exit(&shell);
    assert!(screen.contains("bytes of flash verified"), "{screen}");
    assert_robot_written(&board, &other_robot);
}
