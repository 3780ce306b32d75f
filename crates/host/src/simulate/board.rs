//! A simulated UNO with a serial cable and an oscilloscope: switch its power on, send lines, read answers, measure the
//! servos' pulses.

use std::path::Path;

use lizard_robot::Robot;
use simulated_uno::{CYCLES_PER_MS, Call, Fidelity, Image, Pin, SerialByte, State, Uno};

use crate::Failure;
use crate::shared::firmware;
use crate::simulate::sim::frame::{
    FRAME_CYCLES, Frame, first_cycle, group_frames, latest_frame_start, next_start, servo_pins,
};
use crate::simulate::sim::lines::{Line, LineReader};
use crate::simulate::sim::supplies;

/// Longest wait for an answer after a command was sent, ms. The firmware answers much sooner.
const ANSWER_TIMEOUT_MS: u64 = 200;
/// Longest wait for the banner after power-on, ms.
const BANNER_TIMEOUT_MS: u64 = 500;
/// Cycles of the UNO per byte on the serial line, rounded up.
const CYCLES_PER_BYTE: u64 = 1400;

/// An error in an operation on a simulated board.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// The firmware cannot be loaded.
    #[error(transparent)]
    Load(#[from] Failure),
    /// The first line is not the firmware's banner.
    #[error(
        "expected the banner `# lizard ...` within {BANNER_TIMEOUT_MS} ms of power-on, got {0:?}"
    )]
    NoBanner(Option<String>),
    /// A command was not answered in time.
    #[error("no answer to {line:?} within {ANSWER_TIMEOUT_MS} ms, received {notes:?}")]
    NoAnswer {
        /// The command that was sent.
        line: String,
        /// The `#` lines received instead.
        notes: Vec<String>,
    },
    /// The firmware sleeps with interrupts off.
    #[error("the firmware sleeps with interrupts off, forever")]
    Halted,
    /// The firmware ran into an invalid address.
    #[error("the firmware crashed: {0}")]
    Crashed(String),
    /// The board has no power.
    #[error("the board has no power")]
    Off,
    /// The watchdog fired.
    #[error("the watchdog reset the firmware")]
    Reset,
    /// The ELF has no function with this name, or more than one.
    #[error("the ELF must contain exactly one function {0}")]
    UnresolvedFunction(String),
    /// A counter is missing from the answer to `status`.
    #[error("{key} is missing from `{status}`")]
    MissingCounter {
        /// The answer to `status`.
        status: String,
        /// The name of the counter.
        key: String,
    },
    /// Servo A1 gets no pulse.
    #[error("A1 gets no pulse")]
    NoPulse,
}

impl From<BoardError> for Failure {
    fn from(error: BoardError) -> Self {
        match error {
            BoardError::Load(failure) => failure,
            _ => Self::Operation(format!("cannot measure the firmware: {error}")),
        }
    }
}

/// A simulated UNO with a firmware in its flash.
pub struct SimulatedBoard {
    /// The UNO. Read its transmitted bytes only through [`SimulatedBoard::lines`] and [`SimulatedBoard::bytes`].
    pub uno: Uno,
    /// The pins of the servos A1 to A4.
    pins: [Pin; 4],
    reader: LineReader,
    /// Every byte that the firmware has sent since power-on.
    bytes: Vec<SerialByte>,
    /// Every line that the firmware has sent since power-on.
    lines: Vec<Line>,
    /// Number of lines that [`SimulatedBoard::next_line`] has returned so far.
    returned_line_count: usize,
    /// The start cycle of one frame; the other frames start a multiple of 20 ms before or after it. `None` while no
    /// pulse is known.
    frame_anchor: Option<u64>,
}

impl SimulatedBoard {
    /// Powers on a robot's board with healthy supplies; no cycle has run yet.
    ///
    /// # Errors
    /// Fails if the ELF file is missing or invalid.
    pub fn power_on(elf: &Path, fidelity: Fidelity, robot: &Robot) -> Result<Self, BoardError> {
        let image = firmware::read_with_robot(elf, robot)?;
        Ok(Self::with_image(image, fidelity, robot))
    }

