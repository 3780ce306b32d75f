//! Tests of `lizard console` and the other commands for a board, with a simulated UNO on a pseudo terminal, and of the
//! program at a terminal. The tests run in real time, so each test takes a few seconds.
#![cfg(target_os = "linux")]

mod by_radio;
mod fixture;
mod terminal;

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::Stdio;

use lizard_time_limit::TIME_LIMIT;
use rustix::process::Signal;

use fixture::{Device, TerminalSession, Uno, lizard_command, run, send_signal, wait_for_exit};

#[test]
fn console_prints_the_banner_and_the_answers_to_a_script_in_order() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let (stdout, stderr) = run(&folder, "console --sim", "cal\nfly\nstop\n", 1);
    assert!(
        stderr.ends_with(
            "lizard: the robot did not accept 1 of 3 lines, the first `fly`: err 1 unknown command; \
             send help for the list\n"
        ),
        "{stderr}"
    );
    assert!(stdout.starts_with("# lizard "), "{stdout}");
    let answers = stdout.lines().filter(|line| !line.starts_with('#'));
    assert_eq!(
        answers.collect::<Vec<_>>(),
        [
            "ok cal",
            "err 1 unknown command; send help for the list",
            "ok stop"
        ]
    );
    assert!(stdout.contains("\n# A4 trim 0.00 limit "), "{stdout}");
    let is_port_named = stderr.contains("(a simulated UNO)");
    assert!(is_port_named, "{stderr}");
    run(&folder, "console --sim", "cal\nstop\nquit\nfly\n", 0);
    // A line that is not UTF-8 does not end the script: `stop` must not be lost.
    let (stdout, stderr) = run(&folder, "console --sim", b"fly\xff\nstop\n", 1);
    assert!(stdout.ends_with("\nok stop\n"), "{stdout}");
    assert!(stderr.contains("did not accept 1 of 2 lines"), "{stderr}");
}

#[test]
fn restore_writes_a_backup_to_the_board_and_a_refused_calibration_changes_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let uno = Uno::start(&folder);
    let port = uno.port();
    let back_up = |file: &str| {
        run(&folder, &format!("calibrate backup {file} {port}"), "", 0);
        fs::read_to_string(folder.path().join(file)).expect("the file is readable")
    };
    let restore = |file: &str, text: &str, expected_code: i32| {
        fs::write(folder.path().join(file), text).expect("the file is written");
        let command_line = format!("calibrate restore {file} {port}");
        run(&folder, &command_line, "", expected_code)
    };
    let first_text = back_up("a.toml");
    let changed_text = first_text.replacen("trim = 0.0", "trim = -1.75", 1);
    let (stdout, _) = restore("b.toml", &changed_text, 0);
    assert!(
        stdout.ends_with("has accepted and saved the calibration from b.toml\n"),
        "{stdout}"
    );

    let scale_line = first_text.lines().find(|line| line.starts_with("scale = "));
    let refused_text =
        changed_text.replacen(scale_line.expect("A1 has a scale"), "scale = 99.0", 1);
    let (stdout, stderr) = restore("c.toml", &refused_text, 1);
    assert!(
        stderr.contains("c.toml: the robot refuses `scale 1 99.00`: err 3 scale must be 5..20"),
        "{stderr}"
    );
    assert_eq!(stdout, "");

    let saved_text = back_up("d.toml");
    assert_eq!(saved_text, changed_text, "the calibration after a reset");
}

#[test]
fn info_prints_a_boards_firmware_and_settings_and_changes_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let uno = Uno::start(&folder);
    let port = uno.port();
    let lines = "trim 3 -4.25\nboot rest\nsave\n";
    run(&folder, &format!("console {port}"), lines, 0);
    for _ in 0..2 {
        let (stdout, _) = run(&folder, &format!("info --json {port}"), "", 0);
        let board: serde_json::Value = serde_json::from_str(&stdout).expect("the output is JSON");
        assert_eq!(board["firmware"], env!("CARGO_PKG_VERSION"));
        assert_eq!(board["robot"]["hash"].as_str().map(str::len), Some(8));
        assert_eq!(board["fault"], serde_json::Value::Null);
        assert_eq!(board["vcc"], 5.0);
        assert_eq!(board["calibration"]["boot"], "rest");
        assert_eq!(board["calibration"]["servo"]["A3"]["trim"], -4.25);
    }
    let (text, _) = run(&folder, &format!("info {port}"), "", 0);
    assert!(text.contains("\nA3          trim -4.25 deg, "), "{text}");
}

