//! Fuzz targets for the core: any bytes at its console, any bytes in its EEPROM.
//!
//! Bytes come from a half-open port, a modem manager or a cat on the keyboard; the
//! EEPROM may hold another program's data. Whatever the bytes are, each line gets one
//! answer, no pulse leaves a servo's limits, and saved settings stay intact.
//!
//! [`console`] and [`memory`] check one input. `make test` calls them with millions of
//! seeded random bytes and lines, `make fuzz` with the inputs that LLVM's libFuzzer
//! generates.

mod board;

pub use board::Board;

use std::sync::LazyLock;

use lizard_core::memory::copies::{COPY_ADDRESSES, REST_POSE_ADDRESS};
use lizard_core::memory::record::{Address, CONTENT_BYTES, Progress};
use lizard_core::memory::settings::Settings;
use lizard_core::virtual_board::Eeprom;
use lizard_robot::Robot;

/// Returns the robot in the file that `LIZARD_ROBOT` names, by default the source tree's robot.toml.
///
/// # Panics
/// If the file is not a valid robot.
pub fn robot() -> &'static Robot {
    static ROBOT: LazyLock<Robot> = LazyLock::new(|| {
        let built_in = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robot.toml").into();
        let path = std::env::var_os("LIZARD_ROBOT").filter(|path| !path.is_empty());
        Robot::load(path.unwrap_or(built_in)).unwrap_or_else(|error| panic!("{error}"))
    });
    &ROBOT
}

/// Sends bytes to the console, with a frame after every eight bytes.
///
/// # Panics
/// If the robot breaks a rule.
pub fn console(data: &[u8]) {
    let mut board = Board::new(robot(), Eeprom::blank());
    for chunk in data.chunks(8) {
        for byte in chunk {
            board.send_byte(*byte);
        }
        board.frame();
    }
    board.send_byte(b'\n');
    board.assert_memory_is_right();
}

/// Starts a robot with an EEPROM made from these bytes. The first bytes change the contents of the
/// EEPROM's three records, which stay valid. Each further group of three bytes sets one byte at any
/// address, which may damage a record.
///
/// # Panics
/// If the robot breaks a rule.
pub fn memory(data: &[u8]) {
    let robot = robot();
    let mut memory = Eeprom::blank();
    let (records, patches) = data.split_at(data.len().min(3 * CONTENT_BYTES));
    let addresses = [COPY_ADDRESSES[0], COPY_ADDRESSES[1], REST_POSE_ADDRESS];
    for (address, changes) in addresses.into_iter().zip(records.chunks(CONTENT_BYTES)) {
        let mut content = *Settings::of(robot.firmware()).bytes();
        for (byte, change) in content.iter_mut().zip(changes) {
            *byte ^= change;
        }
        write_record(address, &content, &mut memory);
    }
    for patch in patches.chunks_exact(3) {
        let address = u16::from_le_bytes([patch[0], patch[1]]) % 1024;
        memory.bytes_mut()[usize::from(address)] = patch[2];
    }
    let memory_before = memory.clone();
    let mut board = Board::new(robot, memory);
    // Three and a half seconds, so that the `boot` action runs, too.
    for _ in 0..175 {
        board.frame();
    }
    let bytes_after = board.memory().bytes();
    let settings_range = 0..usize::from(REST_POSE_ADDRESS.0);
    assert_eq!(
        bytes_after[settings_range.clone()],
        memory_before.bytes()[settings_range],
        "nobody saved"
    );
    for byte in b"status\nstand\n" {
        board.send_byte(*byte);
    }
    for _ in 0..50 {
        board.frame();
    }
}

/// Writes a record as the core does.
fn write_record(address: Address, content: &[u8; CONTENT_BYTES], memory: &mut Eeprom) {
    let mut writing = address.start_write();
    while writing.advance(content, memory) == Progress::InProgress {}
}