    /// Powers on a board with an image that already contains the robot.
    pub fn with_image(image: Image, fidelity: Fidelity, robot: &Robot) -> Self {
        let mut uno = Uno::with_image(image, fidelity);
        supplies::connect_healthy_robot(&mut uno, robot);
        Self::with_uno(uno, servo_pins(robot))
    }

    /// Powers on a board and waits for the lizard's banner.
    ///
    /// # Errors
    /// Fails as [`SimulatedBoard::power_on`] does, or if the banner is not the first line within 500 ms.
    pub fn boot(elf: &Path, fidelity: Fidelity, robot: &Robot) -> Result<Self, BoardError> {
        let mut board = Self::power_on(elf, fidelity, robot)?;
        match board.next_line(BANNER_TIMEOUT_MS) {
            Some(line) if line.starts_with("# lizard") => Ok(board),
            line => Err(BoardError::NoBanner(line)),
        }
    }

    /// Creates a board with a given UNO. `pins` are the pins of the servos A1 to A4.
    pub fn with_uno(uno: Uno, pins: [Pin; 4]) -> Self {
        Self {
            uno,
            pins,
            reader: LineReader::default(),
            bytes: Vec::new(),
            lines: Vec::new(),
            returned_line_count: 0,
            frame_anchor: None,
        }
    }

    /// Returns the pins of the servos A1 to A4.
    pub fn pins(&self) -> [Pin; 4] {
        self.pins
    }

    /// Sends a line and returns its answer, the first line without `#`. The `#` lines before the answer are in
    /// [`SimulatedBoard::lines`].
    ///
    /// # Errors
    /// Fails if no answer arrives within 200 ms after the line was sent.
    pub fn say(&mut self, line: &str) -> Result<String, BoardError> {
        Ok(self.ask(line)?.1)
    }

    /// Sends a line; returns the `#` lines before the answer and the answer.
    ///
    /// # Errors
    /// See [`SimulatedBoard::say`].
    pub fn ask(&mut self, line: &str) -> Result<(Vec<String>, String), BoardError> {
        self.returned_line_count = self.lines().len();
        self.send(line);
        let mut notes = Vec::new();
        while let Some(answer) = self.next_line(ANSWER_TIMEOUT_MS) {
            if !answer.starts_with('#') {
                return Ok((notes, answer));
            }
            notes.push(answer);
        }
        let line = line.to_owned();
        Err(BoardError::NoAnswer { line, notes })
    }

    /// Sends a line and a line feed, without waiting for the answer.
    pub fn send(&mut self, line: &str) {
        self.uno.send(line.as_bytes());
        self.uno.send(b"\n");
    }

    /// Runs the board until the next line and returns the line without its line end; `None` if no line arrives within
    /// `timeout_ms` after all queued bytes have been sent to the UNO, or if the firmware stops.
    pub fn next_line(&mut self, timeout_ms: u64) -> Option<String> {
        let cycles_to_send = self.uno.unsent_byte_count() as u64 * CYCLES_PER_BYTE;
        let end_cycle = self.uno.cycle() + cycles_to_send + timeout_ms * CYCLES_PER_MS;
        loop {
            let index = self.returned_line_count;
            if let Some(line) = self.lines().get(index) {
                let text = line.text.clone();
                self.returned_line_count += 1;
                return Some(text);
            }
            if self.uno.cycle() >= end_cycle || *self.uno.state() != State::Alive {
                return None;
            }
            self.uno.run_until_line(end_cycle - self.uno.cycle());
        }
    }

    /// Returns every line that the firmware has sent since power-on.
    pub fn lines(&mut self) -> &[Line] {
        self.collect_output();
        &self.lines
    }

    /// Returns every byte that the firmware has sent since power-on.
    pub fn bytes(&mut self) -> &[SerialByte] {
        self.collect_output();
        &self.bytes
    }

    /// Adds the UNO's output since the previous call to the fields `bytes` and `lines`.
    fn collect_output(&mut self) {
        let bytes = self.uno.take_transmitted();
        self.lines.extend(self.reader.read(&bytes));
        self.bytes.extend(bytes);
    }

