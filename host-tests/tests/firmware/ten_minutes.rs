//! Test that the core computes the same widths and lines on the AVR and on the host, with a script of ten minutes.

use crate::to_comparable_line;
use lizard_host::sim::core_run;
use lizard_host::sim::script::{Script, Step};
use lizard_host::sim::session::{Event, Recording, Sender, play};
use lizard_host_tests::{FirmwareBench, gait_commands, robot};
use simulated_uno::{Fidelity, State, Uno};

/// Builds a script of ten minutes with every kind of line, accepted or refused, one line every `interval_ms`.
fn build_script(interval_ms: u64) -> Script {
    let other_lines = [
        "speed 35",
        "pose 120 60 300 240",
        "watch 3",
        "stop",
        "status",
        "speed 100",
        "help",
        "pose 90 90 318.59 221.41",
        "no such thing",
        "watch 0",
        "rest",
        "walk",
        "stand",
        "pose 138.59 41.41 318.59 221.41",
    ];
    let mut lines = gait_commands();
    lines.extend(other_lines.map(str::to_owned));
    // The stride of 11 has no common factor with the number of lines, so every line is sent. The interval has no common
    // factor with a frame's 20 ms, so the lines fall on every phase of a frame.
    let steps = (0..600_000 / interval_ms - 1)
        .map(|index| Step {
            ms: 1000 + index * interval_ms,
            command: lines[(index * 11 % lines.len() as u64) as usize].clone(),
        })
        .collect();
    Script::new(steps, 600_000)
}

/// Runs a script and returns the recording and the lines that the robot sent.
fn record_script(script: &Script, fidelity: Fidelity) -> (Recording, Vec<String>) {
    let mut uno = Uno::with_image(FirmwareBench::image(), fidelity);
    let mut lines = Vec::new();
    let recording = play(&mut uno, robot(), script, |event| {
        if let Event::Line(line) = event
            && line.from == Sender::Robot
        {
            lines.push(line.text.clone());
        }
        Ok(())
    });
    (recording.expect("the event handler never fails"), lines)
}

#[test]
fn ten_minutes_of_commands_give_the_same_widths_and_lines_on_the_avr_and_on_the_host() {
    for (fidelity, interval_ms) in [(Fidelity::DataSheet, 707), (Fidelity::Stock, 1307)] {
        let mut script = build_script(interval_ms);
        let (mut recording, mut lines) = record_script(&script, fidelity);
        let first_rise = recording.frames.first_start;
        let find_undetermined_lines = |recording: &Recording| -> Vec<usize> {
            core_run::find_undetermined_lines(&recording.received_by_uno, first_rise).collect()
        };
        let undetermined_lines = find_undetermined_lines(&recording);
        if !undetermined_lines.is_empty() {
            for line in undetermined_lines {
                script.steps[line].ms += 1;
            }
            (recording, lines) = record_script(&script, fidelity);
            let remaining_lines = find_undetermined_lines(&recording);
            assert!(
                remaining_lines.is_empty(),
                "lines {remaining_lines:?} still end at a tick"
            );
        }
        assert_eq!(recording.state, State::Alive);
        let log = &recording.frames;
        let (received, frame_count) = (&recording.received_by_uno, log.widths.len());
        assert!(frame_count > 29_900, "{frame_count} frames");
        let firmware = *robot().firmware();
        let host_run = core_run::play(firmware, received, &[], log.first_start, frame_count);
        for (n, (avr_widths, host_widths)) in log.widths.iter().zip(&host_run.widths).enumerate() {
            assert_eq!(avr_widths, host_widths, "{fidelity:?}, frame {n}");
        }
        // Reports are not compared, because a report's frame also depends on the free space in the serial buffer.
        let mut host_lines: Vec<&str> = host_run.text.lines().collect();
        let mut lines: Vec<&str> = lines.iter().map(String::as_str).collect();
        for lines in [&mut host_lines, &mut lines] {
            lines.retain(|line| !line.starts_with("# t="));
        }
        for (n, (host_line, avr_line)) in host_lines.iter().zip(&lines).enumerate() {
            let [expected, actual] =
                [host_line, avr_line].map(|line| to_comparable_line(line, fidelity));
            assert_eq!(expected, actual, "{fidelity:?}, line {n}");
        }
        // At the end of the run, the UNO has not yet sent everything (255 bytes in the ring buffer, two in the
        // transmitter, part of a line), and the core on the host has not run since the last complete frame.
        let common_count = host_lines.len().min(lines.len());
        assert!(common_count > 400, "{common_count} common lines");
        let unmatched_lines = host_lines[common_count..]
            .iter()
            .chain(&lines[common_count..]);
        let unmatched_bytes: usize = unmatched_lines.map(|line| line.len() + 2).sum();
        assert!(
            unmatched_bytes <= 257 + 192,
            "{common_count} common lines, then {unmatched_bytes} bytes from only one side"
        );
        let answer_count = recording.answers.iter().flatten().count();
        let step_count = script.steps.len();
        assert_eq!(answer_count, step_count, "some commands got no answer");
    }
}
