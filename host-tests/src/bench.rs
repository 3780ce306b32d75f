//! The firmware on a bench: power it on, talk to it, measure its pulses.
//!
//! Tests on the running firmware should read as what a person does with a
//! board: `boot`, `say("walk")`, wait some frames, look at the pulses.

use std::path::{Path, PathBuf};

use simulated_uno::{CYCLES_PER_MS, Fidelity, Pin, SerialByte, State, Uno, pulses};

/// Pins of the servos A1 (front left), A2 (front right), A3 (back right) and
/// A4 (back left), the order of every array of four here.
pub const SERVO_PINS: [Pin; 4] = [Pin::d(9), Pin::d(10), Pin::d(11), Pin::d(3)];
/// Cycles from a pulse of a servo to its next: 20 ms.
pub const FRAME: u64 = 20 * CYCLES_PER_MS;

/// Cycles between two servos' pulses.
const SLOT: u64 = FRAME / 5;
/// The longest wait for an answer, ms. The console promises much less.
const PATIENCE_MS: u64 = 200;

/// The servo pulses of one 20 ms frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    /// Cycle at which A1's pulse of this frame starts, or would.
    pub start: u64,
    /// Width in cycles (62.5 ns) of each servo's pulse, `None` without one.
    pub widths: [Option<u64>; 4],
    /// Cycle at which each pulse starts.
    pub starts: [Option<u64>; 4],
}

impl Frame {
    /// The four widths, if all four servos have a pulse.
    #[must_use]
    pub fn all(&self) -> Option<[u64; 4]> {
        let [a1, a2, a3, a4] = self.widths;
        Some([a1?, a2?, a3?, a4?])
    }

    /// The four widths in cycles.
    ///
    /// # Panics
    /// If a servo has no pulse in this frame.
    #[must_use]
    pub fn widths(&self) -> [u64; 4] {
        self.all()
            .unwrap_or_else(|| panic!("a servo has no pulse: {self:?}"))
    }

    /// Whether no servo has a pulse: the robot rests.
    #[must_use]
    pub fn is_silent(&self) -> bool {
        self.widths == [None; 4]
    }
}

/// A simulated UNO with the firmware in flash and a person at its console.
pub struct FirmwareBench {
    /// The board, for all that the bench has no word for.
    pub uno: Uno,
    bytes: Vec<SerialByte>,
    lines: Vec<(u64, String)>,
    partial: String,
    unread: usize,
    anchor: Option<u64>,
}

impl FirmwareBench {
    /// The firmware that `make firmware` leaves, or what `LIZARD_ELF` names.
    #[must_use]
    pub fn elf() -> PathBuf {
        std::env::var_os("LIZARD_ELF").map_or_else(
            || {
                Path::new(env!("CARGO_MANIFEST_DIR"))
                    .join("../target/avr-atmega328p/release/lizard.elf")
            },
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
            bytes: Vec::new(),
            lines: Vec::new(),
            partial: String::new(),
            unread: 0,
            anchor: None,
        }
    }

    /// Sends a line and returns its answer, the line that begins with `ok` or
    /// `err`. Lines of information before it are kept in [`Self::lines`].
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
        self.collect();
        self.unread = self.lines.len();
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
    /// the sender needs. Line endings are gone.
    pub fn next_line(&mut self, ms: u64) -> Option<String> {
        let sending = self.uno.unsent() as u64 * 1400;
        let end = self.uno.cycle() + sending + ms * CYCLES_PER_MS;
        loop {
            self.collect();
            if let Some((_, line)) = self.lines.get(self.unread) {
                self.unread += 1;
                return Some(line.clone());
            }
            if self.uno.cycle() >= end || *self.uno.state() != State::Alive {
                return None;
            }
            self.uno.run_until_line(end - self.uno.cycle());
        }
    }

    /// Every line the firmware has sent since power-on, with the cycle at which
    /// it ended.
    pub fn lines(&mut self) -> &[(u64, String)] {
        self.collect();
        &self.lines
    }

    /// Every byte the firmware has sent since power-on.
    pub fn bytes(&mut self) -> &[SerialByte] {
        self.collect();
        &self.bytes
    }

    fn collect(&mut self) {
        for byte in self.uno.take_received() {
            self.bytes.push(byte);
            match byte.byte {
                b'\n' => self
                    .lines
                    .push((byte.cycle, std::mem::take(&mut self.partial))),
                b'\r' => {}
                other => self.partial.push(char::from(other)),
            }
        }
    }

    /// Lets time pass.
    ///
    /// # Panics
    /// If the firmware crashes, halts or is reset meanwhile.
    pub fn run_ms(&mut self, ms: u64) {
        self.run_until(self.uno.cycle() + ms * CYCLES_PER_MS);
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
        self.find_anchor();
        let now = self.uno.cycle();
        let anchor = self.anchor.unwrap_or(now + SLOT / 2);
        // The first frame whose A1 pulse cannot have begun yet.
        let next = anchor + (now + SLOT / 2).saturating_sub(anchor).div_ceil(FRAME) * FRAME;
        let first = next - SLOT / 2;
        self.run_until(first);
        self.uno.take_edges();
        self.run_until(first + count * FRAME);
        let frames = self.frames(next, count);
        self.find_anchor();
        frames
    }

    /// Cuts the recorded edges into frames; the first begins at cycle `start`.
    fn frames(&self, start: u64, count: u64) -> Vec<Frame> {
        let mut frames: Vec<Frame> = (0..count)
            .map(|n| Frame {
                start: start + n * FRAME,
                widths: [None; 4],
                starts: [None; 4],
            })
            .collect();
        let edges = self.uno.edges();
        for (servo, pin) in SERVO_PINS.iter().enumerate() {
            for pulse in pulses(&edges, *pin) {
                let frame = (pulse.start + SLOT / 2 - start) / FRAME;
                if let Some(frame) = frames.get_mut(frame as usize) {
                    frame.widths[servo] = Some(pulse.width);
                    frame.starts[servo] = Some(pulse.start);
                }
            }
        }
        frames
    }

    fn find_anchor(&mut self) {
        let edges = self.uno.edges();
        let rises = edges
            .iter()
            .filter(|edge| edge.high && edge.pin == SERVO_PINS[0]);
        self.anchor = rises.map(|edge| edge.cycle).next_back().or(self.anchor);
    }
}
