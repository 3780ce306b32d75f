//! Test bench that powers on a board with the firmware, talks to it and measures its pulses.
//!
//! A test of the running firmware should read like the actions of a person with a board: `boot`, `say("walk")`, wait
//! some frames, check the pulses. The bench is a [`SimulatedBoard`] with the robot under test. Every error panics,
//! which ends the test.

use std::ops::{Deref, DerefMut};
use std::path::PathBuf;
use std::sync::LazyLock;

use lizard_host::board::{BoardError, SimulatedBoard};
use lizard_host::sim::frame::Frame;
use lizard_robot::Robot;
use simulated_uno::{Call, Fidelity, Image, Uno};

use crate::robots::{robot, root};

/// A simulated UNO with the firmware in flash, as a person at its console sees it. Tests of another robot or program
/// wrap their own board.
pub struct FirmwareBench(pub SimulatedBoard);

impl FirmwareBench {
    /// Returns the path of the firmware's ELF file, which `LIZARD_ELF` can set. The default is the file that
    /// `make firmware` builds.
    ///
    /// The file may contain any robot; [`FirmwareBench::image`] replaces it.
    pub fn elf_path() -> PathBuf {
        let built_elf = root().join("target/avr-atmega328p/release/lizard.elf");
        std::env::var_os("LIZARD_ELF").map_or(built_elf, PathBuf::from)
    }

    /// Returns the firmware's image, with [`robot`] in place of the robot in the file.
    ///
    /// # Panics
    /// If there is no firmware.
    pub fn image() -> Image {
        static IMAGE: LazyLock<Image> = LazyLock::new(|| FirmwareBench::image_with(robot()));
        IMAGE.clone()
    }

    /// Returns the firmware's image, with the given robot in place of the robot in the file.
    ///
    /// # Panics
    /// If there is no firmware.
    pub fn image_with(robot: &Robot) -> Image {
        let path = Self::elf_path();
        lizard_host::firmware::read_with_robot(&path, robot)
            .unwrap_or_else(|error| panic!("{}: {error}; run make firmware", path.display()))
    }

    /// Powers on the board and waits for the banner.
    ///
    /// # Panics
    /// If there is no firmware, or no banner within 500 ms.
    pub fn boot(fidelity: Fidelity) -> Self {
        let board = SimulatedBoard::boot(&Self::elf_path(), fidelity, robot());
        Self(unwrap_or_panic(board))
    }

    /// Powers on the board without running it.
    ///
    /// # Panics
    /// If there is no firmware.
    pub fn power_on(fidelity: Fidelity) -> Self {
        Self(SimulatedBoard::with_image(Self::image(), fidelity, robot()))
    }

    /// Returns a bench around a program that is not the firmware, with servos on the pins of the paper's robot: D9,
    /// D10, D11 and D3.
    pub fn with_uno(uno: Uno) -> Self {
        let pins = [9, 10, 11, 3].map(simulated_uno::Pin::d);
        Self(SimulatedBoard::with_uno(uno, pins))
    }

    /// Sends a line and returns its answer: see [`SimulatedBoard::say`].
    ///
    /// # Panics
    /// If the firmware does not answer.
    pub fn say(&mut self, line: &str) -> String {
        unwrap_or_panic(self.0.say(line))
    }

    /// Sends a line and checks that the answer is `ok` and the line.
    ///
    /// # Panics
    /// If the firmware gives another answer or no answer.
    #[track_caller]
    pub fn expect_ok(&mut self, line: &str) {
        assert_eq!(self.say(line), format!("ok {line}"));
    }

    /// Returns the texts of the printed lines from `first_index` on.
    pub fn texts_from(&mut self, first_index: usize) -> Vec<String> {
        let lines = self.lines()[first_index..].iter();
        lines.map(|line| line.text.clone()).collect()
    }

    /// Returns the text of the last printed line.
    ///
    /// # Panics
    /// If no line was printed.
    pub fn last_text(&mut self) -> String {
        let line = self.lines().last();
        line.expect("the robot has printed a line").text.clone()
    }

    /// Sends a line and returns the `#` lines before its answer, and the answer: see [`SimulatedBoard::ask`].
    ///
    /// # Panics
    /// If the firmware does not answer.
    pub fn ask(&mut self, line: &str) -> (Vec<String>, String) {
        unwrap_or_panic(self.0.ask(line))
    }

    /// Runs the firmware for some milliseconds: see [`SimulatedBoard::run_ms`].
    ///
    /// # Panics
    /// If the firmware crashes, halts or is reset during this time.
    pub fn run_ms(&mut self, ms: u64) {
        unwrap_or_panic(self.0.run_ms(ms));
    }

    /// Runs the firmware for some milliseconds and times every call of a function: see [`SimulatedBoard::time_calls`].
    ///
    /// # Panics
    /// If the ELF has no such function, or more than one.
    pub fn time_calls(&mut self, function: &str, ms: u64) -> Vec<Call> {
        unwrap_or_panic(self.0.time_calls(function, ms))
    }

    /// Runs the firmware for some frames and returns their pulses: see [`SimulatedBoard::run_for_frames`].
    ///
    /// # Panics
    /// If the firmware crashes, halts or is reset during these frames.
    pub fn run_for_frames(&mut self, count: u64) -> Vec<Frame> {
        unwrap_or_panic(self.0.run_for_frames(count))
    }
}

impl Deref for FirmwareBench {
    type Target = SimulatedBoard;

    fn deref(&self) -> &SimulatedBoard {
        &self.0
    }
}

impl DerefMut for FirmwareBench {
    fn deref_mut(&mut self) -> &mut SimulatedBoard {
        &mut self.0
    }
}

fn unwrap_or_panic<T>(result: Result<T, BoardError>) -> T {
    result.unwrap_or_else(|error| panic!("{error}"))
}
