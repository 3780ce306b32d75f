//! A script played on the simulated UNO.

use std::time::{Duration, Instant};

use simulated_uno::{CYCLES_PER_MS, Pin, SerialByte, State, Uno, most_pins_high};

use super::console::Console;
use super::frame::{FRAME, Frame, frames, opens};
use super::script::Script;

/// Who said a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Speaker {
    /// The person at the console.
    You,
    /// The firmware.
    Robot,
}

/// A line of the dialogue.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Said {
    /// Milliseconds since power-on: for the robot at the line's end, for the
    /// person at its start.
    pub ms: f64,
    /// Who said it.
    pub by: Speaker,
    /// The line.
    pub line: String,
}

/// What a run left behind.
#[derive(Debug)]
pub struct Recording {
    /// The whole dialogue in order of time.
    pub dialogue: Vec<Said>,
    /// Every frame from A1's first pulse on.
    pub frames: Vec<Frame>,
    /// The bytes of the commands, complete at the UNO.
    pub heard: Vec<SerialByte>,
    /// The most servo pins high at once.
    pub most_pins_high: u32,
    /// Cycles simulated.
    pub cycles: u64,
    /// How the firmware ended.
    pub state: State,
    /// Wall time it took.
    pub wall: Duration,
}

/// Plays a script from where the board is now. `progress` is told the time in ms
/// every 20 ms; `realtime` waits for the wall clock.
pub fn play(
    uno: &mut Uno,
    pins: [Pin; 4],
    script: &Script,
    realtime: bool,
    mut progress: impl FnMut(u64),
) -> Recording {
    let begin = Instant::now();
    let mut console = Console::default();
    let mut dialogue = Vec::new();
    let mut steps = script.steps.iter().peekable();
    let mut ms = 0;
    while ms < script.end_ms && *uno.state() == State::Alive {
        let until = (ms + 20).min(script.end_ms);
        while let Some(step) = steps.next_if(|step| step.ms < until) {
            uno.run_until_cycle(step.ms * CYCLES_PER_MS);
            dialogue.push(Said {
                ms: uno.ms(),
                by: Speaker::You,
                line: step.command.clone(),
            });
            uno.send(step.command.as_bytes());
            uno.send(b"\n");
        }
        uno.run_until_cycle(until * CYCLES_PER_MS);
        console.collect(uno);
        ms = until;
        progress(ms);
        if realtime {
            std::thread::sleep(Duration::from_millis(ms).saturating_sub(begin.elapsed()));
        }
    }
    let said = console.lines().iter().map(|line| Said {
        ms: line.cycle as f64 / CYCLES_PER_MS as f64,
        by: Speaker::Robot,
        line: line.text.clone(),
    });
    dialogue.extend(said);
    dialogue.sort_by(|a, b| a.ms.total_cmp(&b.ms));

    let edges: Vec<_> = uno
        .edges()
        .into_iter()
        .filter(|edge| pins.contains(&edge.pin))
        .collect();
    let first = edges.iter().find(|edge| edge.high && edge.pin == pins[0]);
    let frames = first.map_or(Vec::new(), |first| {
        let count = (uno.cycle() - opens(first.cycle)) / FRAME;
        frames(&edges, pins, first.cycle, count)
    });
    Recording {
        dialogue,
        frames,
        heard: uno.received_by_uno(),
        most_pins_high: most_pins_high(&edges),
        cycles: uno.cycle(),
        state: uno.state().clone(),
        wall: begin.elapsed(),
    }
}
