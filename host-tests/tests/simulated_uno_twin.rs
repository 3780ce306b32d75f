//! AVR against host: the same core, the same commands, the same bits.

use lizard_host::sim::frame::servo_pins;
use lizard_host::sim::script::{Script, Step};
use lizard_host::sim::session::{Recording, play};
use lizard_host::sim::twin;
use lizard_host_tests::{FirmwareBench, robot};
use simulated_uno::{Fidelity, State, Uno};

/// Everything one can say to the robot, refused and accepted, `apart` ms from
/// each other, for ten minutes.
fn everything(apart: u64) -> Script {
    let gaits = robot().gaits.iter().map(|gait| gait.name.replace('-', " "));
    let mut lines: Vec<String> = gaits.collect();
    lines.extend(
        [
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
        ]
        .map(str::to_owned),
    );
    // A stride without a common factor, so that every line follows every other
    // in time; 7 ms against the ticks' 20, so that every phase of a frame is met.
    let steps = (0..600_000 / apart - 1)
        .map(|n| Step {
            ms: 1000 + n * apart,
            command: lines[(n * 11 % lines.len() as u64) as usize].clone(),
        })
        .collect();
    Script {
        steps,
        end_ms: 600_000,
    }
}

fn run(script: &Script, fidelity: Fidelity) -> Recording {
    let mut uno = Uno::load(FirmwareBench::elf(), fidelity).expect("`make firmware` builds it");
    play(&mut uno, servo_pins(robot()), script, false, |_| {})
}

#[test]
fn ten_minutes_of_commands_give_the_same_widths_and_words_on_the_avr_and_here() {
    for (fidelity, apart) in [(Fidelity::DataSheet, 707), (Fidelity::Stock, 1307)] {
        let recording = run(&everything(apart), fidelity);
        assert_eq!(recording.state, State::Alive);
        let frames = &recording.frames;
        assert!(frames.len() > 29_900, "{} frames", frames.len());
        let commands = twin::play(&recording.heard, frames[0].start, frames.len());
        for (n, (frame, command)) in frames.iter().zip(&commands.widths).enumerate() {
            let measured = frame.widths.map(|width| width.unwrap_or(0));
            assert_eq!(measured, command.map(u64::from), "{fidelity:?}, frame {n}");
        }
        let said: Vec<&str> = commands.said.lines().collect();
        let heard: Vec<&str> = recording
            .dialogue
            .iter()
            .filter(|said| said.by == lizard_host::sim::session::Speaker::Robot)
            .map(|said| said.line.as_str())
            .collect();
        // The last line may still be on its way.
        assert!(said.len() - heard.len() <= 1 && said.starts_with(&heard));
    }
}