    /// Reads a counter from the answer to `status`.
    ///
    /// # Errors
    /// Fails as [`SimulatedBoard::say`] does, or if the counter is missing.
    pub fn read_counter(&mut self, key: &str) -> Result<u64, BoardError> {
        let status = self.say("status")?;
        let value = status.split(' ').find_map(|pair| {
            let (name, value) = pair.split_once('=')?;
            (name == key).then(|| value.parse().ok())?
        });
        let key = key.to_owned();
        value.ok_or(BoardError::MissingCounter { status, key })
    }

    /// Runs the board for `ms` of simulated time.
    ///
    /// # Errors
    /// Fails if the firmware crashes, halts or is reset, or if the power is off.
    pub fn run_ms(&mut self, ms: u64) -> Result<(), BoardError> {
        self.run_until(self.uno.cycle() + ms * CYCLES_PER_MS)
    }

    /// Runs the board until `cycle`.
    fn run_until(&mut self, cycle: u64) -> Result<(), BoardError> {
        let resets_before = self.uno.watchdog_reset_count();
        match self.uno.run_until_cycle(cycle) {
            State::Alive => {}
            State::Halted => return Err(BoardError::Halted),
            State::Crashed { message, .. } => return Err(BoardError::Crashed(message.clone())),
            State::Off => return Err(BoardError::Off),
        }
        if self.uno.watchdog_reset_count() == resets_before {
            Ok(())
        } else {
            Err(BoardError::Reset)
        }
    }

    /// Runs the board for `ms` and times every call of a firmware function. `function` is the function's path, such as
    /// `Controller::compute_frame`.
    ///
    /// # Errors
    /// Fails unless the ELF has exactly one such function.
    pub fn time_calls(&mut self, function: &str, ms: u64) -> Result<Vec<Call>, BoardError> {
        let symbol = self.uno.image().function(function);
        let symbol = symbol.ok_or_else(|| BoardError::UnresolvedFunction(function.to_owned()))?;
        let entry = symbol.address as u32;
        Ok(self.uno.time_calls(entry, ms * CYCLES_PER_MS))
    }

    /// Returns the cycles spent so far in the handlers of the vectors that `is_counted` accepts.
    pub fn handler_cycles(&self, is_counted: impl Fn(u8) -> bool) -> u64 {
        let mut interrupts = self.uno.interrupt_stats();
        interrupts.retain(|interrupt| is_counted(interrupt.vector));
        interrupts.iter().map(|interrupt| interrupt.cycles).sum()
    }

    /// Returns the start cycle of A1's first pulse in the recorded edges.
    ///
    /// # Errors
    /// Fails if the recorded edges contain no A1 pulse.
    pub fn first_pulse_cycle(&self) -> Result<u64, BoardError> {
        let pulses = self.uno.pulses(self.pins[0]);
        let first_start = pulses.first().map(|pulse| pulse.start);
        first_start.ok_or(BoardError::NoPulse)
    }

    /// Runs `count` complete frames, starting with the next frame, and returns their pulses. Frames are aligned to A1's
    /// latest pulse, or to the current cycle if there is no pulse. Edges recorded before these frames are dropped.
    ///
    /// # Errors
    /// See [`SimulatedBoard::run_ms`].
    pub fn run_for_frames(&mut self, count: u64) -> Result<Vec<Frame>, BoardError> {
        let current_cycle = self.uno.cycle();
        self.frame_anchor =
            latest_frame_start(&self.uno.edges(), self.pins[0]).or(self.frame_anchor);
        let start = match self.frame_anchor {
            Some(anchor) => next_start(anchor, current_cycle),
            None => current_cycle + FRAME_CYCLES,
        };
        self.run_until(first_cycle(start))?;
        self.uno.take_edges();
        self.run_until(first_cycle(start + count * FRAME_CYCLES))?;
        Ok(group_frames(&self.uno.edges(), self.pins, start, count))
    }
}
