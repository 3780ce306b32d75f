//! The firmware on a bench: power it on, talk to it, measure its pulses.
//!
//! Tests of the running firmware should read like what a person does with a board:
//! `boot`, `say("walk")`, wait some frames, look at the pulses. This is
//! [`SimulatedBoard`] with the robot under test, where a failure ends the test.

use std::ops::{Deref, DerefMut};
use std::path::PathBuf;
use std::sync::LazyLock;

use lizard_host::board::{BoardError, SimulatedBoard};
use lizard_host::sim::frame::Frame;
use lizard_robot::Robot;
use simulated_uno::{Call, Fidelity, Image, Uno};

use crate::robots::{robot, root};

/// A simulated UNO with the firmware in flash and a person at its console.
pub struct FirmwareBench(SimulatedBoard);

impl FirmwareBench {
    /// The firmware that `make firmware` leaves, or what `LIZARD_ELF` names.
    ///
    /// It may have any robot: see [`FirmwareBench::image`].
    pub fn elf() -> PathBuf {
        let built = root().join("target/avr-atmega328p/release/lizard.elf");
        std::env::var_os("LIZARD_ELF").map_or(built, PathBuf::from)
    }

    /// The same image with [`robot`] in it.
    ///
    /// # Panics
    /// If there is no firmware.
    pub fn image() -> Image {
        static IMAGE: LazyLock<Image> = LazyLock::new(|| FirmwareBench::image_with(robot()));
        IMAGE.clone()
    }

    /// The same image with another robot in it.
    ///
    /// # Panics
    /// If there is no firmware.
    pub fn image_with(robot: &Robot) -> Image {
        let elf = Self::elf();
        lizard_host::firmware::with_robot(&elf, robot)
            .unwrap_or_else(|error| panic!("{}: {error}; make firmware", elf.display()))
    }

    /// Powers the board on, by the data sheet, and waits for the banner.
    ///
    /// # Panics
    /// If there is no firmware, or no banner within 500 ms.
    pub fn boot() -> Self {
        Self::boot_with(Fidelity::DataSheet)
    }

    /// [`FirmwareBench::boot`] in a chosen fidelity.
    ///
    /// # Panics
    /// See [`FirmwareBench::boot`].
    pub fn boot_with(fidelity: Fidelity) -> Self {
        let board = SimulatedBoard::boot(&Self::elf(), fidelity, robot());
        Self(done(board))
    }

    /// Powers the board on; not a cycle has passed.
    ///
    /// # Panics
    /// If there is no firmware.
    pub fn power_on(fidelity: Fidelity) -> Self {
        let board = SimulatedBoard::with_image(Self::image(), fidelity, robot());
        Self(board)
    }

    /// A bench around any board, for programs other than the firmware.
    pub fn with_board(board: SimulatedBoard) -> Self {
        Self(board)
    }

    /// See [`SimulatedBoard::say`].
    ///
    /// # Panics
    /// Without an answer.
    pub fn say(&mut self, line: &str) -> String {
        done(self.0.say(line))
    }

    /// See [`SimulatedBoard::ask`].
    ///
    /// # Panics
    /// Without an answer.
    pub fn ask(&mut self, line: &str) -> (Vec<String>, String) {
        done(self.0.ask(line))
    }

    /// See [`SimulatedBoard::run_ms`].
    ///
    /// # Panics
    /// If the firmware crashes, halts or is reset meanwhile.
    pub fn run_ms(&mut self, ms: u64) {
        done(self.0.run_ms(ms));
    }

    /// See [`SimulatedBoard::time_calls`].
    ///
    /// # Panics
    /// If the ELF has no such function, or more than one.
    pub fn time_calls(&mut self, function: &str, ms: u64) -> Vec<Call> {
        done(self.0.time_calls(function, ms))
    }

    /// See [`SimulatedBoard::run_for_frames`].
    ///
    /// # Panics
    /// If the firmware crashes, halts or is reset meanwhile.
    pub fn run_for_frames(&mut self, count: u64) -> Vec<Frame> {
        done(self.0.run_for_frames(count))
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

fn done<T>(result: Result<T, BoardError>) -> T {
    result.unwrap_or_else(|error| panic!("{error}"))
}

/// A bench around a program that is not the firmware, its servos on the pins of
/// the paper's robot: D9, D10, D11 and D3.
pub fn bench_of(uno: Uno) -> FirmwareBench {
    let pins = [9, 10, 11, 3].map(simulated_uno::Pin::d);
    FirmwareBench::with_board(SimulatedBoard::with_uno(uno, pins))
}