#[test]
fn a_terminal_session_has_line_editing_and_reconnects_to_an_unplugged_board() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let uno = Uno::start(&folder);
    let command_line = format!("console --record a.jsonl {}", uno.port());
    let mut session = TerminalSession::start(&folder, &command_line);
    session.wait_for("# lizard ");
    session.wait_for("no fault");
    // Ctrl-A moves the cursor to the start of the line, where the missing letter is inserted.
    session.press_and_wait("top\x01s\r", "> stop");
    session.wait_for("ok stop");
    session.wait_for("stop  A1..A4");
    session.press_and_wait("\x1b[A\r", "ok stop");
    drop(uno);
    session.wait_for("the port is gone: the board was unplugged, or its cable is loose");
    session.wait_for("waiting for the board");
    session.press_and_wait("\x1b", "> stop");
    session.press_and_wait("stand 9\r", "> stand 9");
    let _uno = Uno::start(&folder);
    session.wait_for("is connected again: # lizard ");
    session.wait_for("(not sent or not answered: `stand 9`)");
    session.wait_for("ok stop");
    session.press_and_wait("stand\r", "ok stand");
    session.press("\x04");
    assert_eq!(session.wait_for_exit(), Some(0));
    let history = fs::read_to_string(folder.path().join("lizard/history"));
    let history = history.expect("the history is readable");
    assert_eq!(history, "stop\nstand 9\nstand\n");
    let recording = fs::read_to_string(folder.path().join("a.jsonl"));
    let recording = recording.expect("the file is readable");
    let has_banner = recording.contains("\"note\":\"# lizard ");
    assert!(has_banner, "the second banner is missing: {recording}");
}

#[test]
fn the_recording_of_a_script_shows_that_the_port_disappeared() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let uno = Uno::start(&folder);
    let command_line = format!("console --record a.jsonl {}", uno.port());
    let mut child = lizard_command(&folder, &command_line)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let read_recording = || fs::read_to_string(folder.path().join("a.jsonl")).unwrap_or_default();
    TIME_LIMIT.wait_for("a session in the file", || {
        read_recording().contains("\"begin\":")
    });
    drop(uno);
    // The program must end although its input is still open.
    assert_eq!(wait_for_exit(&mut child).code(), Some(1));
    let recording = read_recording();
    assert!(recording.ends_with("\"gone\":null}\n"), "{recording}");
}

#[test]
fn calibrate_advances_by_keys_and_can_be_cancelled() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let mut session = TerminalSession::start(&folder, "calibrate --sim");
    session.wait_for("before you begin");
    for (key, expected) in [
        ("\r", "fit the horns"),
        ("\r", "which way does A1"),
        (" ", "A1 has moved"),
        ("n", "The sign of A1 is `"),
        ("q", "cancelled: the robot keeps its old calibration"),
    ] {
        session.press_and_wait(key, expected);
    }
    assert_eq!(session.wait_for_exit(), Some(0));
}

