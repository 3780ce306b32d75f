//! EEPROM writes: their content, their timing, and the record of a rest.

use super::*;

#[test]
fn nothing_is_written_before_the_supply_has_been_measured_or_while_it_is_low() {
    let mut dialogue = wake_odd_robot();
    dialogue.send_line("rest");
    dialogue.run_frames(2);
    assert_eq!(dialogue.board.memory.bytes()[128], 0xa5);
    let eeprom = dialogue.board.memory.clone();
    let mut again = Dialogue::with_memory(*Sample::odd(), eeprom, Restart::NONE);
    let writes = again.board.memory.log.len();
    for _ in 0..60 {
        again.read_lines();
        let measured = again.main.control().safety().supply().measured_level();
        if measured.is_none() {
            assert_eq!(again.board.memory.log.len(), writes);
        }
        again.frame();
    }
    assert_eq!(again.board.memory.bytes()[128], 0xff, "it woke and stands");
    again.send_line("rest");
    again.run_frames(10);
    supply(&mut again, 4_400);
    again.run_frames(30);
    let writes = again.board.memory.log.len();
    again.expect_accepted("stand");
    again.run_frames(50);
    assert_eq!(again.board.memory.log.len(), writes, "a byte at 4.4 V");
    again.expect_refused("save", "8 the supply is too low");
    supply(&mut again, 5_000);
    again.run_frames(80);
    assert_eq!(again.board.memory.bytes()[128], 0xff, "forgotten later");
}

#[test]
fn a_save_during_a_low_supply_is_refused_and_the_old_settings_stay() {
    let mut dialogue = wake_odd_robot();
    dialogue.send_line("deadman 1000");
    dialogue.expect_accepted("save");
    dialogue.send_line("deadman 2000");
    dialogue.board.memory.slowness = 1;
    dialogue.board.send(b"save\r");
    for _ in 0..30 {
        dialogue.main.step(&mut dialogue.board);
    }
    assert!(dialogue.main.control().is_writing());
    supply(&mut dialogue, 4_400);
    let mut printed = Vec::new();
    for _ in 0..20 {
        // With one step per frame, the main loop has no time for the memory.
        dialogue.board.tick();
        dialogue.main.step(&mut dialogue.board);
    }
    printed.extend(dialogue.read_lines());
    assert!(
        printed.contains(&"err 8 the supply is too low".to_string()),
        "{printed:?}"
    );
    let eeprom = dialogue.board.memory.clone();
    let again = Dialogue::with_memory(*Sample::odd(), eeprom, Restart::NONE);
    assert_eq!(again.main.control().settings().deadman(), 1000);
}

#[test]
fn repeated_rests_write_nothing_and_a_worn_cell_is_reported() {
    let mut dialogue = wake_odd_robot();
    dialogue.send_line("rest");
    dialogue.run_frames(2);
    let writes = dialogue.board.memory.log.len();
    for _ in 0..50 {
        dialogue.expect_accepted("rest");
        dialogue.run_frames(2);
    }
    assert_eq!(dialogue.board.memory.log.len(), writes);
    dialogue.send_line("stand");
    dialogue.run_frames(50);
    dialogue.board.memory.is_worn = true;
    dialogue.board.send(b"rest\r");
    let printed = dialogue.run_frames(3);
    let notice = "# memory: does not keep the pose of this rest";
    assert!(printed.iter().any(|line| line == notice), "{printed:?}");
}

#[test]
fn a_robot_that_rested_wakes_where_it_rested_and_then_stands_without_a_leap() {
    let mut dialogue = wake_odd_robot();
    dialogue.send_line("pose 140 50 311 224.5");
    dialogue.run_frames(150);
    dialogue.send_line("rest");
    let eeprom = dialogue.board.memory.clone();
    let mut again = Dialogue::with_memory(*Sample::odd(), eeprom.clone(), Restart::default());
    again.read_lines();
    assert_eq!(again.status("pose"), "140.00,50.00,311.00,224.50");
    let there = again.motion().pose().pulses(again.motion().calibration());
    for servo in 0..4 {
        for _ in 0..5 {
            let widths = widths(&mut again);
            for (other, width) in widths.into_iter().enumerate() {
                let expected = if other < servo { there.0[other].0 } else { 0 };
                // The fifth of these frames wakes `servo`.
                assert!(width == expected || other == servo, "{servo} {other}");
            }
        }
    }
    again.run_frames(200);
    assert_eq!(again.status("pose"), neutral());
    // A robot that has moved no longer keeps the pose of its rest.
    let after = Dialogue::with_memory(
        *Sample::odd(),
        again.board.memory.clone(),
        Restart::default(),
    );
    assert_eq!(after.motion().pose(), &Pose::NEUTRAL);
}

#[test]
fn the_pose_of_a_rest_is_forgotten_before_the_first_pulse() {
    let mut dialogue = wake_odd_robot();
    dialogue.send_line("rest");
    assert_eq!(dialogue.board.memory.bytes()[128], 0xa5);
    dialogue.board.send(b"stand\r");
    // The answer is written first; then the main loop writes the memory, long before the first servo wakes.
    dialogue.read_lines();
    assert_eq!(dialogue.board.memory.bytes()[128], 0xff);
    assert_eq!(dialogue.frame(), Pulses::default());
}

#[test]
fn a_save_right_after_the_start_waits_at_most_half_a_second_for_the_supply() {
    let mut dialogue = Dialogue::power_on(*Sample::odd());
    dialogue.read_lines();
    dialogue.board.send(b"save\r");
    let printed = dialogue.run_frames(5);
    assert!(
        printed.is_empty() && dialogue.board.memory.log.is_empty(),
        "{printed:?}"
    );
    assert_eq!(dialogue.run_frames(15), ["ok save"]);
    let mut never = Dialogue::with_flash(Sample::odd().section(), VirtualBoard::default());
    never.read_lines();
    never.board.send(b"save\r");
    assert_eq!(never.run_frames(30), ["err 8 the supply is too low"]);
    assert!(never.board.memory.log.is_empty());
}
