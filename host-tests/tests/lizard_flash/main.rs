//! Tests of `lizard flash` as a user runs it. The board is simulated in real time, with the original boot loader of a
//! UNO or an old Nano.
//!
//! `make flash-test` compiles the program and the boot loaders, and runs these tests.

#[path = "../connected_board/mod.rs"]
mod connected_board;
mod nano;
mod robot_alone;
#[path = "../shell/mod.rs"]
mod shell;

use std::sync::LazyLock;

use connected_board::{BOOT_LOADER_START, ConnectedBoard, load_boot_loader};
use lizard_core::memory::copies::REST_POSE_ADDRESS;
use lizard_core::memory::record::{MEMORY_BYTES, RECORD_BYTES};
use lizard_core::numbers::section::START_ADDRESS;
use lizard_host::firmware::format_robot_label;
use lizard_host::sim::frame::servo_pins;
use lizard_host_tests::{assert_contains, avr_gcc, decode_text, load_named_robot, robot};
use lizard_robot::Robot;
use lizard_time_limit::TIME_LIMIT;
use shell::Shell;
use simulated_uno::{Fidelity, Image, Port, Uno};

/// The image of a program other than the firmware, which sends bytes forever at the boot loader's baud rate.
static SENDER_IMAGE: LazyLock<Image> = LazyLock::new(|| {
    avr_gcc::compile_c(
        r#"
        #include <avr/io.h>
        #include <util/delay.h>
        int main(void) {
            UCSR0A = 1 << U2X0;
            UCSR0B = 1 << TXEN0;
            UBRR0L = 16;
            for (;;) {
                UDR0 = 0x14;
                _delay_ms(1);
            }
        }
    "#,
    )
});

/// Returns the flash contents below the boot loader for `lizard`'s own firmware with this robot.
fn firmware_with(robot: &Robot) -> Vec<u8> {
    let image = lizard_host::firmware::built_in_image(robot);
    Uno::with_image(image, Fidelity::DataSheet).flash()[..BOOT_LOADER_START].to_vec()
}

/// Returns the flash contents below the boot loader for the firmware with the robot under test.
fn firmware() -> Vec<u8> {
    firmware_with(robot())
}

/// Loads a robot other than the robot under test, and returns its name for the option `--robot` and the robot.
fn load_another_robot() -> (&'static str, Robot) {
    let name = match robot().name() {
        "large" => "unequal",
        _ => "large",
    };
    (name, load_named_robot(name))
}

/// Starts `lizard`.
fn start_lizard(arguments: &[&str]) -> Shell {
    let lizard = std::env::var("LIZARD").expect("`make flash-test` compiles the program");
    Shell::start(&lizard, arguments, &[])
}

/// Starts `lizard flash` on the board's port.
fn start_lizard_flash(board: &ConnectedBoard, arguments: &[&str]) -> Shell {
    start_lizard(&[&["flash", board.port_path().as_str()], arguments].concat())
}

/// Runs `lizard flash` on the board's port until it exits, and returns its entire output.
fn run_lizard_flash(board: &mut ConnectedBoard, arguments: &[&str]) -> String {
    let shell = start_lizard_flash(board, arguments);
    board.run_until_exit(&shell)
}

/// Checks that flash below the address `end` is the firmware with this robot.
#[track_caller]
fn assert_flashed_with_robot(board: &ConnectedBoard, robot: &Robot, end: usize) {
    assert!(board.uno.flash()[..end] == firmware_with(robot)[..end]);
}

/// Checks that an upload did not change the EEPROM, except for the rest pose. The firmware itself may write the rest
/// pose, for example if `lizard` on a slow machine resets the board several times.
fn assert_eeprom_kept(board: &ConnectedBoard, expected: &[u8; MEMORY_BYTES]) {
    let rest_addresses =
        usize::from(REST_POSE_ADDRESS.0)..usize::from(REST_POSE_ADDRESS.0 + RECORD_BYTES);
    let eeprom = board.uno.eeprom();
    let has_changed = |address: &usize| {
        eeprom[*address] != expected[*address] && !rest_addresses.contains(address)
    };
    let changed_addresses: Vec<usize> = (0..MEMORY_BYTES).filter(has_changed).collect();
    assert!(
        changed_addresses.is_empty(),
        "the EEPROM was changed at {changed_addresses:?}:\n{eeprom:?}"
    );
}

/// Unplugs the board, and plugs it into a new port.
fn replug(board: &mut ConnectedBoard) {
    board.port = Port::new().expect("a pseudo terminal can be opened");
}

/// Waits for a successful upload, and checks that the robot prints the firmware's banner. Returns the entire output of
/// `lizard`.
fn expect_success(board: &mut ConnectedBoard, shell: &Shell) -> String {
    let screen = board.run_until_exit(shell);
    assert!(screen.contains("\n# lizard "), "{screen}");
    board.assert_flashed_with(&firmware());
    screen
}

/// Uploads the firmware to a board, as [`expect_success`] describes.
fn flash_successfully(board: &mut ConnectedBoard) -> String {
    let shell = start_lizard_flash(board, &[]);
    expect_success(board, &shell)
}

/// Starts an upload to a board, and waits until the first pages of the new code are written.
fn begin_upload(board: &mut ConnectedBoard) -> Shell {
    let shell = start_lizard_flash(board, &[]);
    let is_in_time = board.run_until(|uno| uno.flash()[0x1000] != 0xff || shell.has_ended());
    let screen = shell.screen();
    let has_begun = is_in_time && !shell.has_ended();
    assert!(has_begun, "the upload did not begin:\n{screen}");
    shell
}

