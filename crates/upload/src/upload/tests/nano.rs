//! Tests of uploads to a Nano. An old Nano's boot loader has a lower baud rate and leaves less flash free.

use super::*;

#[test]
fn an_upload_to_an_old_nano_finds_its_baud_rate_and_keeps_its_boot_loader() {
    let mut board = BoardDouble::old_nano();
    board.flash[..500].fill(9);
    let run = run_with_image(board, &firmware_image("paper"));
    assert!(run.result.is_ok(), "{}", run.error_message());
    let counts = (run.board.reset_count, run.retry_count);
    assert_eq!(counts, (2, 1), "tried at both baud rates");
    let contents = ["the board has another program, of 500 bytes"];
    assert_eq!(run.reported_contents, contents);
    let image = firmware_image("paper");
    assert!(run.board.flash[..image.end_address()] == *image.bytes());
    assert!(run.board.flash[0x7800..] == BoardDouble::old_nano().flash[0x7800..]);
    assert!(run.board.has_started_program, "the program is started");
}

#[test]
fn an_upload_to_an_old_nano_recovers_from_the_loss_of_any_byte_to_the_board() {
    let (paper_image, large) = (firmware_image("paper"), robot_image("large"));
    let run_with_lost_byte = |lost_byte| {
        let mut board = BoardDouble::old_nano();
        board.flash[..paper_image.end_address()].copy_from_slice(paper_image.bytes());
        board.lost_byte_to_board = lost_byte;
        run_with_image(board, &large)
    };
    let byte_count = run_with_lost_byte(None).board.received_count;
    assert!(byte_count > 1000, "{byte_count} bytes");
    for lost_byte in 0..byte_count {
        let run = run_with_lost_byte(Some(lost_byte));
        run.assert_recovered(lost_byte);
        let name = read_robot_name(&run.board);
        assert_eq!(name.as_deref(), Some("large"), "byte {lost_byte}");
        let reset_count = run.board.reset_count;
        assert!(reset_count <= 4, "byte {lost_byte}: {reset_count} resets");
    }
}

#[test]
fn an_image_that_reaches_into_a_nanos_boot_section_is_rejected_for_a_possible_nano() {
    // This robot has the most gaits of all robots in the repository.
    let image = firmware_image("own-gaits");
    let end_address = image.end_address();
    assert!(end_address > 0x7800, "{end_address:#x}");
    let rejection_message = |mut board: BoardDouble, target: Target| {
        board.flash[..500].fill(9);
        let old_flash = board.flash.clone();
        let run = run_with_target(board, &image, target);
        assert!(run.board.flash == old_flash && run.board.written_addresses.is_empty());
        run.error_message()
    };
    let unknown_model = Target::default();
    let target_for_model = |model| Target {
        model: Some(model),
        may_be_nano: true,
    };
    let message = rejection_message(BoardDouble::old_nano(), unknown_model);
    let expected_start =
        format!("{end_address} bytes of flash are needed, but a Nano has only 30720");
    assert!(message.starts_with(&expected_start), "{message}");
    assert!(message.ends_with("Nothing was written"), "{message}");
    let nano_message = rejection_message(BoardDouble::blank(), target_for_model(Model::Nano));
    assert_eq!(message, nano_message);
    // A newer Nano answers like a UNO, and UNO clones have the same USB chip as a Nano.
    let possible_nano = Target {
        may_be_nano: true,
        ..unknown_model
    };
    let message = rejection_message(BoardDouble::blank(), possible_nano);
    let reason = "; the USB chip of this board is used on both UNOs and Nanos. Nothing";
    assert!(message.contains(reason), "{message}");
    let small_image = firmware_image("paper");
    for (image, target) in [
        (&image, unknown_model),
        (&image, target_for_model(Model::Uno)),
        // An image that also fits into a Nano is written although the model is unknown.
        (&small_image, possible_nano),
    ] {
        let run = run_with_target(BoardDouble::blank(), image, target);
        assert!(run.result.is_ok(), "{target:?}: {}", run.error_message());
    }
}
