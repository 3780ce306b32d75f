//! Uploads to an old Nano: its boot loader has a lower baud rate and leaves less flash free.

use super::*;

#[test]
fn an_old_nano_is_found_at_its_own_speed_and_keeps_its_boot_loader() {
    let mut board = BoardDouble::old_nano();
    board.flash[..500].fill(9);
    let run = run_with(board, &whole_image("paper"));
    assert!(run.result.is_ok(), "{}", run.error());
    assert_eq!(
        (run.board.resets, run.retries),
        (2, 1),
        "called at both speeds"
    );
    assert_eq!(run.found, ["the board has another program, of 500 bytes"]);
    let image = whole_image("paper");
    assert!(run.board.flash[..image.end()] == *image.bytes());
    assert!(run.board.flash[0x7800..] == BoardDouble::old_nano().flash[0x7800..]);
    assert!(run.board.has_started_program, "the program is started");
}

#[test]
fn a_byte_lost_on_the_way_to_an_old_nano_is_recovered_at_its_speed() {
    let (code, large) = (whole_image("paper"), robot_image("large"));
    let nano = |lost| {
        let mut board = BoardDouble::old_nano();
        board.flash[..code.end()].copy_from_slice(code.bytes());
        board.lost_byte_to_board = lost;
        run_with(board, &large)
    };
    let bytes = nano(None).board.received;
    assert!(bytes > 1000, "{bytes} bytes");
    for at in 0..bytes {
        let run = nano(Some(at));
        assert!(run.result.is_ok(), "byte {at}: {}", run.error());
        assert_eq!(
            robot_name(&run.board).as_deref(),
            Some("large"),
            "byte {at}"
        );
        assert!(
            run.board.resets <= 4,
            "byte {at}: {} resets",
            run.board.resets
        );
    }
}

#[test]
fn an_image_that_reaches_into_a_nanos_boot_section_is_refused() {
    // The robot with the most gaits in the repository.
    let image = whole_image("own-gaits");
    assert!(image.end() > 0x7800, "{:#x}", image.end());
    let refused = |mut board: BoardDouble, target: Target| {
        board.flash[..500].fill(9);
        let before = board.flash.clone();
        let run = run_as(board, &image, target);
        assert!(run.board.flash == before && run.board.written.is_empty());
        run.error()
    };
    let any = Target::default();
    let named = |model| Target {
        model: Some(model),
        may_be_nano: true,
    };
    let words = refused(BoardDouble::old_nano(), any);
    let needed = format!(
        "{} bytes of flash are needed, and a Nano has 30720",
        image.end()
    );
    assert!(words.starts_with(&needed), "{words}");
    assert!(words.ends_with("Nothing was written"), "{words}");
    assert_eq!(words, refused(BoardDouble::blank(), named(Model::Nano)));
    // A newer Nano answers like a UNO, and clones of the UNO have the same USB chip as a Nano.
    let in_doubt = Target {
        may_be_nano: true,
        ..any
    };
    let words = refused(BoardDouble::blank(), in_doubt);
    assert!(
        words.contains("; this board may be one, because of its USB chip. Nothing"),
        "{words}"
    );
    for target in [any, named(Model::Uno)] {
        let run = run_as(BoardDouble::blank(), &image, target);
        assert!(run.result.is_ok(), "{}", run.error());
    }
    // An image that fits a Nano, too, is written without a question.
    let run = run_as(BoardDouble::blank(), &whole_image("paper"), in_doubt);
    assert!(run.result.is_ok(), "{}", run.error());
}
