//! Tests of uploads to a simulated board and boot loader.

use std::path::Path;
use std::time::Duration;

use lizard_core::numbers::mark::ADDRESS;

use lizard_robot::Robot;
use pollster::block_on;

use super::*;
use crate::board::BoardError;
use crate::contents::robot_in;
use crate::target::Model;
use double::BoardDouble;

mod alone;
mod double;
mod nano;

/// The code of the firmware, in Intel HEX.
pub(crate) const CODE: &str = include_str!("../../../../firmware/code.hex");

/// An image of five pages, the last one partly filled.
fn image() -> Image {
    Image::new(pattern_bytes(600, 3)).expect("the image fits")
}

/// The addresses of the pages of [`image`].
const PAGE_ADDRESSES: [usize; 5] = [0, 0x80, 0x100, 0x180, 0x200];

/// Bytes that differ from their neighbours.
fn pattern_bytes(count: usize, factor: usize) -> Vec<u8> {
    (0..count).map(|index| (index * factor + 1) as u8).collect()
}

/// A board whose flash holds [`image`].
fn board_with_image() -> BoardDouble {
    BoardDouble::with(image().bytes())
}

/// The result of an upload, the events that it reported, and the board afterwards.
struct Run {
    result: Result<PageCounts, UploadError>,
    /// The descriptions of the board's contents.
    reported_contents: Vec<String>,
    retry_count: usize,
    board: BoardDouble,
}

/// Uploads [`image`] to a board.
fn run(board: BoardDouble) -> Run {
    run_with(board, &image())
}

/// Uploads an image to a board about which nothing is known.
fn run_with(board: BoardDouble, image: &Image) -> Run {
    run_with_target(board, image, Target::default())
}

/// Uploads an image to a board; `target` holds the facts that are known before the boot loader answers.
fn run_with_target(board: BoardDouble, image: &Image, target: Target) -> Run {
    let mut loader = Loader::new(board);
    let (mut reported_contents, mut retry_count) = (Vec::new(), 0);
    let mut report = |event: Event<'_>| match event {
        Event::Found(contents) => reported_contents.push(contents.to_string()),
        Event::Retry { .. } => retry_count += 1,
        Event::Progress(_, done, total) => {
            assert!((1..=total).contains(&done), "{done} of {total}");
        }
    };
    let result = block_on(upload(&mut loader, image, target, &mut report));
    let board = loader.into_board();
    Run {
        result,
        reported_contents,
        retry_count,
        board,
    }
}

impl Run {
    /// Checks that the board has [`image`], has started it, and still has its boot loader; returns the page counts.
    fn assert_written(&self) -> PageCounts {
        let counts = *self.result.as_ref().expect("the image is written");
        let (flash, blank) = (&self.board.flash, BoardDouble::blank().flash);
        assert_eq!(flash[..600], pattern_bytes(600, 3));
        assert_eq!(
            flash[0x7e00..],
            blank[0x7e00..],
            "the boot loader is unchanged"
        );
        assert!(self.board.has_started_program, "the program is started");
        counts
    }

    #[track_caller]
    fn assert_recovered(&self, lost_byte: usize) {
        if let Err(error) = &self.result {
            panic!("byte {lost_byte}: {error}");
        }
    }

    fn error_message(&self) -> String {
        let error = self.result.as_ref().expect_err("the image is not written");
        error.to_string()
    }

    /// True if the program is an endless loop: `rjmp .-2`.
    fn starts_in_a_loop(&self) -> bool {
        self.board.flash[..2] == [0xff, 0xcf]
    }
}

/// The robot of the robot file with this name.
pub(crate) fn robot(name: &str) -> Robot {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots"));
    Robot::load(folder.join(format!("{name}.toml"))).expect("the robot file is valid")
}

/// A board with the firmware and the robot of this name.
fn board_with_robot(name: &str) -> BoardDouble {
    BoardDouble::with(firmware_image(name).bytes())
}

/// The image of a robot alone, that of the robot file with this name.
fn robot_image(name: &str) -> Image {
    Image::robot_alone(robot(name).section()).expect("the image fits")
}

/// The name of the robot that the firmware would load.
fn robot_name(board: &BoardDouble) -> Option<String> {
    robot_in(&board.flash[..BOOT_ADDRESS]).map(|robot| robot.robot_name().map(char::from).collect())
}

/// The firmware's image with the robot of the robot file with this name.
fn firmware_image(name: &str) -> Image {
    Image::firmware(CODE, &robot(name).section()).expect("the image fits")
}

