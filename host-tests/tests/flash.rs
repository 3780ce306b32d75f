//! Tests of `make flash` as described in docs/flashing.md: cargo, ravedude and avrdude write the image to a new board.
//! The board is simulated in real time on a pseudo terminal, with the boot loader of a stock UNO in its flash.
//!
//! `make flash-test` installs the tools and runs these tests.

mod connected_board;
mod shell;

use connected_board::{BOOT_LOADER_START, ConnectedBoard};
use lizard_host::sim::frame::{group_frames, servo_pins};
use lizard_host_tests::{FRAME_CYCLES, FirmwareBench, Frame, robot};
use lizard_time_limit::TIME_LIMIT;
use shell::Shell;
use simulated_uno::{Fidelity, Uno};

/// Number of frames after which all servos are awake.
const AWAKE_FRAMES: u64 = 60;

/// Starts `make flash` on the board's port.
fn start_make_flash(board: &ConnectedBoard) -> Shell {
    Shell::start("make", &["flash"], &[("RAVEDUDE_PORT", &board.port_path())])
}

/// Types a line in the console and waits for its answer.
fn say(board: &mut ConnectedBoard, shell: &mut Shell, line: &str) {
    shell.type_line(line);
    board.wait_for_text(shell, &format!("ok {line}"));
}

/// Runs the board for a number of frames.
fn run_frames(board: &mut ConnectedBoard, count: u64) {
    let end_cycle = board.uno.cycle() + count * FRAME_CYCLES;
    let is_in_time = board.run_until(|uno| uno.cycle() > end_cycle);
    assert!(is_in_time, "waited {TIME_LIMIT} for {count} frames");
}

/// Returns the pulse widths of each frame, cycles.
fn expect_widths(frames: &[Frame]) -> Vec<[u64; 4]> {
    frames.iter().map(Frame::expect_all_widths).collect()
}

#[test]
fn make_flash_writes_the_image_and_the_robot_walks() {
    let mut board = ConnectedBoard::with_new_uno();
    let mut shell = start_make_flash(&board);
    board.wait_for_text(&shell, "# lizard");
    let screen = shell.screen();
    assert!(screen.contains("bytes of flash verified"), "{screen}");

    let expected_uno = Uno::load(FirmwareBench::elf_path(), Fidelity::DataSheet);
    let expected_uno = expected_uno.expect("the image loads");
    board.assert_flashed_with(expected_uno.flash());

    // Waits until all four servos are awake, then walks for two gait cycles.
    say(&mut board, &mut shell, "stand");
    run_frames(&mut board, AWAKE_FRAMES);
    say(&mut board, &mut shell, "walk");
    board.edges.clear();
    run_frames(&mut board, 110);
    let pins = servo_pins(robot());
    let mut edges = board.edges.iter();
    let first_edge = edges.find(|edge| edge.is_rising && edge.pin == pins[0]);
    let start_cycle = first_edge.expect("A1 has a pulse").cycle;
    let walked_widths = expect_widths(&group_frames(&board.edges, pins, start_cycle, 100));

    // Runs the same image in a simulation without a boot loader, a port or the wall clock.
    let mut bench = FirmwareBench::boot(Fidelity::DataSheet);
    bench.say("stand");
    bench.run_for_frames(AWAKE_FRAMES);
    bench.say("walk");
    let bench_widths = expect_widths(&bench.run_for_frames(150));
    assert!(
        bench_widths
            .windows(walked_widths.len())
            .any(|window| window == walked_widths),
        "the bench has no such sequence of pulse widths (cycles): {walked_widths:?}"
    );
    shell.interrupt();
}

#[test]
fn an_upload_keeps_the_eeprom() {
    let mut board = ConnectedBoard::with_new_uno();
    let eeprom: [u8; 1024] = std::array::from_fn(|index| (index * 7 + index / 256) as u8);
    board.uno.set_eeprom(&eeprom);
    let mut shell = start_make_flash(&board);
    // Compares the EEPROM before the firmware can write to it.
    board.wait_for_text(&shell, "bytes of flash verified");
    let is_unchanged = board.uno.eeprom() == eeprom;
    assert!(is_unchanged, "the upload changed the EEPROM");
    shell.interrupt();
}

#[test]
fn a_saved_calibration_is_in_effect_after_the_next_upload() {
    let mut board = ConnectedBoard::with_new_uno();
    let mut shell = start_make_flash(&board);
    board.wait_for_text(&shell, "# lizard");
    for line in ["trim 1 3", "deadman 700", "save"] {
        say(&mut board, &mut shell, line);
    }
    shell.interrupt();
    let mut shell = start_make_flash(&board);
    board.wait_for_text(&shell, "# lizard");
    say(&mut board, &mut shell, "cal");
    let screen = shell.screen();
    assert!(screen.contains("# A1 trim 3.00 "), "{screen}");
    assert!(screen.contains("# deadman 700"), "{screen}");
    shell.interrupt();
}

#[test]
fn a_byte_that_changes_after_its_write_ends_the_upload() {
    let mut board = ConnectedBoard::with_new_uno();
    let shell = start_make_flash(&board);
    let mut has_flipped_bit = false;
    // When the third page is written, a bit of the first page changes.
    let has_ended = board.run_until(|uno| {
        if !has_flipped_bit && uno.flash()[0x100] != 0xff {
            uno.write_flash(0x11, &[uno.flash()[0x11] ^ 0x10]);
            has_flipped_bit = true;
        }
        shell.has_ended()
    });
    let screen = shell.screen();
    assert!(
        has_ended,
        "waited {TIME_LIMIT} for the end of the upload:\n{screen}"
    );
    assert!(has_flipped_bit, "nothing was written:\n{screen}");
    assert!(screen.contains("verification"), "{screen}");
    assert!(screen.contains("flash: the upload to"), "{screen}");
    let has_console = screen.contains("# lizard");
    assert!(!has_console, "the console started:\n{screen}");
}

#[test]
fn a_board_that_never_answers_ends_the_upload_with_an_explanation() {
    let mut board = ConnectedBoard::with_new_uno();
    // Replaces the boot loader with an endless loop: `rjmp .-2`.
    board
        .uno
        .write_flash(BOOT_LOADER_START as u16, &[0xff, 0xcf]);
    let shell = start_make_flash(&board);
    let screen = board.run_until_exit(&shell);
    assert!(screen.contains("the board does not answer"), "{screen}");
    let mut bytes = board.uno.flash()[..BOOT_LOADER_START].iter();
    let is_blank = bytes.all(|&byte| byte == 0xff);
    assert!(is_blank, "the upload wrote to the flash");
}
