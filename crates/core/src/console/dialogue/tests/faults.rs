//! Tests of faults, which stop the robot, and of resets, after which it starts in a safe state.

use lizard_avr::Region;

use super::*;

#[test]
fn boot_is_executed_three_seconds_after_power_on_unless_a_byte_arrives() {
    let mut robot = wake_asymmetric_robot();
    for boot in ["sway left", "rest"] {
        robot.send_line(&format!("boot {boot}"));
        robot.expect_accepted("save");
        let mut unattended_robot = robot.power_on_copy();
        let printed_lines = unattended_robot.run_frames(149);
        assert_eq!(printed_lines.len(), 1, "{printed_lines:?}");
        let activity = unattended_robot.motion().activity();
        assert_eq!(activity, Activity::Gait(GaitId::STAND));
        assert_eq!(unattended_robot.run_frames(1), [format!("# boot: {boot}")]);
        unattended_robot.expect_status(&[("gait", &boot.replace(' ', "-"))]);
        let mut interrupted_robot = robot.power_on_copy();
        interrupted_robot.run_frames(100);
        interrupted_robot.board.send(b" ");
        interrupted_robot.run_frames(400);
        assert_eq!(interrupted_robot.status_value("gait"), "stand");
    }
}

#[test]
fn boot_is_not_executed_while_the_guard_holds_the_robot() {
    // The guard stops `stand` soon after the servos are awake.
    let robot = Sample::asymmetric().with_changes(|content| {
        let stray = GAIT_NAMES.iter().position(|name| *name == "stray");
        content.gaits[0].channels = content.gaits[stray.expect("`stray` is a gait")].channels;
    });
    let mut robot = wake_robot(robot);
    robot.expect_all_accepted(&["boot sway", "save"]);
    let mut unattended_robot = robot.power_on_copy();
    let printed_lines = unattended_robot.run_frames(300);
    assert_line_starts(&printed_lines, &["# lizard", "# held"]);
    unattended_robot.expect_status(&[("gait", "stop"), ("fault", "guard")]);
}

#[test]
fn without_a_robot_commands_that_need_one_are_refused_with_code_10() {
    let mut robot = RunningRobot::with_flash(Region::new(&[]), VirtualBoard::default());
    for line in ["stand", "pose 90 90 270 270", "cal", "walk 3", "watch 1"] {
        assert_eq!(robot.send_line(line), "err 10 no robot in the flash");
    }
    assert_eq!(robot.status_value("fault"), "robot");
}

#[test]
fn a_lost_link_ends_a_gait_and_is_reported() {
    let mut robot = wake_and_send(&["deadman 400", "sway"]);
    for _ in 0..30 {
        assert!(robot.run_frames(15).is_empty());
        robot.send_line("status");
    }
    let notice = "# fault: no command within the deadman time, stopped";
    assert_eq!(robot.run_frames(21), [notice]);
    robot.expect_status(&[("gait", "stop"), ("fault", "link")]);
    robot.send_line("sway");
    assert_eq!(robot.status_value("fault"), "none");
}

#[test]
fn lines_that_are_not_commands_do_not_keep_a_gait_going() {
    let garbled_line = [b'w', b'a', crate::console::line::GARBLED_BYTE, b'k', b'\n'];
    for line in [&b"OK+CONN\n"[..], b"walk 0\n", &garbled_line, b"nonsense\n"] {
        let mut robot = wake_and_send(&["deadman 400", "sway"]);
        for _ in 0..4 {
            robot.board.send(line);
            robot.run_frames(5);
        }
        robot.run_frames(3);
        assert_eq!(robot.status_value("fault"), "link", "{line:?}");
    }
}

#[test]
fn an_unfinished_line_is_dropped_after_the_deadman_time_without_a_byte() {
    for (deadman_ms, wait_frames, gait) in
        [(400, 19, "sway"), (400, 20, "stand"), (0, 2000, "sway")]
    {
        let mut robot = wake_and_send(&[&format!("deadman {deadman_ms}")]);
        robot.board.send(b"sway 1");
        robot.run_frames(wait_frames);
        // The link has broken within `sway 12`, and noise ends the line.
        robot.board.send(b"\n");
        let printed_lines = robot.run_frames(2);
        let case = format!("{deadman_ms} ms, {wait_frames} frames: {printed_lines:?}");
        assert_eq!(robot.status_value("gait"), gait, "{case}");
        // The next line is valid.
        assert_eq!(robot.send_line("swing"), "ok swing", "{case}");
    }
}