#[test]
fn a_blank_board_gets_every_page_of_the_image_and_no_other() {
    let run = run(BoardDouble::blank());
    let counts = run.assert_written();
    assert_eq!((counts.written, counts.kept), (5, 0));
    assert_eq!(run.reported_contents, ["the board has no program"]);
    assert!(run.board.flash[0x280..0x7e00] == [0xff; 0x7e00 - 0x280]);
    assert_eq!((run.board.reset_count, run.retry_count), (1, 0));
}

#[test]
fn the_first_page_is_a_loop_that_does_nothing_until_all_others_are_written() {
    let run = run(BoardDouble::with(&[9; 5000]));
    run.assert_written();
    assert_eq!(
        run.reported_contents,
        ["the board has another program, of 5000 bytes"]
    );
    assert_eq!(
        run.board.written_addresses,
        [&PAGE_ADDRESSES[..], &[0]].concat()
    );
}

#[test]
fn a_board_that_has_the_image_is_only_started() {
    let run = run(board_with_image());
    let counts = run.assert_written();
    assert_eq!((counts.written, counts.kept), (0, 5));
    assert_eq!(
        run.reported_contents,
        ["the board has this program already"]
    );
    assert!(run.board.written_addresses.is_empty());
}

#[test]
fn only_pages_that_differ_are_written() {
    let mut board = board_with_image();
    board.flash[0x105] ^= 1;
    let run = run(board);
    let counts = run.assert_written();
    assert_eq!(run.board.written_addresses, [0, 0x100, 0]);
    assert_eq!((counts.written, counts.kept), (2, 3));
}

#[test]
fn a_loader_that_answers_only_the_third_call_needs_no_second_reset() {
    let mut board = BoardDouble::blank();
    board.ignored_calls_per_reset = 2;
    let run = run(board);
    run.assert_written();
    assert_eq!(run.board.reset_count, 1);
}

#[test]
fn output_of_the_old_program_before_the_answer_is_skipped() {
    let mut board = BoardDouble::with(&[9; 500]);
    // The output contains both bytes of an answer, but not next to each other.
    board.old_program_output = b"# t=1\r\n\x14\x15\x10ok\r\n".repeat(30);
    run(board).assert_written();
}

#[test]
fn a_board_that_never_answers_is_reset_four_times_and_not_written() {
    let mut board = BoardDouble::with(&[9; 500]);
    board.is_mute = true;
    let run = run(board);
    assert!(matches!(run.result, Err(UploadError::NoLoader)));
    let message = run.error_message();
    assert!(message.starts_with("no boot loader answers. Is it a UNO or a Nano?"));
    assert_eq!((run.board.reset_count, run.retry_count), (4, 3));
    assert!(run.board.written_addresses.is_empty());
}

#[test]
fn a_board_that_never_stops_sending_is_not_taken_for_a_boot_loader() {
    /// A board that sends `x` without end.
    struct Talker;
    impl Board for Talker {
        async fn reset(&mut self, _baud: u32) -> Result<(), BoardError> {
            Ok(())
        }
        async fn write(&mut self, _bytes: &[u8]) -> Result<(), BoardError> {
            Ok(())
        }
        async fn read(&mut self, bytes: &mut [u8], _time: Duration) -> Result<usize, BoardError> {
            bytes.fill(b'x');
            Ok(bytes.len())
        }
        async fn discard(&mut self, _time: Duration) -> Result<(), BoardError> {
            Ok(())
        }
    }
    let mut loader = Loader::new(Talker);
    let (image, target) = (image(), Target::default());
    let result = block_on(upload(&mut loader, &image, target, &mut |_| {}));
    assert!(matches!(result, Err(UploadError::NoLoader)));
    let result = block_on(identify(&mut loader));
    assert!(matches!(result, Err(UploadError::NoLoader)));
}

#[test]
fn a_board_is_identified_by_its_boot_loader_and_restarted() {
    let identify_board = |board: BoardDouble| {
        let mut loader = Loader::new(board);
        let kind = block_on(identify(&mut loader));
        let board = loader.into_board();
        assert!(board.written_addresses.is_empty());
        let kind = kind.map_err(|error| error.to_string());
        (kind, board.has_started_program)
    };
    for (board, kind) in [
        (board_with_image(), LoaderKind::Optiboot),
        (BoardDouble::old_nano(), LoaderKind::AtmegaBoot),
    ] {
        assert_eq!(identify_board(board), (Ok(kind), true));
    }
    let mut board_with_other_chip = BoardDouble::blank();
    board_with_other_chip.signature = [0x1e, 0x95, 0x14];
    let (refusal, has_started) = identify_board(board_with_other_chip);
    assert!(
        has_started
            && refusal.is_err_and(
                |message| message.starts_with("the chip is an ATmega328, not an ATmega328P")
            )
    );
    let mut unplugged_board = BoardDouble::blank();
    unplugged_board.unplugged_after_pages = Some(0);
    assert!(
        identify_board(unplugged_board)
            .0
            .is_err_and(|message| message.starts_with("the port is gone"))
    );
}

