//! Tests of the program at a terminal: the terminal's modes, the program's end, and texts that must not be printed.

use std::fs::{self, File};
use std::io::{Read, Write};
use std::process::Child;
use std::sync::mpsc;

use lizard_time_limit::TIME_LIMIT;
use rustix::process::Signal;
use rustix::termios::{LocalModes, tcgetattr};

use crate::fixture::{
    Device, TerminalSession, Uno, find_gait_except_stand, run, send_signal, spawn_in_terminal,
    wait_for_exit,
};

/// Reads the state of a process, as `ps` prints it: S for sleeping, R for running, T for stopped.
fn read_process_state(child: &Child) -> char {
    let path = format!("/proc/{}/stat", child.id());
    let stat = fs::read_to_string(path).expect("the process exists");
    let (_, rest) = stat.rsplit_once(") ").expect("a state follows the name");
    rest.chars().next().expect("the state is a letter")
}

/// True if a terminal is in cooked mode: programs get whole lines, and keys are echoed.
fn is_cooked(terminal: &File) -> bool {
    let modes = tcgetattr(terminal).expect("the terminal has modes");
    modes
        .local_modes
        .contains(LocalModes::ICANON | LocalModes::ECHO)
}

#[test]
fn control_z_restores_the_terminal_and_the_program_can_continue() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let uno = Uno::start(&folder);
    let port = uno.port();
    for (command, first_text, keys, next_text) in [
        ("console", "no fault", "stop\r", "ok stop"),
        ("calibrate", "before you begin", "\r", "fit the horns"),
    ] {
        let mut session = TerminalSession::start(&folder, &format!("{command} {port}"));
        session.wait_for(first_text);
        assert!(!is_cooked(&session.keys), "{command}");
        session.press("\x1a");
        TIME_LIMIT.wait_for("a stopped program", || {
            read_process_state(&session.child) == 'T'
        });
        assert!(is_cooked(&session.keys), "{command}");
        send_signal(&session.child, Signal::CONT);
        TIME_LIMIT.wait_for("raw mode", || !is_cooked(&session.keys));
        session.press_and_wait(keys, next_text);
        session.press(if command == "console" { "\x04" } else { "q" });
        assert_eq!(session.wait_for_exit(), Some(0), "{command}");
    }
}

#[test]
fn a_program_ends_when_its_terminal_is_closed() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let uno = Uno::start(&folder);
    let port = uno.port();
    for (command, first_text) in [("console", "no fault"), ("calibrate", "before you begin")] {
        let command_line = format!("{command} {port}");
        let (mut test_side, mut child) = spawn_in_terminal(&folder, &command_line);
        TIME_LIMIT.run(first_text, move || {
            let mut text = String::new();
            let mut bytes = [0; 4096];
            while !text.contains(first_text) {
                let count = test_side.read(&mut bytes).expect("output is readable");
                text.push_str(&String::from_utf8_lossy(&bytes[..count]));
            }
            // This closes the terminal, since no other process has the test's side open.
            drop(test_side);
        });
        let code = wait_for_exit(&mut child).code();
        assert_eq!(code, Some(0), "{command}");
    }
}

#[test]
fn sigterm_restores_the_terminal() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let uno = Uno::start(&folder);
    let port = uno.port();
    for (command, first_text) in [("console", "no fault"), ("calibrate", "before you begin")] {
        let mut session = TerminalSession::start(&folder, &format!("{command} {port}"));
        session.wait_for(first_text);
        assert!(!is_cooked(&session.keys), "{command}");
        send_signal(&session.child, Signal::TERM);
        let code = wait_for_exit(&mut session.child).code();
        assert_eq!(code, Some(0), "{command}");
        assert!(is_cooked(&session.keys), "{command}");
    }
}

/// Starts a walking robot whose own `deadman` is 2000 ms, and which answers `stop` only from the second one on. The
/// receiver gets each line from the program except `status`.
fn start_walking_robot() -> (Device, mpsc::Receiver<String>) {
    let (sender, lines) = mpsc::channel();
    let mut received_text = String::new();
    let mut stop_count = 0;
    let device = Device::start(move |terminal| {
        let mut bytes = [0; 64];
        let count = terminal.read(&mut bytes).unwrap_or_default();
        received_text += &String::from_utf8_lossy(&bytes[..count]);
        while let Some((line, rest)) = received_text.split_once('\n') {
            stop_count += u32::from(line == "stop");
            if line != "status" {
                let _ = sender.send(line.to_owned());
            }
            let answer = match line {
                "status" => "ok gait=walk pose=1,2,3,4 margin=0.5 fault=none",
                "cal" => "# deadman 2000\nok cal",
                // This answers an earlier `status`, and does not confirm the line.
                "deadman 2000" => "ok gait=walk late",
                "stop" if stop_count == 1 => "# the answer is lost",
                line => &format!("ok {line}"),
            };
            let _ = writeln!(terminal, "{answer}");
            received_text = rest.to_owned();
        }
    });
    (device, lines)
}

