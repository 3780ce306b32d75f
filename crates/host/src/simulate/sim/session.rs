//! Plays a script on the simulated UNO.

use std::io;
use std::time::{Duration, Instant};

use lizard_robot::Robot;
use simulated_uno::{CYCLES_PER_MS, FREQUENCY, SerialByte, State, Uno};

use super::frame::{FRAME_CYCLES, servo_pins};
use super::frame_log::{FrameLog, FrameReader};
use super::lines::LineReader;
use super::script::Script;
use super::supplies;

/// The sender of a line of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Sender {
    /// The user or the script.
    User,
    /// The firmware on the simulated board.
    Robot,
}

/// A line of the dialogue.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct DialogueLine {
    /// Milliseconds from power-on to the end of the robot's line, or to the start of the user's line.
    pub ms: f64,
    /// The line's sender.
    pub from: Sender,
    /// The text without the line end.
    pub text: String,
}

/// An event during [`play`].
#[derive(Debug)]
pub enum Event {
    /// The next line of the dialogue.
    Line(DialogueLine),
    /// The simulated time in ms since power-on, reported every 20 ms and at the end.
    Time(u64),
}

/// The result of a run.
#[derive(Debug)]
pub struct Recording {
    /// The firmware's first line; `None` if it has sent no line.
    pub banner: Option<String>,
    /// The answer to each command of the script; `None` if no answer arrived before the end of the run.
    pub answers: Vec<Option<String>>,
    /// The servo pulses of each frame.
    pub frames: FrameLog,
    /// The bytes that the UNO received completely, each with its cycle.
    pub received_by_uno: Vec<SerialByte>,
    /// The number of simulated cycles.
    pub cycles: u64,
    /// The firmware's final state.
    pub state: State,
    /// Wall time of the run.
    pub wall_time: Duration,
}

/// Connects a robot's supplies and contacts to the UNO, and plays a script from power-on. Calls `on_event` for each
/// event, in order of time.
///
/// # Errors
/// Returns the errors of `on_event`, which end the run.
pub fn play(
    uno: &mut Uno,
    robot: &Robot,
    script: &Script,
    on_event: impl FnMut(Event) -> io::Result<()>,
) -> io::Result<Recording> {
    supplies::connect_healthy_robot(uno, robot);
    let start = Instant::now();
    let mut dialogue = Dialogue {
        reader: LineReader::default(),
        banner: None,
        answers: Vec::with_capacity(script.steps.len()),
        on_event,
    };
    let mut frame_reader = FrameReader::new(servo_pins(robot));
    let mut steps = script.steps.iter().peekable();
    let mut changes = script.contact_changes.iter().peekable();
    let mut ms = 0;
    while ms < script.end_ms && *uno.state() == State::Alive {
        let slice_end_ms = (ms + FRAME_CYCLES / CYCLES_PER_MS).min(script.end_ms);
        loop {
            let next_command_ms = steps.peek().map_or(slice_end_ms, |step| step.ms);
            if let Some(change) =
                changes.next_if(|change| change.time_ms < slice_end_ms.min(next_command_ms))
            {
                uno.run_until_cycle(change.time_ms * CYCLES_PER_MS);
                change.apply(uno);
            } else if let Some(step) = steps.next_if(|step| step.ms < slice_end_ms) {
                uno.run_until_cycle(step.ms * CYCLES_PER_MS);
                dialogue.receive(uno)?;
                dialogue.send(uno, &step.command)?;
            } else {
                break;
            }
        }
        uno.run_until_cycle(slice_end_ms * CYCLES_PER_MS);
        dialogue.receive(uno)?;
        frame_reader.read(uno.take_edges());
        ms = slice_end_ms;
        (dialogue.on_event)(Event::Time(ms))?;
    }
    dialogue.answers.resize(script.steps.len(), None);
    Ok(Recording {
        banner: dialogue.banner,
        answers: dialogue.answers,
        frames: frame_reader.finish(uno.cycle()),
        received_by_uno: uno.received_by_uno(),
        cycles: uno.cycle(),
        state: uno.state().clone(),
        wall_time: start.elapsed(),
    })
}

/// The dialogue on the serial line: collects the answers and reports the lines.
struct Dialogue<F> {
    reader: LineReader,
    banner: Option<String>,
    /// The answers, in the order of the commands.
    answers: Vec<Option<String>>,
    on_event: F,
}

impl<F: FnMut(Event) -> io::Result<()>> Dialogue<F> {
    /// Sends a command to the UNO and reports it.
    fn send(&mut self, uno: &mut Uno, command: &str) -> io::Result<()> {
        uno.send(command.as_bytes());
        uno.send(b"\n");
        (self.on_event)(Event::Line(DialogueLine {
            ms: uno.ms(),
            from: Sender::User,
            text: command.to_owned(),
        }))
    }

    /// Reads the bytes that the UNO has sent, and reports the completed lines.
    fn receive(&mut self, uno: &mut Uno) -> io::Result<()> {
        for line in self.reader.read(&uno.take_transmitted()) {
            if line.is_answer() {
                self.answers.push(Some(line.text.clone()));
            }
            self.banner.get_or_insert_with(|| line.text.clone());
            (self.on_event)(Event::Line(DialogueLine {
                ms: line.cycle as f64 * 1000.0 / FREQUENCY as f64,
                from: Sender::Robot,
                text: line.text,
            }))?;
        }
        Ok(())
    }
}
