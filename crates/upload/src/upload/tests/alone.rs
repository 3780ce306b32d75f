//! A robot that is written alone, while the board keeps its code.

use super::*;

const PAPER: &str = include_str!("../../../../../robots/paper.toml");

#[test]
fn a_robot_alone_is_written_with_its_first_page_blank_first_and_filled_last() {
    let run = run_with(with_robot("paper"), &robot_image("unequal"));
    let done = run.result.expect("it is written");
    let section = robot("unequal").section();
    let pages: Vec<usize> = (0x6e00..0x6e00 + section.len()).step_by(128).collect();
    assert_eq!(done.written, pages.len(), "each byte of the robots differs");
    let order = [&pages[..], &[0x6e00]].concat();
    assert_eq!(run.board.written, order);
    let whole = whole_image("unequal");
    assert!(run.board.flash[..whole.end()] == *whole.bytes());
    assert!(run.board.has_started_program, "the firmware is started");
    let [found] = &run.found[..] else {
        panic!("{:?}", run.found)
    };
    assert!(found.contains(" robot paper "), "{found}");
}

#[test]
fn a_gait_that_changes_costs_less_than_a_second_of_the_line() {
    let slower = PAPER.replacen("period = 1.25", "period = 1.5", 1);
    assert_ne!(slower, PAPER);
    let slower = lizard_robot::Robot::parse(&slower).expect("it is right");
    let run = run_with(
        with_robot("paper"),
        &Image::robot_alone(slower.section()).expect("it fits"),
    );
    let done = run.result.expect("it is written");
    assert!((1..=3).contains(&done.written), "{done:?}");
    // A byte takes ten bits on the line.
    let seconds = (run.board.received + run.board.sent) as f64 * 10.0 / 115_200.0;
    assert!((0.2..0.6).contains(&seconds), "{seconds} s");
}

#[test]
fn a_robot_that_the_board_has_is_not_written() {
    let run = run_with(with_robot("paper"), &robot_image("paper"));
    assert_eq!(run.result.expect("it is right").written, 0);
    assert!(run.board.written.is_empty() && run.board.has_started_program);
    assert!(run.found[0].ends_with(" already"), "{:?}", run.found);
}

#[test]
fn after_a_cable_is_pulled_the_firmware_finds_no_robot_until_the_next_upload() {
    let (before, large) = (with_robot("own-gaits").flash, robot_image("large"));
    let code = before[..0x6e00].to_vec();
    for written in 1..=large.pages().len() {
        let mut board = BoardDouble::with(&before);
        board.unplugged_after = Some(written);
        let cut = run_with(board, &large);
        let words = cut.error();
        assert!(words.starts_with("the port is gone"), "{words}");
        assert!(words.contains("fault=robot and moves no servo"), "{words}");
        assert!(cut.board.flash[..0x6e00] == code, "the code");
        assert_eq!(robot_name(&cut.board), None, "after {written} pages");
        let mut board = cut.board;
        board.unplugged_after = None;
        let mended = run_with(board, &large);
        assert!(
            mended.found[0].contains(" without a robot"),
            "{:?}",
            mended.found
        );
        assert!(mended.result.is_ok(), "{}", mended.error());
        assert_eq!(robot_name(&mended.board).as_deref(), Some("large"));
    }
}

#[test]
fn any_one_byte_lost_while_a_robot_is_written_is_recovered() {
    let (before, paper) = (with_robot("own-gaits").flash, robot_image("paper"));
    let right = whole_image("paper");
    let whole = run_with(BoardDouble::with(&before), &paper).board;
    let assert_recovered = |run: &Run, at: usize| {
        assert!(run.result.is_ok(), "byte {at}: {}", run.error());
        assert!(
            run.board.flash[..right.end()] == *right.bytes(),
            "byte {at}"
        );
    };
    for at in 0..whole.received {
        let mut board = BoardDouble::with(&before);
        board.lost_byte_to_board = Some(at);
        assert_recovered(&run_with(board, &paper), at);
    }
    for at in (0..whole.sent).step_by(101) {
        let mut board = BoardDouble::with(&before);
        board.lost_byte_from_board = Some(at);
        assert_recovered(&run_with(board, &paper), at);
    }
}

#[test]
fn a_robot_alone_is_refused_if_the_code_on_the_board_cannot_read_it() {
    let (before, large) = (with_robot("paper").flash, robot_image("large"));
    let refused = |change: &dyn Fn(&mut BoardDouble)| {
        let mut board = BoardDouble::with(&before);
        change(&mut board);
        let before = board.flash.clone();
        let run = run_with(board, &large);
        assert!(run.board.flash == before && run.board.written.is_empty());
        run.error()
    };
    let reason = "a robot alone moves nothing: write the firmware, too. Nothing was written";
    assert_eq!(
        refused(&|board| board.flash[..BOOT_ADDRESS].fill(0xff)),
        format!("the board has no program, and {reason}")
    );
    // Another sketch, shorter than the firmware; the rest of the firmware is still there.
    assert_eq!(
        refused(&|board| board.flash[..1000].fill(0x95)),
        format!("the board has another program, and {reason}")
    );
    assert_eq!(
        refused(&|board| {
            board.flash[..PAGE_BYTES].fill(0xff);
            board.flash[..2].copy_from_slice(&IDLE_JUMP);
        }),
        format!("the board has half a program, which does nothing, and {reason}")
    );
    let words = refused(&|board| board.flash[ADDRESS + 4] += 1);
    assert!(
        words.ends_with(&format!(
            ", whose robots are of format {}; this robot is of format {FORMAT}: write the \
             firmware, too. Nothing was written",
            FORMAT + 1
        )),
        "{words}"
    );
    assert!(words.starts_with("the board has lizard "), "{words}");
}