#[test]
fn each_byte_restarts_the_time_after_which_a_partial_line_is_dropped() {
    let mut robot = wake_and_send(&["deadman 400"]);
    for byte in b"sway 1" {
        robot.board.send(&[*byte]);
        robot.run_frames(19);
    }
    robot.board.send(b"\n");
    robot.run_frames(2);
    assert_eq!(robot.status_value("gait"), "sway");
}

#[test]
fn a_falling_supply_slows_the_gait_then_stops_it_then_ends_the_pulses() {
    let mut robot = wake_and_run("sway", 150);
    let full_advance = measure_phase_advance(&mut robot, 10);
    let printed_lines = robot.run_at_supply(4_400, 40);
    let line_end = format!("V, low: no saving, speed at most {SLOW_PACE}");
    let line = &printed_lines[0];
    let is_expected = line.starts_with("# supply: 4.") && line.ends_with(&line_end);
    assert!(is_expected, "{printed_lines:?}");
    let slow_advance = measure_phase_advance(&mut robot, 10);
    let slow_ratio = f64::from(slow_advance) / f64::from(full_advance);
    let expected_ratio = f64::from(SLOW_PACE) / 100.0;
    assert!((slow_ratio - expected_ratio).abs() < 0.02, "{slow_ratio}");
    robot.expect_refused("save", "8 the supply is too low");
    assert_eq!(robot.run_at_supply(4_200, 40).len(), 2);
    robot.expect_status(&[("gait", "stop"), ("fault", "supply")]);
    robot.expect_refused("sway", "8 ");
    robot.expect_refused(NEUTRAL_COMMAND, "8 ");
    robot.run_at_supply(4_000, 40);
    assert_eq!(robot.status_value("gait"), "rest");
    assert_eq!(robot.run_frame(), Pulses::default());
    let printed_lines = robot.run_at_supply(5_000, 100);
    let last_line = printed_lines.last().expect("the new level is reported");
    assert!(last_line.ends_with(" V, good"), "{printed_lines:?}");
    assert_eq!(robot.status_value("gait"), "rest");
    robot.expect_accepted("stand");
}

/// Returns the state of servos that hold a pose with the calibration of the asymmetric sample robot.
fn held_servo_state(sweeps: [i16; 4]) -> ServoState {
    let pose = Pose(sweeps.map(crate::numbers::units::Sweep));
    ServoState {
        is_resting: false,
        frames_awake: crate::motion::AWAKE_FRAMES,
        pose,
        sent_pulses: pose.pulses(&Sample::asymmetric().calibration()),
    }
}

/// Restarts the asymmetric sample robot with a copy of this memory.
fn restart_asymmetric_robot(memory: &Eeprom, restart: Restart) -> RunningRobot {
    RunningRobot::with_eeprom(*Sample::asymmetric(), memory.clone(), restart)
}

/// Returns the restart after a hang, which is reset number `reset_count` since power-on; `servo_state` is the state
/// before the hang.
fn restart_after_hang(reset_count: u8, servo_state: ServoState) -> Restart {
    Restart {
        cause: Cause::Watchdog,
        reset_count,
        servo_state_before: Some(servo_state),
        ..Restart::NONE
    }
}

#[test]
fn a_robot_that_has_hung_holds_its_pose_and_reports_the_hang() {
    let servo_state = held_servo_state([400, -300, 200, -100]);
    let restart = restart_after_hang(3, servo_state);
    let mut robot = restart_asymmetric_robot(&Eeprom::blank(), restart);
    let printed_lines = robot.run_frames(1);
    let notice = "# fault: the program hung and was restarted".to_string();
    assert!(printed_lines.contains(&notice), "{printed_lines:?}");
    for _ in 0..400 {
        let pulses = robot.run_frame();
        let claim = "the robot holds its pose from the first frame on";
        assert_eq!(pulses, servo_state.sent_pulses, "{claim}");
    }
    robot.expect_status(&[("reset", "watchdog"), ("resets", "3")]);
    assert_eq!(robot.status_value("fault"), "watchdog");
    robot.send_and_run("stand", 100);
    robot.expect_status(&[("fault", "none"), ("pose", &format_neutral_pose())]);
}

#[test]
fn after_a_reset_in_an_unsafe_or_unreachable_pose_the_robot_rests() {
    // The first pose is beyond the travel of A1; the second is within every travel, but unsafe.
    for sweeps in [[30_000, 0, 0, 0], [-6803, 7663, 0, 0]] {
        for cause in [Cause::Watchdog, Cause::External] {
            let restart = Restart {
                cause,
                ..restart_after_hang(1, held_servo_state(sweeps))
            };
            let mut robot = restart_asymmetric_robot(&Eeprom::blank(), restart);
            for _ in 0..140 {
                assert_eq!(robot.run_frame(), Pulses::default());
            }
            assert_eq!(robot.status_value("gait"), "rest");
            robot.send_and_run("stand", 50);
            assert_eq!(robot.status_value("pose"), format_neutral_pose());
        }
    }
}