/// Returns a board with the firmware, which was placed in its flash without an upload.
fn prepare_board_with_firmware() -> ConnectedBoard {
    let mut board = ConnectedBoard::with_new_uno();
    board.uno.write_flash(0, &firmware());
    board
}

#[test]
fn a_blank_board_is_flashed_and_its_robot_reports_the_firmware() {
    let mut board = ConnectedBoard::with_new_uno();
    let screen = flash_successfully(&mut board);
    assert!(screen.contains("the board has no program\n"), "{screen}");
    // The erased flash between code and robot is not written.
    assert!(screen.contains(" bytes written and verified, "), "{screen}");
}

#[test]
fn a_board_whose_program_sends_bytes_forever_is_flashed_and_keeps_its_eeprom() {
    let mut board = ConnectedBoard::with_new_uno();
    let program = SENDER_IMAGE.flash();
    board.uno.write_flash(0, &program);
    let eeprom: [u8; 1024] = std::array::from_fn(|index| (index * 7 + index / 256) as u8);
    board.uno.set_eeprom(&eeprom);
    let shell = start_lizard_flash(&board, &[]);
    board.wait_for_text(&shell, "written and verified");
    assert_eeprom_kept(&board, &eeprom);
    let screen = expect_success(&mut board, &shell);
    let byte_count = program.len();
    let board_text = format!("the board has another program, of {byte_count} bytes\n");
    assert!(screen.contains(&board_text), "{screen}");
}

#[test]
fn a_board_that_has_the_image_stays_unchanged() {
    let mut board = prepare_board_with_firmware();
    let screen = flash_successfully(&mut board);
    let robot_text = format!("robot {} already", format_robot_label(robot().firmware()));
    assert!(screen.contains(&robot_text), "{screen}");
    assert!(screen.contains("nothing to write: all"), "{screen}");
}

#[test]
fn only_a_page_that_differs_is_written() {
    let mut board = prepare_board_with_firmware();
    let old_byte = board.uno.flash()[0x2005];
    board.uno.write_flash(0x2005, &[old_byte ^ 0x10]);
    let screen = flash_successfully(&mut board);
    assert_contains(&screen, "the board has another build of lizard");
    // Two pages are written: the page that differs, and the page at address 0, where the chip starts.
    assert_contains(&screen, "\n256 bytes written and verified");
}

#[test]
fn a_board_unplugged_during_an_upload_does_nothing_until_it_is_flashed_again() {
    let mut board = ConnectedBoard::with_new_uno();
    board.uno.write_flash(0, &SENDER_IMAGE.flash());
    let shell = begin_upload(&mut board);
    replug(&mut board);
    let screen = board.run_until_exit(&shell);
    assert_contains(&screen, "the port is gone");
    assert_contains(&screen, "an incomplete program, which does nothing");
    assert!(!board.find_differing_addresses(&firmware()).is_empty());

    // After the board is plugged in again, it has power, but no program calls its boot loader.
    board.uno.power_cycle();
    board.uno.take_transmitted();
    board.uno.take_edges();
    board.uno.run_ms(3000);
    assert!(board.uno.transmitted().is_empty(), "the board sent bytes");
    let edges = board.uno.take_edges();
    assert!(edges.is_empty(), "pins changed: {edges:?}");
    // These seconds were simulated faster than real time. A port requires real time, so the board gets a new port.
    replug(&mut board);

    flash_successfully(&mut board);
}

#[test]
fn a_board_whose_reset_button_is_pressed_during_an_upload_is_reset_again_and_flashed() {
    let mut board = ConnectedBoard::with_new_uno();
    let shell = begin_upload(&mut board);
    board.uno.reset();
    let screen = expect_success(&mut board, &shell);
    assert_contains(&screen, "resetting the board for another attempt");
}

#[test]
fn a_closed_standard_error_does_not_stop_an_upload() {
    let mut board = ConnectedBoard::with_new_uno();
    let lizard = std::env::var("LIZARD").expect("`make flash-test` compiles the program");
    let script = r#""$0" flash "$1" --json 2>&1 >/dev/null | head -n 1"#;
    let port = board.port_path();
    let shell = Shell::start("bash", &["-c", script, &lizard, &port], &[]);
    board.run_until_exit(&shell);
    board.assert_flashed_with(&firmware());
}

#[test]
fn a_byte_that_changes_after_its_write_is_rewritten() {
    let mut board = ConnectedBoard::with_new_uno();
    let shell = start_lizard_flash(&board, &[]);
    let mut has_changed = false;
    let has_ended = board.run_until(|uno| {
        // The byte changes long before it is read back.
        if !has_changed && uno.flash()[0x280] != 0xff {
            uno.write_flash(0x211, &[uno.flash()[0x211] ^ 0x10]);
            has_changed = true;
        }
        shell.has_ended()
    });
    let screen = shell.screen();
    assert!(
        has_ended,
        "waited {TIME_LIMIT} for the end of the upload:\n{screen}"
    );
    assert!(has_changed, "nothing was written:\n{screen}");
    assert!(screen.contains("\n# lizard "), "{screen}");
    board.assert_flashed_with(&firmware());
}

#[test]
fn a_board_whose_boot_loader_does_not_answer_gets_an_explanation() {
    let mut board = ConnectedBoard::with_new_uno();
    // Replaces the boot loader with an endless loop: `rjmp .-2`.
    board
        .uno
        .write_flash(BOOT_LOADER_START as u16, &[0xff, 0xcf]);
    let screen = run_lizard_flash(&mut board, &[]);
    assert_contains(&screen, "no boot loader answers. Is it a UNO or a Nano?");
    let mut bytes = board.uno.flash()[..BOOT_LOADER_START].iter();
    assert!(bytes.all(|&byte| byte == 0xff));
}
