//! Tests with an old Nano, whose boot loader is slower and larger than a UNO's and leaves the watchdog on.

use super::*;

/// The address of the first byte of an old Nano's boot loader.
const NANO_BOOT_LOADER_START: usize = 0x7800;

/// Creates a Nano as sold until 2018, with a boot loader at 57 600 baud.
fn create_old_nano() -> ConnectedBoard {
    ConnectedBoard::with_boot_loader(load_boot_loader("old-nano.hex"))
}

#[test]
fn an_old_nano_is_found_at_its_own_baud_rate_flashed_and_started() {
    let mut board = create_old_nano();
    let flash_before = board.uno.flash().to_vec();
    let screen = run_lizard_flash(&mut board, &["--robot", "large"]);
    assert_contains(&screen, "no answer at 115200 baud; retrying at 57600 baud");
    assert!(screen.contains("the board has no program\n"), "{screen}");
    assert!(screen.contains("\n# lizard "), "{screen}");
    assert!(screen.contains(" robot large "), "{screen}");
    assert_flashed_with_robot(&board, &load_named_robot("large"), NANO_BOOT_LOADER_START);
    assert!(board.uno.flash()[NANO_BOOT_LOADER_START..] == flash_before[NANO_BOOT_LOADER_START..]);

    // The next upload replaces only the robot. This boot loader never resets the chip.
    let screen = run_lizard_flash(&mut board, &["--only-robot", "--robot", "paper"]);
    assert!(screen.contains("robot large "), "{screen}");
    assert!(screen.contains("\n# lizard "), "{screen}");
    assert_flashed_with_robot(&board, &load_named_robot("paper"), NANO_BOOT_LOADER_START);
}

#[test]
fn a_robot_too_large_for_an_old_nano_is_refused_and_its_boot_loader_kept() {
    let mut board = create_old_nano();
    let flash_before = board.uno.flash().to_vec();
    let screen = run_lizard_flash(&mut board, &["--robot", "own-gaits"]);
    assert_contains(&screen, "a Nano has only 30720 before its boot section");
    assert!(board.uno.flash() == flash_before);
}

#[test]
fn after_a_hang_an_old_nano_moves_no_servo_until_its_power_is_cut() {
    let mut board = create_old_nano();
    let program = &firmware()[..NANO_BOOT_LOADER_START];
    board.uno.write_flash(0, program);
    board.uno.run_ms(2500);
    let take_text = |uno: &mut Uno| decode_text(&uno.take_transmitted());
    let output_text = take_text(&mut board.uno);
    assert!(output_text.contains("# lizard "), "{output_text}");
    board.uno.send(b"stand\n");
    board.uno.run_ms(500);
    take_text(&mut board.uno);
    board.uno.stall_main(1000 * simulated_uno::CYCLES_PER_MS);
    board.uno.run_ms(400);
    board.uno.take_edges();
    // The boot loader leaves the watchdog on, which resets the chip again before the boot loader ends. A reset with the
    // RESET pin does not clear WDRF, and while WDRF is set, WDE remains set (data sheet, 11.9.2).
    board.uno.reset();
    let resets_before = board.uno.watchdog_reset_count();
    board.uno.run_ms(3000);
    let reset_count = board.uno.watchdog_reset_count() - resets_before;
    assert!(
        (150..200).contains(&reset_count),
        "expected about one reset every 16 ms, got {reset_count} in 3 s"
    );
    assert_eq!(take_text(&mut board.uno), "");
    let pins = servo_pins(robot());
    let edges = board.uno.take_edges();
    assert!(!edges.iter().any(|edge| pins.contains(&edge.pin)));
    board.uno.power_cycle();
    board.uno.run_ms(2500);
    let output_text = take_text(&mut board.uno);
    assert!(output_text.contains("# lizard "), "{output_text}");
}
