//! The firmware on a bench: power it on, talk to it, measure its pulses.
//!
//! Tests on the running firmware should read as what a person does with a
//! board: `boot`, `say("walk")`, wait some frames, look at the pulses.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use lizard_host::sim::console::{Console, Line};
use lizard_host::sim::frame::{FRAME, Frame, frames, latest_start, next_start, opens, servo_pins};
use lizard_robot::Robot;
use simulated_uno::{CYCLES_PER_MS, Call, Fidelity, SerialByte, State, Uno};

/// The longest wait for an answer, ms. The console promises much less.
const PATIENCE_MS: u64 = 200;
/// Cycles that a byte of a sender takes, rounded up.
const BYTE_CYCLES: u64 = 1400;

/// The robot of this repository's robot.toml.
///
/// # Panics
/// If robot.toml is wrong, with its words.
#[must_use]
pub fn robot() -> &'static Robot {
    static ROBOT: LazyLock<Robot> = LazyLock::new(|| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robot.toml");
        Robot::load(path).unwrap_or_else(|error| panic!("{error}"))
    });
    &ROBOT
}

/// A simulated UNO with the firmware in flash and a person at its console.
pub struct FirmwareBench {
    /// The board, for all that the bench has no word for. Take its received
    /// bytes and its edges through the bench only.
    pub uno: Uno,
    console: Console,
    unread: usize,
    anchor: Option<u64>,
}

impl FirmwareBench {
    /// The firmware that `make firmware` leaves, or what `LIZARD_ELF` names.
    #[must_use]
    pub fn elf() -> PathBuf {
        let built = "../target/avr-atmega328p/release/lizard.elf";
        std::env::var_os("LIZARD_ELF").map_or_else(
            || Path::new(env!("CARGO_MANIFEST_DIR")).join(built),
            PathBuf::from,
        )
    }

    /// Powers the board on, by the data sheet, and waits for the banner.
    ///
    /// # Panics
    /// If there is no firmware, or no banner within 500 ms.
    #[must_use]
    pub fn boot() -> Self {
        Self::boot_with(Fidelity::DataSheet)
    }

    /// [`FirmwareBench::boot`] in a chosen fidelity.
    ///
    /// # Panics
    /// See [`FirmwareBench::boot`].
    #[must_use]
    pub fn boot_with(fidelity: Fidelity) -> Self {
        let mut bench = Self::power_on(fidelity);
        let line = bench.next_line(500);
        let line = line.expect("a banner within 500 ms of power-on");
        assert!(
            line.starts_with("# lizard"),
            "the first line is the banner, not {line:?}"
        );
        bench
    }

    /// Powers the board on; not a cycle has passed.
    ///
    /// # Panics
    /// If there is no firmware.
    #[must_use]
    pub fn power_on(fidelity: Fidelity) -> Self {
        let elf = Self::elf();
        match Uno::load(&elf, fidelity) {
            Ok(uno) => Self::with_board(uno),
            Err(error) => panic!("{error}; `make firmware` builds it"),
        }
    }

    /// A bench around any board, for programs other than the firmware.
    #[must_use]
    pub fn with_board(uno: Uno) -> Self {
        Self {
            uno,
            console: Console::default(),
            unread: 0,
            anchor: None,
        }
    }

    /// Sends a line and returns its answer, the first line that is not
    /// information. What came before is in [`Self::lines`].
    ///
    /// # Panics
    /// If no answer comes within 200 ms after the line has been sent.
    pub fn say(&mut self, line: &str) -> String {
        self.ask(line).1
    }

    /// Sends a line; returns the `#` lines that came first, and the answer.
    ///
    /// # Panics
    /// See [`Self::say`].
    pub fn ask(&mut self, line: &str) -> (Vec<String>, String) {
        self.unread = self.lines().len();
        self.send(line);
        let mut notes = Vec::new();
        while let Some(answer) = self.next_line(PATIENCE_MS) {
            if !answer.starts_with('#') {
                return (notes, answer);
            }
            notes.push(answer);
        }
        panic!("no answer to {line:?} within {PATIENCE_MS} ms, only {notes:?}")
    }

    /// Sends a line and a line feed, and does not wait.
    pub fn send(&mut self, line: &str) {
        self.uno.send(line.as_bytes());
        self.uno.send(b"\n");
    }

    /// The next line not yet returned, waited for at most `ms` beyond the time
    /// the sender needs. Line ends are gone.
    pub fn next_line(&mut self, ms: u64) -> Option<String> {
        let sending = self.uno.unsent() as u64 * BYTE_CYCLES;
        let end = self.uno.cycle() + sending + ms * CYCLES_PER_MS;
        loop {
            let unread = self.unread;
            if let Some(line) = self.lines().get(unread) {
                let text = line.text.clone();
                self.unread += 1;
                return Some(text);
            }
            if self.uno.cycle() >= end || *self.uno.state() != State::Alive {
                return None;
            }
            self.uno.run_until_line(end - self.uno.cycle());
        }
    }

    /// Every line the firmware has sent since power-on.
    pub fn lines(&mut self) -> &[Line] {
        self.console.collect(&mut self.uno);
        self.console.lines()
    }

    /// Every byte the firmware has sent since power-on.
    pub fn bytes(&mut self) -> &[SerialByte] {
        self.console.collect(&mut self.uno);
        self.console.bytes()
    }

    /// Lets time pass.
    ///
    /// # Panics
    /// If the firmware crashes, halts or is reset meanwhile.
    pub fn run_ms(&mut self, ms: u64) {
        self.run_until(self.uno.cycle() + ms * CYCLES_PER_MS);
    }

    /// Lets time pass and times every call of a function of the firmware, named
    /// as in `Console::frame`.
    ///
    /// # Panics
    /// If the ELF has no such function, or more than one.
    pub fn time_calls(&mut self, function: &str, ms: u64) -> Vec<Call> {
        let symbol = self.uno.image().function(function);
        let symbol = symbol.unwrap_or_else(|| panic!("the ELF has no one function {function}"));
        let entry = symbol.address as u32;
        self.uno.time_calls(entry, ms * CYCLES_PER_MS)
    }

    fn run_until(&mut self, cycle: u64) {
        let resets = self.uno.resets();
        let state = self.uno.run_until_cycle(cycle);
        assert_eq!(*state, State::Alive, "the firmware stopped");
        assert_eq!(self.uno.resets(), resets, "the watchdog reset the firmware");
    }

    /// Lets `count` whole frames pass, starting with the next, and returns
    /// their pulses. Frames are counted from A1's latest pulse on; before
    /// there has been one, from now.
    ///
    /// # Panics
    /// If the firmware crashes, halts or is reset meanwhile.
    pub fn run_for_frames(&mut self, count: u64) -> Vec<Frame> {
        let pins = servo_pins(robot());
        let now = self.uno.cycle();
        self.anchor = latest_start(&self.uno.edges(), pins).or(self.anchor);
        let start = self
            .anchor
            .map_or(now + FRAME, |anchor| next_start(anchor, now));
        self.run_until(opens(start));
        self.uno.take_edges();
        self.run_until(opens(start + count * FRAME));
        frames(&self.uno.edges(), pins, start, count)
    }
}