#[test]
fn after_a_reset_in_a_pose_outside_the_saved_limits_the_robot_rests() {
    let robot = wake_and_send(&["limit 1 115 160", "save"]);
    // A1 at its neutral 132.37 deg plus 30 deg is safe, but beyond the saved limit of 160 deg.
    let restart = restart_after_hang(1, held_servo_state([5461, 0, 0, 0]));
    for (memory, gait) in [(&Eeprom::blank(), "stop"), (&robot.board.memory, "rest")] {
        let mut restarted_robot = restart_asymmetric_robot(memory, restart);
        restarted_robot.run_frames(10);
        assert_eq!(restarted_robot.status_value("gait"), gait);
    }
}

#[test]
fn unsaved_settings_are_undone_at_the_slew_limit_after_a_reset() {
    for (setting, servo, cause) in [
        ("trim 1 15", 0, Cause::Watchdog),
        ("trim 4 -15", 3, Cause::External),
        ("scale 2 12", 1, Cause::External),
        ("dir 3 -", 2, Cause::BrownOut),
    ] {
        let mut robot = wake_and_run("pose 140 50 311 224.5", 100);
        robot.send_and_run(setting, 100);
        let mut last_pulses = robot.run_frame();
        robot.reset(cause);
        let calibration = *robot.motion().calibration();
        let sweep_per_frame = robot.motion().robot().slew().per_frame;
        let mut moving_frame_count = 0;
        for _ in 0..200 {
            let pulses = robot.run_frame();
            let pulse_pairs = pulses.0.iter().zip(&mut last_pulses.0);
            for (index, (pulse, last_pulse)) in pulse_pairs.enumerate() {
                if pulse.0 == 0 {
                    continue;
                }
                let max_change = calibration[index].max_width_change(sweep_per_frame);
                let change = pulse.0.abs_diff(last_pulse.0);
                let number = index + 1;
                let case =
                    format!("{setting} A{number}: {change} cycles, at most {max_change} allowed");
                assert!(change <= max_change + 1, "{case}");
                moving_frame_count += usize::from(index == servo && change > 0);
                *last_pulse = *pulse;
            }
        }
        assert!(moving_frame_count > 3, "{setting} has not been undone");
        assert_eq!(last_pulses, robot.motion().pose().pulses(&calibration));
    }
}

#[test]
fn servos_still_wake_one_at_a_time_after_a_reset_during_waking() {
    for cause in [Cause::Watchdog, Cause::External, Cause::BrownOut] {
        for frames in 1..25 {
            let mut robot = wake_and_run("rest", 10);
            robot.send_and_run("stand", frames);
            let mut had_pulses = robot.run_frame().0.map(|width| width.0 > 0);
            robot.reset(cause);
            if cause != Cause::Watchdog {
                had_pulses = [false; 4];
            }
            for _ in 0..60 {
                let has_pulses = robot.run_frame().0.map(|width| width.0 > 0);
                let woken_servos = (0..4).filter(|servo| has_pulses[*servo] && !had_pulses[*servo]);
                assert!(woken_servos.count() <= 1, "{cause:?} after {frames} frames");
                had_pulses = has_pulses;
            }
            assert_eq!(had_pulses, [true; 4]);
        }
    }
}

#[test]
fn a_resting_robot_rests_after_a_reset_until_boot_and_a_hang_cancels_boot() {
    for cause in [Cause::Watchdog, Cause::External, Cause::BrownOut] {
        let mut robot = wake_and_run("pose 140 50 311 224.5", 150);
        robot.send_and_run("rest", 5);
        let memory_bytes = *robot.board.memory.bytes();
        robot.reset(cause);
        robot.board.memory.log.clear();
        for _ in 0..149 {
            assert_eq!(robot.run_frame(), Pulses::default(), "{cause:?}");
        }
        assert_eq!(*robot.board.memory.bytes(), memory_bytes, "{cause:?}");
        let is_unwritten = robot.board.memory.log.is_empty();
        assert!(is_unwritten, "the rest pose is already saved");
        // `boot` is set to `stand`; a hang cancels it.
        let printed_lines = robot.run_frames(1);
        let has_booted = printed_lines.iter().any(|line| line == "# boot: stand");
        assert_eq!(has_booted, cause != Cause::Watchdog, "{printed_lines:?}");
        assert_eq!(robot.status_value("pose"), "140.00,50.00,311.00,224.50");
    }
}