#[test]
fn replay_draws_and_summarises_a_recorded_session() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let mut child = lizard_command(&folder, "console --record a.jsonl --sim")
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let mut stdin = child.stdin.take().expect("standard input is piped");
    let lines = b"speed 50\nfly\n";
    stdin.write_all(lines).expect("the program reads its input");
    let file = folder.path().join("a.jsonl");
    TIME_LIMIT.wait_for("a refusal and a second of poses in the file", || {
        let recording = fs::read_to_string(&file).unwrap_or_default();
        recording.contains(r#""answer":"err "#) && recording.matches(r#""pose":"#).count() > 50
    });
    drop(stdin);
    let code = wait_for_exit(&mut child).code();
    assert_eq!(code, Some(1), "exit code after a refused line");

    let (stdout, _) = run(&folder, "console replay a.jsonl --svg a.svg", "", 0);
    for line in [
        " > speed 50\n",
        "commands    2, 1 refused\n",
        "problem     none\n",
    ] {
        assert!(stdout.contains(line), "{line}: {stdout}");
    }
    let drawing = fs::read_to_string(folder.path().join("a.svg")).expect("the file is readable");
    // A machine that pauses for a second leaves a gap, which splits each servo's curve into two.
    let curve_count = drawing.matches("<polyline").count();
    assert!(
        curve_count >= 4 && curve_count.is_multiple_of(4),
        "{curve_count} curves"
    );

    let (_, stderr) = run(&folder, "console --record a.jsonl --sim", "", 2);
    assert!(stderr.contains("a.jsonl already exists"), "{stderr}");
}

#[test]
fn a_command_refuses_a_port_that_another_program_has_open() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let uno = Uno::start(&folder);
    let port = uno.port();
    let mut other_session = TerminalSession::start(&folder, &format!("console {port}"));
    other_session.wait_for("# lizard ");
    let command_line = format!("calibrate backup a.toml {port}");
    let (_, stderr) = run(&folder, &command_line, "", 1);
    let owner_text = format!("is open in lizard (process {})", other_session.child.id());
    other_session.press("\x03");
    assert!(stderr.contains(&owner_text), "{stderr}");
    assert!(!folder.path().join("a.toml").exists());
}

#[test]
fn the_error_for_a_board_without_lizard_firmware_shows_its_output() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let device = Device::start(|terminal| {
        // Writing fails while no program has the port open.
        let _ = terminal.write_all(b"Grbl 1.1h ['$' for help]\r\n");
    });
    let command_line = format!("calibrate backup a.toml {}", device.port);
    let (_, stderr) = run(&folder, &command_line, "", 1);
    device.stop();
    let expected = "this is not a lizard: expected `# lizard ...`, got `Grbl 1.1h ['$' for help]`";
    assert!(stderr.contains(expected), "{stderr}");
    // No incomplete file remains.
    assert!(!folder.path().join("a.toml").exists());
}

#[test]
fn the_error_for_a_board_that_becomes_silent_counts_the_lines_not_sent() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let mut received_bytes: Vec<u8> = Vec::new();
    let device = Device::start(move |terminal| {
        let mut bytes = [0; 64];
        // Reading fails while no program has the port open.
        let count = terminal.read(&mut bytes).unwrap_or_default();
        received_bytes.extend(&bytes[..count]);
        if received_bytes == b"status\n" {
            let _ = terminal.write_all(b"ok gait=rest pose=1,2,3,4 fault=none\r\n");
        }
    });
    let command_line = format!("console --record a.jsonl {}", device.port);
    let (_, stderr) = run(&folder, &command_line, "walk\nspeed 50\nstop\n", 1);
    device.stop();
    let expected = "lizard: the robot did not accept 3 of 3 lines, the first `walk`: not sent\n";
    assert!(stderr.ends_with(expected), "{stderr}");
}

#[test]
fn commands_refuse_invalid_input_with_a_message() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    for (name, text) in [
        ("no.toml", "trim: 5\n"),
        ("other.toml", "[links]\nl0 = 20.0\n"),
    ] {
        fs::write(folder.path().join(name), text).expect("the file is written");
    }
    let not_a_calibration =
        "other.toml: format must be \"lizard calibration 1\": this is not a calibration";
    let not_a_session = "other.toml: this is not a session of `lizard console --record`: \
        \"lizard record 1\" is missing";
    for (command_line, expected) in [
        (
            "console /dev/no-such-port",
            "/dev/no-such-port does not exist; USB serial ports of this machine: ",
        ),
        ("calibrate restore no.toml", "no.toml:1: invalid TOML: "),
        ("calibrate restore other.toml", not_a_calibration),
        ("calibrate restore none.toml", "cannot read none.toml: "),
        ("console replay other.toml", not_a_session),
        (
            "calibrate /dev/no-such-port",
            "calibrate reads single keys; run it in a terminal",
        ),
    ] {
        let (stdout, stderr) = run(&folder, command_line, "", 2);
        let message = stderr.trim().strip_prefix("lizard: ");
        let has_message = message.is_some_and(|message| message.starts_with(expected));
        let is_refused = has_message && stdout.is_empty();
        assert!(is_refused, "{command_line}: {stderr}");
    }
}

