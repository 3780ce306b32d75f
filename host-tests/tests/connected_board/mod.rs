//! A new board on a serial port of this machine, for tests of programs that write firmware to boards. The board is
//! simulated in real time on a pseudo terminal. Its flash contains the boot loader of a stock UNO or of an old Nano.

use std::path::PathBuf;
use std::time::Duration;

use lizard_host_tests::root;
use lizard_time_limit::TIME_LIMIT;
use simulated_uno::{Edge, Fidelity, Image, Port, Uno};

use crate::shell::Shell;

/// The address of the first byte of a UNO's boot loader. The firmware must end before this address.
pub const BOOT_LOADER_START: usize = 0x7e00;

/// Loads the boot loader of a stock UNO.
pub fn load_uno_boot_loader() -> Image {
    load_boot_loader("optiboot.elf")
}

/// Loads a boot loader that `make flash-test` has built.
pub fn load_boot_loader(name: &str) -> Image {
    let path: PathBuf = root().join("target/flash-test").join(name);
    Image::read(path).expect("`make flash-test` has built the boot loader")
}

/// A simulated board on a serial port of this machine, and the edges of its pins.
pub struct ConnectedBoard {
    pub uno: Uno,
    pub port: Port,
    pub edges: Vec<Edge>,
}

impl ConnectedBoard {
    pub fn with_new_uno() -> Self {
        Self::with_boot_loader(load_uno_boot_loader())
    }

    pub fn with_boot_loader(boot_loader: Image) -> Self {
        Self {
            uno: Uno::with_boot_loader(boot_loader, Fidelity::DataSheet),
            port: Port::new().expect("a pseudo terminal can be opened"),
            edges: Vec::new(),
        }
    }

    /// Returns the path of the board's serial port.
    pub fn port_path(&self) -> String {
        self.port.path().display().to_string()
    }

    /// Runs the board until the condition holds. Returns false if the condition does not hold within the time limit.
    pub fn run_until(&mut self, mut condition: impl FnMut(&mut Uno) -> bool) -> bool {
        TIME_LIMIT.poll(|| {
            let period = Duration::from_millis(10);
            let result = self.port.serve(&mut self.uno, period);
            result.expect("the port works");
            self.edges.extend(self.uno.take_edges());
            condition(&mut self.uno)
        })
    }

    /// Runs the board until `text` is on the screen. The test fails if the text does not appear within the time limit.
    pub fn wait_for_text(&mut self, shell: &Shell, text: &str) {
        let is_in_time = self.run_until(|_| shell.screen().contains(text) || shell.has_ended());
        let screen = shell.screen();
        assert!(
            is_in_time && screen.contains(text),
            "waited up to {TIME_LIMIT} for {text:?} in\n{screen}"
        );
    }

    /// Runs the board until the program in the shell has ended. Returns the program's entire output.
    pub fn run_until_exit(&mut self, shell: &Shell) -> String {
        let has_ended = self.run_until(|_| shell.has_ended());
        let screen = shell.screen();
        assert!(
            has_ended,
            "waited {TIME_LIMIT} for the program to exit:\n{screen}"
        );
        screen
    }

    /// Returns the addresses below the boot loader at which flash differs from a program.
    pub fn find_differing_addresses(&self, program: &[u8]) -> Vec<usize> {
        let flash = self.uno.flash();
        let differs = |address: &usize| flash[*address] != program[*address];
        (0..BOOT_LOADER_START).filter(differs).collect()
    }

    /// Asserts that flash contains this program and the unchanged boot loader of a stock UNO.
    pub fn assert_flashed_with(&self, program: &[u8]) {
        let wrong_addresses = self.find_differing_addresses(program);
        assert!(
            wrong_addresses.is_empty(),
            "flash differs from the program at {wrong_addresses:x?}"
        );
        let new_uno = Uno::with_boot_loader(load_uno_boot_loader(), Fidelity::DataSheet);
        let is_unchanged =
            self.uno.flash()[BOOT_LOADER_START..] == new_uno.flash()[BOOT_LOADER_START..];
        assert!(is_unchanged, "the boot loader was changed");
    }
}
