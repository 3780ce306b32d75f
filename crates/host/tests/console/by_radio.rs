//! Tests of scripts sent by radio, through a port that does not reset the board.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::Stdio;
use std::sync::mpsc;

use lizard_time_limit::TIME_LIMIT;

use crate::fixture::{
    Device, Uno, find_gait_except_stand, lizard_command, run_unchecked, wait_for_exit,
};

#[test]
fn the_robot_stops_after_a_script_by_radio_because_console_sets_deadman() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let uno = Uno::start_by_radio(&folder);
    let command = format!("console {}", uno.port());
    // The radio loses lines, so the script is repeated until all answers have arrived.
    let send_script = |lines: &str, expected: &[&str]| {
        let mut text = String::new();
        TIME_LIMIT.wait_for("all answers to the script", || {
            // The sleep is longer than the `deadman` time, so that the robot stops.
            std::thread::sleep(std::time::Duration::from_millis(1_500));
            (text, ..) = run_unchecked(&folder, &command, lines);
            expected.iter().all(|answer| text.contains(answer))
        });
        text
    };
    let gait = find_gait_except_stand(&folder);
    let accepted = format!("ok {gait}");
    send_script(
        &format!("stand\n{gait}\ncal\n"),
        &[
            "not reset",
            &accepted,
            "# deadman 0",
            "(no more lines: the robot now stops by itself)",
        ],
    );
    send_script("status\n", &["ok gait=stop", "fault=link"]);
    let text = send_script(
        &format!("{gait}\nstop\nstatus\n"),
        &[&accepted, "ok stop\nok gait=stop"],
    );
    let (_, status) = text.split_once("ok stop\n").expect("`stop` is accepted");
    assert!(!status.contains("fault=link"), "{text}");
}

#[test]
fn a_script_whose_output_cannot_be_written_stops_the_robot() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let (sender, stop_lines) = mpsc::channel();
    let mut received_text = String::new();
    let device = Device::start(move |terminal| {
        let mut bytes = [0; 64];
        let count = terminal.read(&mut bytes).unwrap_or_default();
        received_text += &String::from_utf8_lossy(&bytes[..count]);
        while let Some((line, rest)) = received_text.split_once('\n') {
            let answer = match line {
                "status" => "ok gait=walk pose=1,2,3,4 margin=0.5 fault=none",
                "cal" => "# deadman 0\nok cal",
                line => &format!("ok {line}"),
            };
            if line == "stop" {
                let _ = sender.send(());
            }
            let _ = writeln!(terminal, "{answer}");
            received_text = rest.to_owned();
        }
    });
    let mut child = lizard_command(&folder, &format!("console {}", device.port))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut script = child.stdin.take().expect("standard input is piped");
    let output = child.stdout.take().expect("standard output is piped");
    script.write_all(b"walk\n").expect("the program reads");
    let mut output_lines = BufReader::new(output).lines();
    TIME_LIMIT.run("the robot's walk", move || {
        // Then the output is closed.
        output_lines.any(|line| line.is_ok_and(|line| line == "ok walk"))
    });
    let _ = script.write_all(b"speed 50\n");
    wait_for_exit(&mut child);
    TIME_LIMIT.wait_for("the line `stop`", || stop_lines.try_recv().is_ok());
    device.stop();
}