#[test]
fn a_reset_that_interrupts_the_write_of_a_rest_pose_does_not_lose_the_pose() {
    for cause in [Cause::Watchdog, Cause::External, Cause::BrownOut] {
        let mut robot = wake_and_run("pose 140 50 311 224.5", 150);
        robot.board.memory.write_delay = 4;
        robot.board.memory.is_timed = true;
        robot.board.send(b"rest\r");
        robot.run_frame();
        robot.reset(cause);
        assert_eq!(rest_pose_mark(&robot), 0xff, "{cause:?}");
        robot.run_frames(100);
        let pose = robot.power_on_copy().status_value("pose");
        assert_eq!(pose, "140.00,50.00,311.00,224.50");
    }
}

#[test]
fn after_three_consecutive_brown_outs_or_button_resets_the_robot_rests_until_stand() {
    // A boot loader hides the cause of a reset, so with a boot loader a press of the button counts as a brown-out.
    for (has_boot_loader, cause) in [
        (false, Cause::BrownOut),
        (true, Cause::BrownOut),
        (true, Cause::External),
    ] {
        let mut robot = wake_asymmetric_robot();
        robot.board.has_boot_loader = has_boot_loader;
        robot.read_lines();
        for reset_count in 1..=5 {
            robot.reset(cause);
            let printed_lines = robot.run_frames(17);
            let is_resting = robot.run_frame() == Pulses::default();
            assert_eq!(is_resting, reset_count >= 3, "{reset_count}");
            let notice =
                "# fault: reset several times in a row by the button or a weak supply, resting";
            let has_notice = printed_lines.iter().any(|line| line == notice);
            assert_eq!(has_notice, reset_count >= 3);
        }
        robot.run_frames(300);
        assert_eq!(robot.run_frame(), Pulses::default(), "boot is cancelled");
        assert_eq!(robot.status_value("fault"), "brownout");
        robot.expect_refused("sway", "7 ");
        robot.send_and_run("stand", 30);
        robot.reset(Cause::BrownOut);
        robot.run_frames(30);
        let has_pulses = robot.run_frame() != Pulses::default();
        assert!(has_pulses, "`stand` clears the count of resets");
    }
}

#[test]
fn resets_followed_by_a_line_do_not_count_as_brown_outs() {
    let mut robot = wake_asymmetric_robot();
    robot.board.has_boot_loader = true;
    for _ in 0..20 {
        robot.reset(Cause::External);
        robot.run_frames(30);
        assert_eq!(robot.status_value("fault"), "none");
        assert_ne!(robot.run_frame(), Pulses::default());
    }
}

#[test]
fn a_line_before_all_servos_are_awake_does_not_clear_the_count_of_resets() {
    let mut robot = wake_asymmetric_robot();
    robot.board.has_boot_loader = true;
    for reset_count in 1..=3 {
        robot.reset(Cause::External);
        robot.run_frames(5);
        let fault = if reset_count < 3 { "none" } else { "brownout" };
        assert_eq!(robot.status_value("fault"), fault, "{reset_count}");
        // The third servo wakes.
        robot.run_frames(10);
    }
}

#[test]
fn brown_outs_half_a_minute_apart_do_not_count_as_consecutive() {
    let mut robot = wake_asymmetric_robot();
    for _ in 0..6 {
        robot.reset(Cause::BrownOut);
        robot.run_frames(1501);
        assert_ne!(robot.run_frame(), Pulses::default());
    }
}

#[test]
fn a_run_without_a_robot_keeps_the_state_of_the_servos() {
    for rests in [false, true] {
        let mut robot = wake_and_run("pose 140 50 311 224.5", 150);
        if rests {
            robot.send_and_run("rest", 20);
        }
        let section = robot.motion().robot().section();
        let pulses = *robot.motion().sent_pulses();
        let memory_bytes = *robot.board.memory.bytes();
        // An interrupted upload of the robot, then a complete one.
        for flash in [Region::new(&[]), section] {
            robot.board.reset(Cause::External);
            robot = RunningRobot::with_flash(flash, robot.board);
            robot.run_frames(3);
        }
        assert_eq!(robot.motion().is_resting(), rests);
        assert_eq!(*robot.motion().sent_pulses(), pulses);
        assert_eq!(robot.status_value("pose"), "140.00,50.00,311.00,224.50");
        if rests {
            assert_eq!(*robot.board.memory.bytes(), memory_bytes);
        }
    }
}
