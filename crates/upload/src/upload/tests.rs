//! Tests of uploads to a simulated board and boot loader.

use std::path::Path;

use lizard_core::numbers::mark::ADDRESS;
use lizard_robot::Robot;
use pollster::block_on;

use super::*;
use crate::contents::find_robot;
use crate::target::Model;
use board_double::BoardDouble;

mod board_double;
mod nano;
mod robot_alone;

/// The firmware's code, in Intel HEX.
pub(crate) const CODE: &str = include_str!("../../../../firmware/code.hex");

/// Creates an image of five pages, of which the last is partly filled. Each byte differs from its neighbours.
fn test_image() -> Image {
    let bytes = (0..600).map(|index| (index * 3 + 1) as u8);
    Image::new(bytes.collect()).expect("the image fits")
}

/// The page addresses of [`test_image`].
const PAGE_ADDRESSES: [usize; 5] = [0, 0x80, 0x100, 0x180, 0x200];

/// Creates a board whose flash holds [`test_image`].
fn board_with_image() -> BoardDouble {
    BoardDouble::with_program(test_image().bytes())
}

/// The result of an upload, its reported events, and the board afterwards.
struct UploadRun {
    result: Result<PageCounts, UploadError>,
    /// The descriptions of the board's contents.
    reported_contents: Vec<String>,
    retry_count: usize,
    board: BoardDouble,
}

/// Uploads [`test_image`] to a board.
fn run(board: BoardDouble) -> UploadRun {
    run_with_image(board, &test_image())
}

/// Uploads [`test_image`] to a board that has another program of 500 bytes, and to which `change` was applied first.
fn run_over_old_program(change: impl FnOnce(&mut BoardDouble)) -> UploadRun {
    let mut board = BoardDouble::with_program(&[9; 500]);
    change(&mut board);
    run(board)
}

/// Uploads an image to a board of unknown model.
fn run_with_image(board: BoardDouble, image: &Image) -> UploadRun {
    run_with_target(board, image, Target::default())
}

/// Uploads an image to a board about which `target` is known.
fn run_with_target(board: BoardDouble, image: &Image, target: Target) -> UploadRun {
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
    UploadRun {
        result,
        reported_contents,
        retry_count,
        board,
    }
}

impl UploadRun {
    /// Checks that the board has started [`test_image`] and still has its boot loader; returns the page counts.
    fn assert_written(&self) -> PageCounts {
        let counts = *self.result.as_ref().expect("the image is written");
        let (flash, blank) = (&self.board.flash, BoardDouble::blank().flash);
        assert_eq!(flash[..600], *test_image().bytes());
        let (loader, expected) = (&flash[0x7e00..], &blank[0x7e00..]);
        assert_eq!(loader, expected, "the boot loader is unchanged");
        assert!(self.board.has_started_program, "the program is started");
        counts
    }

    /// Checks that the upload succeeded although the byte with the index `lost_byte` was lost.
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

    /// True if the program starts with the idle loop.
    fn starts_with_idle_loop(&self) -> bool {
        self.board.flash[..2] == IDLE_JUMP
    }
}

/// Loads the robot file with the given name.
pub(crate) fn load_robot(name: &str) -> Robot {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots"));
    Robot::load(folder.join(format!("{name}.toml"))).expect("the robot file is valid")
}

/// Creates a board with the firmware and the named robot.
fn board_with_robot(name: &str) -> BoardDouble {
    BoardDouble::with_program(firmware_image(name).bytes())
}

/// Creates the image of the named robot alone.
fn robot_image(name: &str) -> Image {
    Image::robot_alone(load_robot(name).section()).expect("the image fits")
}

/// Reads the name of the robot that the firmware would load.
fn read_robot_name(board: &BoardDouble) -> Option<String> {
    let robot = find_robot(&board.flash[..BOOT_ADDRESS])?;
    Some(robot.name().map(char::from).collect())
}

/// Creates the image of the firmware with the named robot.
fn firmware_image(name: &str) -> Image {
    Image::firmware(CODE, &load_robot(name).section()).expect("the image fits")
}

#[test]
fn an_upload_to_a_blank_board_writes_exactly_the_pages_of_the_image() {
    let run = run(BoardDouble::blank());
    let counts = run.assert_written();
    assert_eq!((counts.written, counts.kept), (5, 0));
    assert_eq!(run.reported_contents, ["the board has no program"]);
    assert!(run.board.flash[0x280..0x7e00] == [0xff; 0x7e00 - 0x280]);
    assert_eq!((run.board.reset_count, run.retry_count), (1, 0));
}

#[test]
fn the_first_page_is_the_idle_loop_until_all_other_pages_are_written() {
    let run = run(BoardDouble::with_program(&[9; 5000]));
    run.assert_written();
    let contents = ["the board has another program, of 5000 bytes"];
    assert_eq!(run.reported_contents, contents);
    let expected_addresses = [&PAGE_ADDRESSES[..], &[0]].concat();
    assert_eq!(run.board.written_addresses, expected_addresses);
}

