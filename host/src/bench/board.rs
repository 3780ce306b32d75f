//! A simulated UNO that is talked to and measured.

use std::path::Path;

use lizard_robot::Robot;
use simulated_uno::{CYCLES_PER_MS, Call, Fidelity, Pin, State, Uno, most_pins_high};

use crate::Failure;
use crate::sim::console::Console;
use crate::sim::frame::{FRAME, Frame, frames, opens, servo_pins};
use crate::sim::twin;

/// The longest wait for an answer, ms.
const PATIENCE: u64 = 200;

/// The firmware, powered on.
pub struct Board {
    pub uno: Uno,
    console: Console,
    pins: [Pin; 4],
}

/// How exact pulses were.
pub struct Exactness {
    /// Least and largest width less its command, cycles.
    pub error: [i64; 2],
    /// Largest deviation of two frames' distance from 20 ms, cycles.
    pub period: u64,
    /// The most servo pins high at once.
    pub pins_high: u32,
    /// The step in which widths vary, cycles.
    pub step: u64,
}

impl Board {
    /// A board a second after power-on, by the data sheet.
    pub fn awake(elf: &Path, robot: &Robot) -> Result<Self, Failure> {
        let uno = Uno::load(elf, Fidelity::DataSheet)
            .map_err(|error| Failure::Input(format!("{}: {error}", elf.display())))?;
        let mut board = Self {
            uno,
            console: Console::default(),
            pins: servo_pins(robot),
        };
        board.run_ms(1000)?;
        Ok(board)
    }

    /// Lets time pass.
    pub fn run_ms(&mut self, ms: u64) -> Result<(), Failure> {
        match self.uno.run_ms(ms) {
            State::Alive => Ok(()),
            State::Halted => Err(dead("the firmware sleeps with interrupts off, for ever")),
            State::Crashed { message, .. } => Err(dead(message)),
        }
    }

    /// Sends a line and returns its answer.
    pub fn say(&mut self, line: &str) -> Result<String, Failure> {
        self.console.collect(&mut self.uno);
        let before = self.console.lines().len();
        self.uno.send(line.as_bytes());
        self.uno.send(b"\n");
        for _ in 0..PATIENCE {
            self.run_ms(1)?;
            self.console.collect(&mut self.uno);
            let mut lines = self.console.lines()[before..].iter();
            if let Some(answer) = lines.find(|line| line.is_answer()) {
                return Ok(answer.text.clone());
            }
        }
        Err(dead(&format!("no answer to `{line}`")))
    }

    /// A counter of `status`.
    pub fn count(&mut self, key: &str) -> Result<u64, Failure> {
        let status = self.say("status")?;
        let value = status.split(' ').find_map(|pair| {
            let (name, value) = pair.split_once('=')?;
            (name == key).then(|| value.parse().ok())?
        });
        value.ok_or_else(|| dead(&format!("`{status}` has no {key}")))
    }

    /// Times every call of a function of the firmware.
    pub fn time(&mut self, function: &str, ms: u64) -> Result<Vec<Call>, Failure> {
        let symbol = self.uno.image().function(function);
        let entry = symbol.map(|symbol| symbol.address as u32);
        let entry = entry.ok_or_else(|| dead(&format!("there is no function {function}")))?;
        Ok(self.uno.time_calls(entry, ms * CYCLES_PER_MS))
    }

    /// Cycles spent so far in the handlers of some vectors.
    pub fn in_handlers(&self, which: impl Fn(u8) -> bool) -> u64 {
        let all = self.uno.interrupts();
        let those = all.iter().filter(|used| which(used.vector));
        those.map(|used| used.cycles).sum()
    }

    /// Cycle of A1's first pulse.
    pub fn first_pulse(&self) -> Result<u64, Failure> {
        let pulses = self.uno.pulses(self.pins[0]);
        let first = pulses.first().map(|pulse| pulse.start);
        first.ok_or_else(|| dead("A1 gets no pulse"))
    }

    /// Every frame so far.
    fn frames(&self) -> Result<Vec<Frame>, Failure> {
        let first = self.first_pulse()?;
        let count = (self.uno.cycle() - opens(first)) / FRAME;
        Ok(frames(&self.uno.edges(), self.pins, first, count))
    }

    /// How exact all pulses so far were, where no more than the first `heard`
    /// bytes have been commands.
    pub fn exactness(&self, heard: usize) -> Result<Exactness, Failure> {
        let sent = self.frames()?;
        let commands = twin::play(
            &self.uno.received_by_uno()[..heard],
            sent[0].start,
            sent.len(),
        );
        let mut exactness = Exactness {
            error: [i64::MAX, i64::MIN],
            period: 0,
            pins_high: 0,
            step: 0,
        };
        for (frame, asked) in sent.iter().zip(&commands.widths) {
            for (width, asked) in frame.widths.iter().zip(asked) {
                let width = width.unwrap_or(0);
                let error = width as i64 - i64::from(*asked);
                exactness.error[0] = exactness.error[0].min(error);
                exactness.error[1] = exactness.error[1].max(error);
                exactness.step = common(exactness.step, width.abs_diff(24_000));
            }
        }
        for pair in sent.windows(2) {
            for servo in 0..4 {
                if let (Some(here), Some(next)) = (pair[0].starts[servo], pair[1].starts[servo]) {
                    exactness.period = exactness.period.max((next - here).abs_diff(FRAME));
                }
            }
        }
        let mut edges = self.uno.edges();
        edges.retain(|edge| self.pins.contains(&edge.pin));
        exactness.pins_high = most_pins_high(&edges);
        Ok(exactness)
    }
}

impl Exactness {
    /// Peak to peak, cycles.
    pub fn jitter(&self) -> u64 {
        self.error[1].abs_diff(self.error[0])
    }

    /// Worst deviation of a width from its command, cycles.
    pub fn worst(&self) -> u64 {
        self.error[0]
            .unsigned_abs()
            .max(self.error[1].unsigned_abs())
    }
}

/// The greatest common divisor.
fn common(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common(b, a % b) }
}

fn dead(what: &str) -> Failure {
    Failure::Impossible(format!("the firmware cannot be measured: {what}"))
}
