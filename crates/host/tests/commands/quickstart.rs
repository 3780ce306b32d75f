//! Tests that docs/quickstart.md shows the firmware's actual answers and messages.

use lizard_core::virtual_board::RunningRobot;
use lizard_robot::Robot;

use crate::harness::{assert_contains, read_file};

/// Returns true if a line matches the page's line, in which a final `...` stands for any text.
fn matches_page(line: &str, page_line: &str) -> bool {
    page_line
        .strip_suffix("...")
        .map_or(line == page_line, |prefix| line.starts_with(prefix))
}

#[test]
fn every_example_line_of_the_quickstart_gets_the_answer_on_the_page() {
    let page = read_file("docs/quickstart.md");
    // The board has the paper's robot, a 5 V supply, and a blank EEPROM.
    let robot = Robot::parse(&read_file("robots/paper.toml")).expect("the robot file is valid");
    let mut board = RunningRobot::power_on(*robot.firmware());
    let greeting = board.run_frames(50);
    // The first line is the banner, which the page shortens.
    assert!(greeting.len() > 1, "{greeting:?}");
    for line in &greeting[1..] {
        assert!(page.contains(line), "{line}");
    }
    let mut command_count = 0;
    for block in page.split("```text\n").skip(1) {
        let (block, _) = block.split_once("```").expect("the block has an end");
        for exchange in block.split("> ").skip(1) {
            let lines: Vec<&str> = exchange.lines().collect();
            let (command, page_lines) = lines.split_first().expect("a line follows the prompt");
            let mut answer_lines = board.send(format!("{command}\r").as_bytes());
            // After 100 frames, all motion has ended.
            answer_lines.extend(board.run_frames(100));
            let mut line_pairs = answer_lines.iter().zip(page_lines);
            let is_as_shown = answer_lines.len() == page_lines.len()
                && line_pairs.all(|(line, page_line)| matches_page(line, page_line));
            assert!(
                is_as_shown,
                "{command}\n  expected {page_lines:#?}\n  got {answer_lines:#?}"
            );
            command_count += 1;
        }
    }
    assert!(command_count > 20, "{command_count} commands");
}

#[test]
fn the_firmware_prints_every_message_of_the_troubleshooting_table() {
    let page = read_file("docs/quickstart.md");
    let messages = read_file("crates/core/src/console/text.rs");
    let table = page.split_once("## Troubleshooting");
    let (_, table) = table.expect("the page has a troubleshooting table");
    let mut is_code_listed = [false; 10];
    let mut row_count = 0;
    for row in table.lines().filter(|line| line.starts_with('|')) {
        row_count += 1;
        for quoted in row.split('`').skip(1).step_by(2) {
            let message = if let Some(refusal) = quoted.strip_prefix("err ") {
                let (code, reason) = refusal.split_at(1);
                is_code_listed[code.parse::<usize>().expect("a refusal has a code")] = true;
                reason
            } else if quoted.starts_with("# ") {
                quoted
            } else {
                continue;
            };
            for phrase in message.split("...") {
                assert_contains(&messages, phrase.trim_matches([' ', ',']));
            }
        }
    }
    assert!(row_count > 17, "{row_count} rows");
    assert!(
        !is_code_listed[0] && is_code_listed[1..].iter().all(|is_listed| *is_listed),
        "codes in the table: {is_code_listed:?}"
    );
}