#[test]
fn an_upload_to_a_board_that_has_the_image_only_starts_the_program() {
    let run = run(board_with_image());
    let counts = run.assert_written();
    assert_eq!((counts.written, counts.kept), (0, 5));
    let contents = ["the board has this program already"];
    assert_eq!(run.reported_contents, contents);
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
fn a_loader_that_ignores_two_sync_requests_needs_no_second_reset() {
    let mut board = BoardDouble::blank();
    board.ignored_syncs_per_reset = 2;
    let run = run(board);
    run.assert_written();
    assert_eq!(run.board.reset_count, 1);
}

#[test]
fn output_of_the_old_program_before_the_answer_is_skipped() {
    // The output contains both bytes of a response, but never adjacent.
    let output = b"# t=1\r\n\x14\x15\x10ok\r\n".repeat(30);
    run_over_old_program(|board| board.old_program_output = output).assert_written();
}

#[test]
fn a_board_that_never_answers_is_reset_four_times_and_stays_unchanged() {
    let run = run_over_old_program(|board| board.is_mute = true);
    assert!(matches!(run.result, Err(UploadError::NoLoader)));
    let message = run.error_message();
    assert!(message.starts_with("no boot loader answers. Is it a UNO or a Nano?"));
    assert_eq!((run.board.reset_count, run.retry_count), (4, 3));
    assert!(run.board.written_addresses.is_empty());
}

#[test]
fn a_board_that_sends_without_end_is_not_mistaken_for_a_boot_loader() {
    let run = run_over_old_program(|board| board.sends_endlessly = true);
    assert!(matches!(run.result, Err(UploadError::NoLoader)));
    let result = block_on(identify(&mut Loader::new(run.board)));
    assert!(matches!(result, Err(UploadError::NoLoader)));
}

#[test]
fn identify_returns_the_kind_of_boot_loader_and_starts_the_program() {
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
    let (kind, has_started) = identify_board(board_with_other_chip);
    let message = kind.expect_err("the chip is not an ATmega328P");
    assert!(message.starts_with("the chip is an ATmega328 without P"));
    assert!(has_started);
    let mut unplugged_board = BoardDouble::blank();
    unplugged_board.unplugged_after_pages = Some(0);
    let (kind, _) = identify_board(unplugged_board);
    let message = kind.expect_err("the board is unplugged");
    assert!(message.starts_with("the port is gone"));
}

#[test]
fn a_board_with_another_chip_is_rejected_with_the_name_of_the_chip() {
    let error_for_signature = |signature| {
        let mut board = BoardDouble::blank();
        board.signature = signature;
        let run = run(board);
        assert!(run.board.written_addresses.is_empty());
        run.error_message()
    };
    assert_eq!(
        error_for_signature([0x1e, 0x95, 0x14]),
        "the chip is an ATmega328 without P (signature 1E 95 14); the firmware is for an ATmega328P \
         (signature 1E 95 0F). Nothing was written"
    );
    let message = error_for_signature([1, 2, 3]);
    assert!(message.starts_with("the chip is of an unknown type (signature 01 02 03)"));
}

#[test]
fn an_upload_recovers_from_the_loss_of_any_byte_to_the_board() {
    let byte_count = run_over_old_program(|_| {}).board.received_count;
    assert!(byte_count > 2000, "{byte_count} bytes");
    let image = test_image();
    for lost_byte in 0..byte_count {
        let run = run_over_old_program(|board| board.lost_byte_to_board = Some(lost_byte));
        run.assert_recovered(lost_byte);
        let flash = &run.board.flash;
        assert!(flash[..600] == *image.bytes(), "byte {lost_byte}");
        assert_eq!(
            run.reported_contents.len(),
            1,
            "byte {lost_byte}: the contents are reported once"
        );
    }
}

#[test]
fn an_upload_recovers_from_the_loss_of_any_byte_from_the_board() {
    let byte_count = run_over_old_program(|_| {}).board.sent_count;
    assert!(byte_count > 30_000, "{byte_count} bytes");
    // Loses every byte of the synchronisation and of the first pages. Later, steps of 101 bytes lose every byte of the
    // response to the command that reads a page, on some page.
    for lost_byte in (0..300).chain((300..byte_count).step_by(101)) {
        let run = run_over_old_program(|board| board.lost_byte_from_board = Some(lost_byte));
        run.assert_recovered(lost_byte);
        run.assert_written();
    }
}

#[test]
fn a_byte_that_flash_does_not_keep_is_reported_and_the_board_stays_idle() {
    let expected_byte = test_image().bytes()[0x85];
    let lowest_bit = expected_byte & expected_byte.wrapping_neg();
    let run = run_over_old_program(|board| board.stuck_bits = Some((0x85, lowest_bit)));
    let message = run.error_message();
    assert!(message.contains("the byte at address 0x0085"), "{message}");
    assert!(message.ends_with("write the program again"), "{message}");
    assert!(run.starts_with_idle_loop());
    assert_eq!(run.retry_count, 0, "another reset does not repair flash");
}

#[test]
fn a_board_unplugged_during_an_upload_stays_idle_until_the_next_upload() {
    for page_count in 1..=5 {
        let interrupted_run =
            run_over_old_program(|board| board.unplugged_after_pages = Some(page_count));
        let message = interrupted_run.error_message();
        assert!(message.starts_with("the port is gone"), "{message}");
        let is_state_named = message.contains("an incomplete program, which does nothing");
        assert!(is_state_named, "{message}");
        let is_idle = interrupted_run.starts_with_idle_loop();
        assert!(is_idle, "after {page_count} pages");
        let mut board = interrupted_run.board;
        board.unplugged_after_pages = None;
        run(board).assert_written();
    }
}

#[test]
fn a_board_unplugged_before_the_first_page_stays_unchanged() {
    let run = run_over_old_program(|board| board.unplugged_after_pages = Some(0));
    let message = run.error_message();
    assert!(message.ends_with("Nothing was written: the board is unchanged"));
    assert_eq!(run.board.flash[..500], [9; 500]);
}