#[test]
fn another_chip_is_named_and_not_written() {
    let error_for_signature = |signature| {
        let mut board = BoardDouble::blank();
        board.signature = signature;
        let run = run(board);
        assert!(run.board.written_addresses.is_empty());
        run.error_message()
    };
    assert_eq!(
        error_for_signature([0x1e, 0x95, 0x14]),
        "the chip is an ATmega328, not an ATmega328P (signature 1E 95 14); the firmware is for an \
         ATmega328P (signature 1E 95 0F). Nothing was written"
    );
    assert!(error_for_signature([1, 2, 3]).starts_with("the chip is unknown (signature 01 02 03)"));
}

#[test]
fn an_upload_recovers_from_the_loss_of_any_byte_to_the_board() {
    let old_contents = [9; 500];
    let undisturbed_board = run(BoardDouble::with(&old_contents)).board;
    assert!(
        undisturbed_board.received_count > 2000,
        "{} bytes",
        undisturbed_board.received_count
    );
    for lost_byte in 0..undisturbed_board.received_count {
        let mut board = BoardDouble::with(&old_contents);
        board.lost_byte_to_board = Some(lost_byte);
        let run = run(board);
        run.assert_recovered(lost_byte);
        let flash = &run.board.flash;
        assert!(flash[..600] == pattern_bytes(600, 3), "byte {lost_byte}");
        assert_eq!(
            run.reported_contents.len(),
            1,
            "byte {lost_byte}: the contents are reported once"
        );
    }
}

#[test]
fn an_upload_recovers_from_the_loss_of_any_byte_from_the_board() {
    let old_contents = [9; 500];
    let undisturbed_board = run(BoardDouble::with(&old_contents)).board;
    assert!(
        undisturbed_board.sent_count > 30_000,
        "{} bytes",
        undisturbed_board.sent_count
    );
    // Loses each byte of the call and of the first pages; then, in steps of 101 bytes, each byte of a page's answer for
    // some page.
    for lost_byte in (0..300).chain((300..undisturbed_board.sent_count).step_by(101)) {
        let mut board = BoardDouble::with(&old_contents);
        board.lost_byte_from_board = Some(lost_byte);
        let run = run(board);
        run.assert_recovered(lost_byte);
        run.assert_written();
    }
}

#[test]
fn a_byte_that_the_flash_does_not_keep_is_named_and_the_board_does_nothing() {
    let mut board = BoardDouble::with(&[9; 500]);
    let expected_byte = image().bytes()[0x85];
    board.stuck_bits = Some((0x85, expected_byte & expected_byte.wrapping_neg()));
    let run = run(board);
    let message = run.error_message();
    assert!(message.contains("the byte at address 0x0085"), "{message}");
    assert!(message.ends_with("write it again"), "{message}");
    assert!(run.starts_in_a_loop());
    assert_eq!(run.retry_count, 0, "another reset does not repair flash");
}

#[test]
fn a_board_unplugged_during_an_upload_does_nothing_until_the_next_upload() {
    for pages in 1..=5 {
        let mut board = BoardDouble::with(&[9; 500]);
        board.unplugged_after_pages = Some(pages);
        let interrupted_run = run(board);
        let message = interrupted_run.error_message();
        assert!(message.starts_with("the port is gone"), "{message}");
        assert!(
            message.contains("half a program now, and does nothing"),
            "{message}"
        );
        assert!(interrupted_run.starts_in_a_loop(), "after {pages} pages");
        let mut board = interrupted_run.board;
        board.unplugged_after_pages = None;
        run(board).assert_written();
    }
}

#[test]
fn a_board_unplugged_before_the_first_page_is_unchanged() {
    let mut board = BoardDouble::with(&[9; 500]);
    board.unplugged_after_pages = Some(0);
    let run = run(board);
    let message = run.error_message();
    assert!(message.ends_with("Nothing was written: the board is unchanged"));
    assert_eq!(run.board.flash[..500], [9; 500]);
}
