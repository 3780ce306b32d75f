//! A simulated UNO, used as if through a serial cable and an oscilloscope: power it on, send
//! lines, read answers, measure the servos' pulses.

use std::path::Path;

use lizard_robot::Robot;
use simulated_uno::{CYCLES_PER_MS, Call, Fidelity, Image, Pin, SerialByte, State, Uno};

use crate::Failure;
use crate::shared::firmware;
use crate::simulate::sim::frame::{
    FRAME, Frame, first_cycle, group_frames, latest_start, next_start, servo_pins,
};
use crate::simulate::sim::lines::{Line, LineReader};
use crate::simulate::sim::supplies;

/// The longest wait for an answer after its command has been sent, ms. The
/// firmware's console promises a much shorter time.
const TIMEOUT_MS: u64 = 200;
/// The longest wait for the banner after power-on, ms.
pub(crate) const BANNER_MS: u64 = 500;
/// Cycles of the UNO that a byte takes on the serial line, rounded up.
const BYTE_CYCLES: u64 = 1400;

/// The reason why a board did not do what a test asked for.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// The firmware cannot be loaded.
    #[error(transparent)]
    Load(#[from] firmware::Unreadable),
    /// The first line is not the firmware's banner.
    #[error("no banner `# lizard ...` within {BANNER_MS} ms of power-on, but {0:?}")]
    Banner(Option<String>),
    /// A command was not answered.
    #[error("no answer to {line:?} within {TIMEOUT_MS} ms, only {notes:?}")]
    Silent {
        /// The command that was sent.
        line: String,
        /// The information lines received instead.
        notes: Vec<String>,
    },
    /// The firmware sleeps with interrupts off.
    #[error("the firmware sleeps with interrupts off, forever")]
    Halted,
    /// The firmware ran into an invalid address.
    #[error("the firmware crashed: {0}")]
    Crashed(String),
    /// The power has been cut.
    #[error("the board has no power")]
    Off,
    /// The watchdog fired.
    #[error("the watchdog reset the firmware")]
    Reset,
    /// The ELF has no function of this name, or more than one.
    #[error("the ELF has no one function {0}")]
    Function(String),
    /// A line of `status` lacks a counter.
    #[error("`{status}` has no {key}")]
    Counter {
        /// The answer to `status`.
        status: String,
        /// The name of the counter.
        key: String,
    },
    /// The first servo gets no pulse.
    #[error("A1 gets no pulse")]
    NoPulse,
}

impl From<BoardError> for Failure {
    fn from(error: BoardError) -> Self {
        match error {
            BoardError::Load(_) => Self::Input(error.to_string()),
            _ => Self::Impossible(format!("the firmware cannot be measured: {error}")),
        }
    }
}

/// A simulated UNO with a firmware in its flash.
pub struct SimulatedBoard {
    /// The UNO. Take its transmitted bytes through the board only.
    pub uno: Uno,
    pins: [Pin; 4],
    reader: LineReader,
    bytes: Vec<SerialByte>,
    lines: Vec<Line>,
    /// Number of lines that [`SimulatedBoard::next_line`] has returned.
    returned_lines: usize,
    /// The cycle at which a frame starts, from which the starts of the other frames are counted; `None` while
    /// no pulse is known.
    anchor: Option<u64>,
}

impl SimulatedBoard {
    /// Powers on a robot's board with healthy supplies; no cycle has run yet.
    ///
    /// # Errors
    /// Fails if the ELF file is missing or wrong.
    pub fn power_on(elf: &Path, fidelity: Fidelity, robot: &Robot) -> Result<Self, BoardError> {
        let image = firmware::with_robot(elf, robot)?;
        Ok(Self::with_image(image, fidelity, robot))
    }

    /// Powers on a board with an image that contains the robot already.
    pub fn with_image(image: Image, fidelity: Fidelity, robot: &Robot) -> Self {
        let mut uno = Uno::with_image(image, fidelity);
        supplies::connect(&mut uno, robot);
        Self::with_uno(uno, servo_pins(robot))
    }

    /// Powers a board on and waits for the lizard's banner.
    ///
    /// # Errors
    /// Fails as [`SimulatedBoard::power_on`] does, or if the first line within 500 ms is no banner.
    pub fn boot(elf: &Path, fidelity: Fidelity, robot: &Robot) -> Result<Self, BoardError> {
        let mut board = Self::power_on(elf, fidelity, robot)?;
        match board.next_line(BANNER_MS) {
            Some(line) if line.starts_with("# lizard") => Ok(board),
            line => Err(BoardError::Banner(line)),
        }
    }

    /// Wraps any simulated UNO. `pins` are those of the servos A1 to A4.
    pub fn with_uno(uno: Uno, pins: [Pin; 4]) -> Self {
        Self {
            uno,
            pins,
            reader: LineReader::default(),
            bytes: Vec::new(),
            lines: Vec::new(),
            returned_lines: 0,
            anchor: None,
        }
    }

    /// The pins of the servos A1 to A4.
    pub fn pins(&self) -> [Pin; 4] {
        self.pins
    }

    /// Sends a line and returns its answer, the first line without `#`. The
    /// `#` lines before it are in [`SimulatedBoard::lines`].
    ///
    /// # Errors
    /// Fails if there is no answer within 200 ms after the line has been sent.
    pub fn say(&mut self, line: &str) -> Result<String, BoardError> {
        Ok(self.ask(line)?.1)
    }

