//! Tests of EEPROM writes: their content, their timing, and the record of the rest pose.

use super::*;

#[test]
fn nothing_is_written_before_the_supply_has_been_measured_or_while_it_is_low() {
    let robot = wake_and_run("rest", 2);
    assert_eq!(rest_pose_mark(&robot), 0xa5);
    let mut restarted_robot = robot.power_on_copy();
    let write_count = restarted_robot.board.memory.log.len();
    for _ in 0..60 {
        restarted_robot.read_lines();
        let safety = restarted_robot.main.control().safety();
        if safety.supply().measured_level().is_none() {
            assert_eq!(restarted_robot.board.memory.log.len(), write_count);
        }
        restarted_robot.run_frame();
    }
    let claim = "the pose is invalidated once the robot stands";
    assert_eq!(rest_pose_mark(&restarted_robot), 0xff, "{claim}");
    restarted_robot.send_and_run("rest", 10);
    restarted_robot.run_at_supply(4_400, 30);
    let write_count = restarted_robot.board.memory.log.len();
    restarted_robot.send_and_run("stand", 50);
    let new_count = restarted_robot.board.memory.log.len();
    assert_eq!(new_count, write_count, "nothing is written at 4.4 V");
    restarted_robot.expect_refused("save", "8 the supply is too low");
    restarted_robot.run_at_supply(5_000, 80);
    let claim = "the pose is invalidated once the supply is good";
    assert_eq!(rest_pose_mark(&restarted_robot), 0xff, "{claim}");
}

#[test]
fn a_falling_supply_ends_a_save_and_the_old_settings_stay() {
    let mut robot = wake_and_send(&["deadman 1000", "save", "deadman 2000"]);
    robot.board.memory.write_delay = 1;
    robot.board.send(b"save\r");
    for _ in 0..30 {
        robot.main.step(&mut robot.board);
    }
    assert!(robot.main.control().is_memory_in_use());
    set_board_supply(&mut robot, 4_400);
    for _ in 0..20 {
        // With only one step per frame, the main loop cannot access the memory.
        robot.board.tick();
        robot.main.step(&mut robot.board);
    }
    let printed_lines = robot.read_lines();
    let answer = "err 8 the supply is too low".to_string();
    assert!(printed_lines.contains(&answer), "{printed_lines:?}");
    let restarted_robot = robot.power_on_copy();
    assert_eq!(restarted_robot.main.control().settings().deadman_ms(), 1000);
}

#[test]
fn a_repeated_rest_writes_nothing_and_a_worn_memory_is_reported() {
    let mut robot = wake_and_run("rest", 2);
    let write_count = robot.board.memory.log.len();
    for _ in 0..50 {
        robot.send_and_run("rest", 2);
    }
    assert_eq!(robot.board.memory.log.len(), write_count);
    robot.send_and_run("stand", 50);
    robot.board.memory.is_worn = true;
    robot.board.send(b"rest\r");
    let printed_lines = robot.run_frames(3);
    let notice = "# memory: could not save the rest pose".to_string();
    assert!(printed_lines.contains(&notice), "{printed_lines:?}");
}

#[test]
fn after_power_on_servos_wake_one_by_one_in_the_rest_pose_before_the_robot_stands() {
    let mut robot = wake_and_run("pose 140 50 311 224.5", 150);
    robot.send_line("rest");
    let mut restarted_robot = robot.power_on_copy();
    restarted_robot.read_lines();
    restarted_robot.expect_status(&[("pose", "140.00,50.00,311.00,224.50")]);
    let rest_pulses = restarted_robot.motion().pose_pulses();
    for servo in 0..4 {
        for _ in 0..5 {
            let widths = run_frame_and_read_widths(&mut restarted_robot);
            for (index, width) in widths.into_iter().enumerate() {
                let awake_width = rest_pulses.0[index].0;
                let expected = if index < servo { awake_width } else { 0 };
                // The fifth of these frames wakes `servo`.
                let case = format!("A{} while A{} wakes", index + 1, servo + 1);
                assert!(width == expected || index == servo, "{case}");
            }
        }
    }
    restarted_robot.run_frames(200);
    restarted_robot.expect_status(&[("pose", &format_neutral_pose())]);
    // The robot has moved since its last rest, so no rest pose is saved.
    let moved_robot = restarted_robot.power_on_copy();
    assert_eq!(moved_robot.motion().pose(), &Pose::NEUTRAL);
}

#[test]
fn a_rest_before_the_first_pulse_after_power_on_leaves_the_saved_rest_pose_untouched() {
    let mut robot = wake_and_run("pose 140 50 311 224.5", 150);
    robot.send_and_run("rest", 2);
    let mut restarted_robot = robot.power_on_copy();
    let write_count = restarted_robot.board.memory.log.len();
    restarted_robot.send_and_run("rest", 50);
    assert_eq!(rest_pose_mark(&restarted_robot), 0xa5);
    assert_eq!(restarted_robot.board.memory.log.len(), write_count);
}

#[test]
fn the_rest_pose_is_invalidated_before_the_first_pulse() {
    let mut robot = wake_and_send(&["rest"]);
    assert_eq!(rest_pose_mark(&robot), 0xa5);
    robot.board.send(b"stand\r");
    // The main loop writes first the answer, then the memory, long before the first servo wakes.
    robot.read_lines();
    assert_eq!(rest_pose_mark(&robot), 0xff);
    assert_eq!(robot.run_frame(), Pulses::default());
}

#[test]
fn a_save_after_the_start_waits_at_most_half_a_second_for_the_measurement_of_the_supply() {
    let mut robot = RunningRobot::power_on(*Sample::asymmetric());
    robot.read_lines();
    robot.board.send(b"save\r");
    let printed_lines = robot.run_frames(5);
    assert!(printed_lines.is_empty(), "{printed_lines:?}");
    assert!(robot.board.memory.log.is_empty());
    assert_eq!(robot.run_frames(15), ["ok save"]);
    let mut unmeasured_robot =
        RunningRobot::with_flash(Sample::asymmetric().section(), VirtualBoard::default());
    unmeasured_robot.read_lines();
    unmeasured_robot.board.send(b"save\r");
    let printed_lines = unmeasured_robot.run_frames(30);
    assert_eq!(printed_lines, ["err 8 the supply is too low"]);
    assert!(unmeasured_robot.board.memory.log.is_empty());
}

#[test]
fn the_pose_in_which_a_low_supply_ended_the_pulses_is_saved_once_the_supply_is_good() {
    let walking_robot = wake_and_run("sway", 150);
    let mut rested_robot = wake_and_run("pose 140 50 311 224.5", 150);
    rested_robot.send_and_run("rest", 10);
    for mut robot in [walking_robot, rested_robot.power_on_copy()] {
        robot.run_at_supply(3_900, 40);
        assert!(robot.motion().is_resting());
        let pose = robot.status_value("pose");
        robot.run_at_supply(5_000, 100);
        assert_eq!(rest_pose_mark(&robot), 0xa5);
        assert_eq!(robot.power_on_copy().status_value("pose"), pose);
    }
}