#[test]
fn console_sends_the_robots_own_deadman_three_times_at_its_end_if_it_is_not_confirmed() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let (device, lines) = start_walking_robot();
    let mut session = TerminalSession::start(&folder, &format!("console {}", device.port));
    session.wait_for("not reset");
    session.press_and_wait("walk\r", "ok walk");
    session.press("\x04");
    assert_eq!(session.wait_for_exit(), Some(0));
    let is_own_deadman = |line: &String| line == "deadman 2000";
    let mut line_count = 0;
    TIME_LIMIT.wait_for("three lines", || {
        line_count += lines.try_iter().filter(is_own_deadman).count();
        line_count >= 3
    });
    device.stop();
    assert_eq!(line_count + lines.iter().filter(is_own_deadman).count(), 3);
}

#[test]
fn a_walking_robot_keeps_the_deadman_for_driving_if_sigterm_ends_the_program() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let (device, lines) = start_walking_robot();
    let mut session = TerminalSession::start(&folder, &format!("console {}", device.port));
    session.wait_for("not reset");
    session.press_and_wait("walk\r", "ok walk");
    send_signal(&session.child, Signal::TERM);
    let code = wait_for_exit(&mut session.child).code();
    assert_eq!(code, Some(0));
    device.stop();
    let lines: Vec<String> = lines.iter().collect();
    assert_eq!(lines, ["cal", "deadman 901", "walk"]);
}

#[test]
fn a_stop_before_the_end_of_the_console_is_sent_and_repeated_until_the_robot_answers() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let (device, lines) = start_walking_robot();
    let mut session = TerminalSession::start(&folder, &format!("console {}", device.port));
    session.wait_for("not reset");
    session.press_and_wait("walk\r", "ok walk");
    session.press("stop\r\x04");
    TIME_LIMIT.wait_for("the end of the program", || {
        let status = session.child.try_wait();
        status.expect("the wait succeeds").is_some()
    });
    device.stop();
    let lines: Vec<String> = lines.iter().collect();
    assert_eq!(lines[..5], ["cal", "deadman 901", "walk", "stop", "stop"]);
    TIME_LIMIT.wait_for("the message", || {
        session.read_output();
        session.new_text.contains("has not confirmed")
    });
    assert!(!session.new_text.contains("continues its gait"));
}

#[test]
fn console_does_not_say_that_an_ended_simulated_robot_continues() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let mut session = TerminalSession::start(&folder, "console --sim");
    session.wait_for("no fault");
    let gait = find_gait_except_stand(&folder);
    session.press_and_wait(&format!("{gait}\r"), &format!("ok {gait}"));
    session.wait_for(&format!("{gait}  "));
    session.press("\x04");
    TIME_LIMIT.wait_for("the end of the program", || {
        let status = session.child.try_wait();
        status.expect("the wait succeeds").is_some()
    });
    TIME_LIMIT.poll(|| {
        session.read_output();
        session.new_text.contains("\x1b[?2004l")
    });
    let text = &session.new_text;
    assert!(!text.contains("continues its gait"), "{text:?}");
}

#[test]
fn control_characters_of_a_robot_file_do_not_reach_the_terminal() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let text = include_str!("../../../../robots/paper.toml");
    let text = format!("{text}\n[gait.\"\\u001b]0;owned\\u0007\"]\nperiod = 1.0\n");
    fs::write(folder.path().join("bad.toml"), text).expect("the file is written");
    let (_, stderr) = run(&folder, "gaits --robot bad.toml", "", 2);
    assert!(stderr.contains("]0;owned"), "{stderr}");
    let control_count = stderr.trim_end().matches(|c: char| c.is_control()).count();
    assert_eq!(control_count, 0, "{stderr:?}");
}

#[test]
fn draw_prints_no_drawing_to_a_terminal_and_merge_reads_no_parts_from_it() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    for (command_line, message) in [
        (
            "draw --wiring",
            "lizard: standard output is a terminal; write the SVG to a file with --output",
        ),
        ("merge", "lizard: no parts given; "),
    ] {
        let mut session = TerminalSession::start(&folder, command_line);
        session.wait_for(message);
        assert!(!session.new_text.contains("<svg"), "{command_line}");
        assert_eq!(session.wait_for_exit(), Some(2), "{command_line}");
    }
}
