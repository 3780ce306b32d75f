//! Tests of uploads of a robot alone, in which the board keeps its code.

use super::*;

/// The robot.toml of the paper's robot.
const PAPER_TOML: &str = include_str!("../../../../../robots/paper.toml");

#[test]
fn the_first_page_of_a_robot_alone_is_blanked_first_and_written_last() {
    let run = run_with_image(board_with_robot("paper"), &robot_image("unequal"));
    let counts = run.result.expect("the image is written");
    let section = load_robot("unequal").section();
    let page_addresses = (0x6e00..0x6e00 + section.len()).step_by(128);
    let (written, page_count) = (counts.written, page_addresses.len());
    assert_eq!(written, page_count, "every page of the two robots differs");
    let expected_addresses: Vec<usize> = page_addresses.chain([0x6e00]).collect();
    assert_eq!(run.board.written_addresses, expected_addresses);
    let expected_image = firmware_image("unequal");
    assert!(run.board.flash[..expected_image.end_address()] == *expected_image.bytes());
    assert!(run.board.has_started_program, "the firmware is started");
    let contents = run.reported_contents;
    let is_reported_once = contents.len() == 1 && contents[0].contains(" robot paper ");
    assert!(is_reported_once, "{contents:?}");
}

#[test]
fn a_changed_gait_takes_less_than_a_second_on_the_serial_line() {
    let slower_toml = PAPER_TOML.replacen("period = 1.25", "period = 1.5", 1);
    assert_ne!(slower_toml, PAPER_TOML);
    let slower_robot = Robot::parse(&slower_toml).expect("the robot file is valid");
    let image = Image::robot_alone(slower_robot.section()).expect("the image fits");
    let run = run_with_image(board_with_robot("paper"), &image);
    let counts = run.result.expect("the image is written");
    assert!((1..=3).contains(&counts.written), "{counts:?}");
    // A byte takes ten bits on the line.
    let seconds = (run.board.received_count + run.board.sent_count) as f64 * 10.0 / 115_200.0;
    assert!((0.2..0.6).contains(&seconds), "{seconds} s");
}

#[test]
fn an_upload_of_the_robot_that_the_board_has_writes_no_page() {
    let run = run_with_image(board_with_robot("paper"), &robot_image("paper"));
    assert_eq!(run.result.expect("the upload succeeds").written, 0);
    assert!(run.board.written_addresses.is_empty() && run.board.has_started_program);
    let contents = run.reported_contents;
    assert!(contents[0].ends_with(" already"), "{contents:?}");
}

#[test]
fn after_an_interrupted_upload_the_firmware_finds_no_robot_until_the_next_upload() {
    let (old_flash, large) = (board_with_robot("own-gaits").flash, robot_image("large"));
    let code = old_flash[..0x6e00].to_vec();
    for page_count in 1..=large.pages().len() {
        let mut board = BoardDouble::with_program(&old_flash);
        board.unplugged_after_pages = Some(page_count);
        let interrupted_run = run_with_image(board, &large);
        let message = interrupted_run.error_message();
        assert!(message.starts_with("the port is gone"), "{message}");
        let is_state_named = message.contains("fault=robot and moves no servo");
        assert!(is_state_named, "{message}");
        let mut board = interrupted_run.board;
        assert!(board.flash[..0x6e00] == code, "the code is unchanged");
        let name = read_robot_name(&board);
        assert_eq!(name, None, "after {page_count} pages");
        board.unplugged_after_pages = None;
        let next_run = run_with_image(board, &large);
        let contents = &next_run.reported_contents;
        assert!(contents[0].contains(" without a robot"), "{contents:?}");
        assert!(next_run.result.is_ok(), "{}", next_run.error_message());
        assert_eq!(read_robot_name(&next_run.board).as_deref(), Some("large"));
    }
}

#[test]
fn an_upload_of_a_robot_alone_recovers_from_the_loss_of_any_byte() {
    let (old_flash, paper) = (board_with_robot("own-gaits").flash, robot_image("paper"));
    let expected_image = firmware_image("paper");
    let undisturbed_board = run_with_image(BoardDouble::with_program(&old_flash), &paper).board;
    let assert_recovery = |lost_byte: usize, lose_byte: &dyn Fn(&mut BoardDouble)| {
        let mut board = BoardDouble::with_program(&old_flash);
        lose_byte(&mut board);
        let run = run_with_image(board, &paper);
        run.assert_recovered(lost_byte);
        let is_written = run.board.flash[..expected_image.end_address()] == *expected_image.bytes();
        assert!(is_written, "byte {lost_byte}");
    };
    for lost_byte in 0..undisturbed_board.received_count {
        assert_recovery(lost_byte, &|board| {
            board.lost_byte_to_board = Some(lost_byte)
        });
    }
    for lost_byte in (0..undisturbed_board.sent_count).step_by(101) {
        assert_recovery(lost_byte, &|board| {
            board.lost_byte_from_board = Some(lost_byte)
        });
    }
}

#[test]
fn a_robot_alone_is_rejected_if_the_code_on_the_board_cannot_read_it() {
    let (paper_flash, large) = (board_with_robot("paper").flash, robot_image("large"));
    let error_after_change = |change: &dyn Fn(&mut BoardDouble)| {
        let mut board = BoardDouble::with_program(&paper_flash);
        change(&mut board);
        let old_flash = board.flash.clone();
        let run = run_with_image(board, &large);
        assert!(run.board.flash == old_flash && run.board.written_addresses.is_empty());
        run.error_message()
    };
    let reason = "a robot alone moves nothing: write the firmware, too. Nothing was written";
    assert_eq!(
        error_after_change(&|board| board.flash[..BOOT_ADDRESS].fill(0xff)),
        format!("the board has no program, and {reason}")
    );
    // Another sketch that is shorter than the firmware leaves the rest of the firmware in flash.
    assert_eq!(
        error_after_change(&|board| board.flash[..1000].fill(0x95)),
        format!("the board has another program, and {reason}")
    );
    assert_eq!(
        error_after_change(&|board| {
            board.flash[..PAGE_BYTES].fill(0xff);
            board.flash[..2].copy_from_slice(&IDLE_JUMP);
        }),
        format!("the board has an incomplete program, which does nothing, and {reason}")
    );
    let message = error_after_change(&|board| board.flash[ADDRESS + 4] += 1);
    assert!(
        message.ends_with(&format!(
            ", which reads robots of format {}; this robot has format {FORMAT}: write the \
             firmware, too. Nothing was written",
            FORMAT + 1
        )),
        "{message}"
    );
    assert!(message.starts_with("the board has lizard "), "{message}");
}