    /// Sends a line; returns the `#` lines before the answer, and the answer.
    ///
    /// # Errors
    /// See [`SimulatedBoard::say`].
    pub fn ask(&mut self, line: &str) -> Result<(Vec<String>, String), BoardError> {
        self.returned_lines = self.lines().len();
        self.send(line);
        let mut notes = Vec::new();
        while let Some(answer) = self.next_line(TIMEOUT_MS) {
            if !answer.starts_with('#') {
                return Ok((notes, answer));
            }
            notes.push(answer);
        }
        let line = line.to_owned();
        Err(BoardError::Silent { line, notes })
    }

    /// Sends a line and a line feed, without waiting for the answer.
    pub fn send(&mut self, line: &str) {
        self.uno.send(line.as_bytes());
        self.uno.send(b"\n");
    }

    /// Returns the next line without its line end; `None` if it does not come
    /// within `ms` after the bytes still to be sent, or if the firmware stops.
    pub fn next_line(&mut self, ms: u64) -> Option<String> {
        let sending_cycles = self.uno.unsent() as u64 * BYTE_CYCLES;
        let end_cycle = self.uno.cycle() + sending_cycles + ms * CYCLES_PER_MS;
        loop {
            let index = self.returned_lines;
            if let Some(line) = self.lines().get(index) {
                let text = line.text.clone();
                self.returned_lines += 1;
                return Some(text);
            }
            if self.uno.cycle() >= end_cycle || *self.uno.state() != State::Alive {
                return None;
            }
            self.uno.run_until_line(end_cycle - self.uno.cycle());
        }
    }

    /// Every line the firmware has sent since power-on.
    pub fn lines(&mut self) -> &[Line] {
        self.collect();
        &self.lines
    }

    /// Every byte the firmware has sent since power-on.
    pub fn bytes(&mut self) -> &[SerialByte] {
        self.collect();
        &self.bytes
    }

    /// Adds what the UNO has transmitted since the last call to the bytes and the lines.
    fn collect(&mut self) {
        let bytes = self.uno.take_transmitted();
        self.lines.extend(self.reader.read(&bytes));
        self.bytes.extend(bytes);
    }

    /// Asks for `status` and returns one of its counters.
    ///
    /// # Errors
    /// Fails as [`SimulatedBoard::say`] does, or if `status` has no such number.
    pub fn read_counter(&mut self, key: &str) -> Result<u64, BoardError> {
        let status = self.say("status")?;
        let value = status.split(' ').find_map(|pair| {
            let (name, value) = pair.split_once('=')?;
            (name == key).then(|| value.parse().ok())?
        });
        let key = key.to_owned();
        value.ok_or(BoardError::Counter { status, key })
    }

    /// Runs the board for `ms` of simulated time.
    ///
    /// # Errors
    /// Fails if the firmware crashes, halts or is reset, or the power is off.
    pub fn run_ms(&mut self, ms: u64) -> Result<(), BoardError> {
        self.run_until(self.uno.cycle() + ms * CYCLES_PER_MS)
    }

    /// Runs the board until a cycle.
    fn run_until(&mut self, cycle: u64) -> Result<(), BoardError> {
        let resets_before = self.uno.watchdog_resets();
        match self.uno.run_until_cycle(cycle) {
            State::Alive => {}
            State::Halted => return Err(BoardError::Halted),
            State::Crashed { message, .. } => return Err(BoardError::Crashed(message.clone())),
            State::Off => return Err(BoardError::Off),
        }
        if self.uno.watchdog_resets() == resets_before {
            Ok(())
        } else {
            Err(BoardError::Reset)
        }
    }

    /// Runs the board for `ms` and times every call of a firmware function,
    /// given by its path, such as `Control::frame`.
    ///
    /// # Errors
    /// Fails if the ELF has no such function, or more than one.
    pub fn time_calls(&mut self, function: &str, ms: u64) -> Result<Vec<Call>, BoardError> {
        let symbol = self.uno.image().function(function);
        let symbol = symbol.ok_or_else(|| BoardError::Function(function.to_owned()))?;
        let entry = symbol.address as u32;
        Ok(self.uno.time_calls(entry, ms * CYCLES_PER_MS))
    }

    /// The cycles spent so far in the handlers of the vectors that `is_counted` accepts.
    pub fn handler_cycles(&self, is_counted: impl Fn(u8) -> bool) -> u64 {
        let interrupts = self.uno.interrupts();
        let counted_interrupts = interrupts
            .iter()
            .filter(|interrupt| is_counted(interrupt.vector));
        counted_interrupts.map(|interrupt| interrupt.cycles).sum()
    }

    /// The cycle at which A1's first pulse starts, among the edges not yet taken.
    ///
    /// # Errors
    /// Fails if A1 has no pulse among these edges.
    pub fn first_pulse(&self) -> Result<u64, BoardError> {
        let pulses = self.uno.pulses(self.pins[0]);
        let first = pulses.first().map(|pulse| pulse.start);
        first.ok_or(BoardError::NoPulse)
    }

    /// Runs `count` whole frames, starting with the next, and returns their
    /// pulses. Frames are aligned to A1's latest pulse or, if there was none,
    /// to the present cycle. Edges recorded earlier are dropped.
    ///
    /// # Errors
    /// See [`SimulatedBoard::run_ms`].
    pub fn run_for_frames(&mut self, count: u64) -> Result<Vec<Frame>, BoardError> {
        let current_cycle = self.uno.cycle();
        self.anchor = latest_start(&self.uno.edges(), self.pins).or(self.anchor);
        let start = self.anchor.map_or(current_cycle + FRAME, |anchor| {
            next_start(anchor, current_cycle)
        });
        self.run_until(first_cycle(start))?;
        self.uno.take_edges();
        self.run_until(first_cycle(start + count * FRAME))?;
        Ok(group_frames(&self.uno.edges(), self.pins, start, count))
    }
}
