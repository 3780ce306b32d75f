//! Tests of EEPROM writes: their content, their timing, and the record of the rest pose.
//!
//! Byte 128 of the EEPROM is the mark of this record: 0xa5 while a pose is saved, 0xff otherwise.

use super::*;

#[test]
fn nothing_is_written_before_the_supply_has_been_measured_or_while_it_is_low() {
    let dialogue = wake_and_run("rest", 2);
    assert_eq!(dialogue.board.memory.bytes()[128], 0xa5);
    let mut restarted_dialogue = dialogue.power_on_copy();
    let write_count = restarted_dialogue.board.memory.log.len();
    for _ in 0..60 {
        restarted_dialogue.read_lines();
        let safety = restarted_dialogue.main.control().safety();
        if safety.supply().measured_level().is_none() {
            assert_eq!(restarted_dialogue.board.memory.log.len(), write_count);
        }
        restarted_dialogue.run_frame();
    }
    let mark = restarted_dialogue.board.memory.bytes()[128];
    assert_eq!(mark, 0xff, "the pose is invalidated once the robot stands");
    restarted_dialogue.send_and_run("rest", 10);
    restarted_dialogue.run_at_supply(4_400, 30);
    let write_count = restarted_dialogue.board.memory.log.len();
    restarted_dialogue.send_and_run("stand", 50);
    let new_count = restarted_dialogue.board.memory.log.len();
    assert_eq!(new_count, write_count, "nothing is written at 4.4 V");
    restarted_dialogue.expect_refused("save", "8 the supply is too low");
    restarted_dialogue.run_at_supply(5_000, 80);
    let mark = restarted_dialogue.board.memory.bytes()[128];
    let claim = "the pose is invalidated once the supply is good";
    assert_eq!(mark, 0xff, "{claim}");
}

#[test]
fn a_falling_supply_ends_a_save_and_the_old_settings_stay() {
    let mut dialogue = wake_and_send(&["deadman 1000", "save", "deadman 2000"]);
    dialogue.board.memory.write_delay = 1;
    dialogue.board.send(b"save\r");
    for _ in 0..30 {
        dialogue.main.step(&mut dialogue.board);
    }
    assert!(dialogue.main.control().is_memory_in_use());
    set_supply(&mut dialogue, 4_400);
    for _ in 0..20 {
        // With only one step per frame, the main loop cannot access the memory.
        dialogue.board.tick();
        dialogue.main.step(&mut dialogue.board);
    }
    let printed_lines = dialogue.read_lines();
    let answer = "err 8 the supply is too low".to_string();
    assert!(printed_lines.contains(&answer), "{printed_lines:?}");
    let restarted_dialogue = dialogue.power_on_copy();
    let settings = restarted_dialogue.main.control().settings();
    assert_eq!(settings.deadman_ms(), 1000);
}

#[test]
fn a_repeated_rest_writes_nothing_and_a_worn_memory_is_reported() {
    let mut dialogue = wake_and_run("rest", 2);
    let write_count = dialogue.board.memory.log.len();
    for _ in 0..50 {
        dialogue.send_and_run("rest", 2);
    }
    assert_eq!(dialogue.board.memory.log.len(), write_count);
    dialogue.send_and_run("stand", 50);
    dialogue.board.memory.is_worn = true;
    dialogue.board.send(b"rest\r");
    let printed_lines = dialogue.run_frames(3);
    let notice = "# memory: could not save the rest pose".to_string();
    assert!(printed_lines.contains(&notice), "{printed_lines:?}");
}

#[test]
fn after_power_on_servos_wake_one_by_one_in_the_rest_pose_before_the_robot_stands() {
    let mut dialogue = wake_and_run("pose 140 50 311 224.5", 150);
    dialogue.send_line("rest");
    let mut restarted_dialogue = dialogue.power_on_copy();
    restarted_dialogue.read_lines();
    restarted_dialogue.expect_status(&[("pose", "140.00,50.00,311.00,224.50")]);
    let rest_pulses = restarted_dialogue.motion().pose_pulses();
    for servo in 0..4 {
        for _ in 0..5 {
            let widths = run_frame_and_read_widths(&mut restarted_dialogue);
            for (index, width) in widths.into_iter().enumerate() {
                let awake_width = rest_pulses.0[index].0;
                let expected = if index < servo { awake_width } else { 0 };
                // The fifth of these frames wakes `servo`.
                let case = format!("A{} while A{} wakes", index + 1, servo + 1);
                assert!(width == expected || index == servo, "{case}");
            }
        }
    }
    restarted_dialogue.run_frames(200);
    restarted_dialogue.expect_status(&[("pose", &format_neutral_pose())]);
    // The robot has moved since its last rest, so no rest pose is saved.
    let moved_dialogue = restarted_dialogue.power_on_copy();
    assert_eq!(moved_dialogue.motion().pose(), &Pose::NEUTRAL);
}

#[test]
fn the_rest_pose_is_invalidated_before_the_first_pulse() {
    let mut dialogue = wake_and_send(&["rest"]);
    assert_eq!(dialogue.board.memory.bytes()[128], 0xa5);
    dialogue.board.send(b"stand\r");
    // The main loop writes first the answer, then the memory, long before the first servo wakes.
    dialogue.read_lines();
    assert_eq!(dialogue.board.memory.bytes()[128], 0xff);
    assert_eq!(dialogue.run_frame(), Pulses::default());
}

#[test]
fn a_save_after_the_start_waits_at_most_half_a_second_for_the_measurement_of_the_supply() {
    let mut dialogue = Dialogue::power_on(*Sample::asymmetric());
    dialogue.read_lines();
    dialogue.board.send(b"save\r");
    let printed_lines = dialogue.run_frames(5);
    assert!(printed_lines.is_empty(), "{printed_lines:?}");
    assert!(dialogue.board.memory.log.is_empty());
    assert_eq!(dialogue.run_frames(15), ["ok save"]);
    let mut unmeasured_dialogue =
        Dialogue::with_flash(Sample::asymmetric().section(), VirtualBoard::default());
    unmeasured_dialogue.read_lines();
    unmeasured_dialogue.board.send(b"save\r");
    let printed_lines = unmeasured_dialogue.run_frames(30);
    assert_eq!(printed_lines, ["err 8 the supply is too low"]);
    assert!(unmeasured_dialogue.board.memory.log.is_empty());
}