#[test]
fn the_symlink_to_a_simulated_board_replaces_no_other_file_and_is_removed_when_the_board_ends() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let (board_link, other_link) = (folder.path().join("uno"), folder.path().join("other"));
    std::os::unix::fs::symlink("a-file", &other_link).expect("the link is created");
    let name = other_link.display().to_string();
    let (_, stderr) = run(&folder, &format!("sim --pty {name}"), "", 2);
    assert_eq!(
        stderr.trim(),
        format!(
            "lizard: {name} already exists and is not a link to a pseudo terminal; choose another name"
        )
    );
    let target = fs::read_link(&other_link).expect("the link is readable");
    assert_eq!(target, Path::new("a-file"));

    // A killed run leaves a broken link, which a new run replaces.
    std::os::unix::fs::symlink("/dev/pts/999999", &board_link).expect("the link is created");
    let command_line = format!("sim --pty {}", board_link.display());
    // A standard output that cannot be written to must not end the simulation.
    let mut command = lizard_command(&folder, &command_line);
    let child = command.stdout(full_device()).spawn();
    let mut child = child.expect("the program starts");
    TIME_LIMIT.wait_for("a port at the end of the link", || board_link.exists());
    send_signal(&child, Signal::TERM);
    let status = wait_for_exit(&mut child);
    let signal = std::os::unix::process::ExitStatusExt::signal(&status);
    assert_eq!(signal, Some(15), "not ended by SIGTERM");
    assert!(!board_link.is_symlink(), "the link must be removed");
}

#[test]
fn a_backup_whose_output_cannot_be_printed_ends_with_code_1() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let mut command = lizard_command(&folder, "calibrate backup a.toml --sim");
    let mut child = command
        .stdout(full_device())
        .spawn()
        .expect("the program starts");
    assert_eq!(wait_for_exit(&mut child).code(), Some(1));
    assert!(folder.path().join("a.toml").exists());
}

#[test]
fn flash_names_the_robot_before_it_writes_the_board() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let device = Device::start(|_| ());
    for (options, robot) in [
        ("", "the built-in robot.toml"),
        ("--robot large", "the robot large"),
    ] {
        let line = format!("flash {} {options}", device.port);
        let mut command = lizard_command(&folder, &line);
        let mut child = command.stderr(Stdio::piped()).spawn();
        let child = child.as_mut().expect("the program starts");
        let stderr = child.stderr.take().expect("standard error is a pipe");
        let first_line = BufReader::new(stderr).lines().next();
        child.kill().expect("the program can be ended");
        wait_for_exit(child);
        let first_line = first_line.expect("there is a line");
        let first_line = first_line.expect("the line is UTF-8");
        assert_eq!(first_line, format!("lizard: writing {robot}"));
    }
    device.stop();
}

#[test]
fn a_full_standard_error_does_not_end_a_command() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    for line in ["calibrate backup a.toml --sim", "backup b.toml --sim"] {
        let mut command = lizard_command(&folder, line);
        let child = command.stdout(Stdio::null()).stderr(full_device()).spawn();
        let mut child = child.expect("the program starts");
        assert_eq!(wait_for_exit(&mut child).code(), Some(0), "{line}");
    }
    for file in ["a.toml", "b.toml"] {
        assert!(folder.path().join(file).exists(), "{file}");
    }
}

/// Opens a device to which nothing can be written.
fn full_device() -> File {
    let device = File::options().write(true).open("/dev/full");
    device.expect("the device can be opened")
}
