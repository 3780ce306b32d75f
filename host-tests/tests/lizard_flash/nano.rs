//! Tests with an old Nano, whose boot loader is slower and larger than a UNO's and leaves the watchdog on.

use super::*;

/// The address of the first byte of an old Nano's boot loader.
const NANO_BOOT_LOADER_START: usize = 0x7800;

/// Creates a Nano as sold until 2018, with a boot loader at 57 600 baud.
fn create_old_nano() -> Desk {
    Desk::with_boot_loader(load_boot_loader("old-nano.hex"))
}

#[test]
fn an_old_nano_is_found_at_its_own_baud_rate_flashed_and_started() {
    let mut desk = create_old_nano();
    let flash_before = desk.uno.flash().to_vec();
    let shell = start_lizard_flash(&desk, &["--robot", "large"]);
    let screen = run_to_exit(&mut desk, &shell);
    assert!(
        screen.contains("no answer at 115200 baud; retrying at 57600 baud"),
        "{screen}"
    );
    assert!(screen.contains("the board has no program\n"), "{screen}");
    assert!(screen.contains("\n# lizard "), "{screen}");
    assert!(screen.contains(" robot large "), "{screen}");
    let large = Robot::load(root().join("robots/large.toml")).expect("the file is valid");
    assert!(
        desk.uno.flash()[..NANO_BOOT_LOADER_START]
            == firmware_with(&large)[..NANO_BOOT_LOADER_START]
    );
    assert!(desk.uno.flash()[NANO_BOOT_LOADER_START..] == flash_before[NANO_BOOT_LOADER_START..]);

    // The next upload replaces only the robot. This boot loader never resets the chip.
    let shell = start_lizard_flash(&desk, &["--only-robot", "--robot", "paper"]);
    let screen = run_to_exit(&mut desk, &shell);
    assert!(screen.contains("robot large "), "{screen}");
    assert!(screen.contains("\n# lizard "), "{screen}");
    let paper = Robot::load(root().join("robots/paper.toml")).expect("the file is valid");
    assert!(
        desk.uno.flash()[..NANO_BOOT_LOADER_START]
            == firmware_with(&paper)[..NANO_BOOT_LOADER_START]
    );
}

#[test]
fn a_robot_too_large_for_an_old_nano_is_refused_and_its_boot_loader_kept() {
    let mut desk = create_old_nano();
    let flash_before = desk.uno.flash().to_vec();
    let shell = start_lizard_flash(&desk, &["--robot", "own-gaits"]);
    let screen = run_to_exit(&mut desk, &shell);
    assert!(
        screen.contains("a Nano has only 30720 before its boot section"),
        "{screen}"
    );
    assert!(desk.uno.flash() == flash_before);
}

#[test]
fn after_a_hang_an_old_nano_moves_no_servo_until_its_power_is_cut() {
    let mut desk = create_old_nano();
    desk.uno.set_flash(0, &firmware()[..NANO_BOOT_LOADER_START]);
    desk.uno.run_ms(2500);
    let take_text = |uno: &mut Uno| -> String {
        let bytes = uno.take_transmitted();
        bytes.iter().map(|byte| char::from(byte.byte)).collect()
    };
    let output_text = take_text(&mut desk.uno);
    assert!(output_text.contains("# lizard "), "{output_text}");
    desk.uno.send(b"stand\n");
    desk.uno.run_ms(500);
    take_text(&mut desk.uno);
    desk.uno.stall_main(1000 * simulated_uno::CYCLES_PER_MS);
    desk.uno.run_ms(400);
    desk.uno.take_edges();
    // The boot loader leaves the watchdog on, which resets the chip again before the boot loader ends. A reset with the
    // RESET pin does not clear WDRF, and while WDRF is set, WDE remains set (data sheet, 11.9.2).
    desk.uno.reset();
    let resets_before = desk.uno.watchdog_resets();
    desk.uno.run_ms(3000);
    let reset_count = desk.uno.watchdog_resets() - resets_before;
    assert!(
        (150..200).contains(&reset_count),
        "expected about one reset every 16 ms, got {reset_count} in 3 s"
    );
    assert_eq!(take_text(&mut desk.uno), "");
    let pins = servo_pins(robot());
    let edges = desk.uno.take_edges();
    assert!(!edges.iter().any(|edge| pins.contains(&edge.pin)));
    desk.uno.power_cycle();
    desk.uno.run_ms(2500);
    let output_text = take_text(&mut desk.uno);
    assert!(output_text.contains("# lizard "), "{output_text}");
}
