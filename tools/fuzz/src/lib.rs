//! Fuzz targets for the core: any bytes at its console, any bytes in its EEPROM.
//!
//! Unexpected bytes come from a half-open port, a modem manager or an open terminal, and the EEPROM may hold another
//! program's data. Whatever the bytes, each line must get one answer, every pulse must be within the servo's limits,
//! and saved settings must stay intact.
//!
//! [`check_console`] and [`check_memory`] each check one input. `make fuzz` calls them with inputs that LLVM's
//! libFuzzer generates. `make test` calls them with millions of random bytes and lines.

mod observed_board;

pub use observed_board::ObservedBoard;

use std::sync::LazyLock;

use lizard_core::memory::copies::{COPY_ADDRESSES, REST_POSE_ADDRESS};
use lizard_core::memory::record::{CONTENT_BYTES, Progress};
use lizard_core::memory::settings::Settings;
use lizard_core::virtual_board::Eeprom;
use lizard_robot::Robot;

/// Returns the robot from the file that `LIZARD_ROBOT` names, by default robot.toml in the source tree.
///
/// # Panics
/// If the file does not describe a valid robot.
pub fn robot() -> &'static Robot {
    static ROBOT: LazyLock<Robot> = LazyLock::new(|| {
        let default_path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robot.toml").into();
        let path = std::env::var_os("LIZARD_ROBOT").filter(|path| !path.is_empty());
        Robot::load(path.unwrap_or(default_path)).unwrap_or_else(|error| panic!("{error}"))
    });
    &ROBOT
}

/// Sends bytes to the console and runs a frame after every eight bytes.
///
/// # Panics
/// If the robot violates a rule.
pub fn check_console(bytes: &[u8]) {
    let mut board = ObservedBoard::power_on(robot(), Eeprom::blank());
    for chunk in bytes.chunks(8) {
        for byte in chunk {
            board.send_byte(*byte);
        }
        board.run_frame();
    }
    board.send_byte(b'\n');
    board.assert_memory_is_valid();
}

/// Starts a robot with an EEPROM that `input` defines. The first bytes change the contents of the three records, which
/// stay valid. Each further group of three bytes sets a byte at one address, which may damage a record.
///
/// # Panics
/// If the robot violates a rule.
pub fn check_memory(input: &[u8]) {
    let robot = robot();
    let mut memory = Eeprom::blank();
    let (records, patches) = input.split_at(input.len().min(3 * CONTENT_BYTES));
    let addresses = [COPY_ADDRESSES[0], COPY_ADDRESSES[1], REST_POSE_ADDRESS];
    for (address, changes) in addresses.into_iter().zip(records.chunks(CONTENT_BYTES)) {
        let mut content = *Settings::for_robot(robot.firmware()).bytes();
        for (byte, change) in content.iter_mut().zip(changes) {
            *byte ^= change;
        }
        // Writes the record as the core does.
        let mut writing = address.start_write();
        while writing.advance(&content, &mut memory) == Progress::InProgress {}
    }
    for patch in patches.chunks_exact(3) {
        let address = u16::from_le_bytes([patch[0], patch[1]]) % 1024;
        memory.bytes_mut()[usize::from(address)] = patch[2];
    }
    let memory_before = memory.clone();
    let mut board = ObservedBoard::power_on(robot, memory);
    // After 3.5 s, the `boot` action has started, too.
    board.run_frames(175);
    let settings_size = usize::from(REST_POSE_ADDRESS.0);
    assert_eq!(
        board.memory().bytes()[..settings_size],
        memory_before.bytes()[..settings_size],
        "the saved settings changed without a save command"
    );
    for byte in b"status\nstand\n" {
        board.send_byte(*byte);
    }
    board.run_frames(50);
}
