//! Tests of the settings, most of which calibrate servos: changing, saving and loading them.

use super::*;
use crate::memory::copies::COPY_ADDRESSES;
use crate::numbers::part::Servo;
use crate::numbers::units::Sweep;

/// Sends `cal` and returns the lines of its answer.
fn read_cal(robot: &mut RunningRobot) -> Vec<String> {
    robot.send(b"cal\r")
}

#[test]
fn cal_prints_all_settings_independently_of_the_motion() {
    let mut robot = wake_asymmetric_robot();
    let initial_lines = read_cal(&mut robot);
    assert_eq!(initial_lines.len(), 7);
    assert!(initial_lines[0].starts_with("# A1 trim 0.00 limit 61.37 215.36 dir "));
    let last_lines = ["# boot stand", "# deadman 0", "ok cal"];
    assert_eq!(initial_lines[4..], last_lines);
    robot.expect_all_accepted(&["trim 1 -3.25", "limit 2 350 130.5", "dir 3 -"]);
    robot.expect_all_accepted(&["scale 4 9.87", "boot sway left", "deadman 1500"]);
    let printed_lines = read_cal(&mut robot);
    let has_settings = printed_lines[0].starts_with("# A1 trim -3.25 limit 61.37 215.36 dir ")
        && printed_lines[1].starts_with("# A2 trim 0.00 limit 350.00 130.50 dir ")
        && printed_lines[2].contains(" dir - scale ")
        && printed_lines[3].ends_with(" scale 9.87");
    assert!(has_settings, "{printed_lines:?}");
    let last_lines = ["# boot sway left", "# deadman 1500", "ok cal"];
    assert_eq!(printed_lines[4..], last_lines);
    robot.send_and_run("sway", 77);
    assert_eq!(read_cal(&mut robot), printed_lines);
    robot.expect_accepted("factory");
    assert_eq!(read_cal(&mut robot), initial_lines);
}

#[test]
fn only_saved_settings_survive_a_loss_of_power() {
    let mut robot = wake_and_send(&["trim 2 4", "save"]);
    let saved_lines = read_cal(&mut robot);
    robot.send_line("trim 2 5");
    assert_ne!(read_cal(&mut robot), saved_lines);
    let mut restarted_robot = robot.power_on_copy();
    let printed_lines = restarted_robot.read_lines();
    assert_eq!(printed_lines.len(), 1, "only the banner is printed");
    assert_eq!(read_cal(&mut restarted_robot), saved_lines);
    // `load` restores the saved settings without a power cycle.
    robot.expect_accepted("load");
    assert_eq!(read_cal(&mut robot), saved_lines);
}

#[test]
fn load_before_the_first_save_and_save_to_a_worn_memory_are_refused() {
    let mut robot = wake_asymmetric_robot();
    robot.expect_refused("load", "9 no saved calibration to load");
    robot.board.memory.is_worn = true;
    robot.expect_refused("save", "9 the memory write failed");
    robot.expect_accepted("stand");
}

#[test]
fn a_calibration_moves_only_its_servo_and_at_most_at_the_slew_limit() {
    for change in [
        "trim 1 20",
        "trim 1 -12.5",
        "scale 1 8",
        "dir 1 -",
        "dir 1 +",
        "load",
        "factory",
    ] {
        let mut robot = wake_asymmetric_robot();
        match change {
            "factory" => robot.expect_accepted("trim 1 15"),
            "load" => robot.expect_all_accepted(&["trim 1 -15", "save", "factory"]),
            _ => {}
        }
        robot.run_frames(100);
        robot.send_and_run("pose 145 50 311 224.5", 150);
        let widths_before = run_frame_and_read_widths(&mut robot);
        robot.expect_accepted(change);
        let motion = robot.motion();
        let expected_widths = motion.pose_pulses().0.map(|width| width.0);
        let gain = f64::from(motion.calibration()[0].gain).abs() / 16384.0;
        let max_change = f64::from(motion.robot().slew().per_frame) * gain;
        let mut last_widths = widths_before;
        for _ in 0..200 {
            let new_widths = run_frame_and_read_widths(&mut robot);
            let width_change = f64::from(new_widths[0].abs_diff(last_widths[0]));
            assert!(width_change <= max_change.max(1.0), "{change}");
            assert_eq!(new_widths[1..], widths_before[1..], "{change}");
            last_widths = new_widths;
        }
        assert_eq!(last_widths, expected_widths, "{change}");
        assert_eq!(robot.status_value("pose"), "145.00,50.00,311.00,224.50");
    }
}

#[test]
fn a_calibration_interrupts_a_gait_until_the_pulses_have_settled() {
    let mut robot = wake_and_run("sway", 120);
    let phase_before = robot.motion().phase();
    robot.send_and_run("trim 2 15", 1);
    assert_eq!(robot.motion().phase(), phase_before);
    robot.run_frames(200);
    assert_eq!(robot.status_value("gait"), "sway");
    assert_ne!(robot.motion().phase(), phase_before);
    let motion = robot.motion();
    assert_eq!(*motion.sent_pulses(), motion.pose_pulses());
}

#[test]
fn limits_too_narrow_for_the_gaits_or_the_pose_are_refused() {
    let mut robot = wake_asymmetric_robot();
    let lines_before = read_cal(&mut robot);
    for line in [
        "limit 1 140 215",
        "limit 1 61.37 132",
        "limit 2 131 350",
        "limit 3 309 310",
    ] {
        let message = robot.send_line(line);
        assert!(message.starts_with("err 3 A"), "{line}: {message}");
        assert!(message.contains("'s travel must cover the gaits' range, "));
        assert_eq!(read_cal(&mut robot), lines_before);
    }
    robot.expect_accepted("pose 150 47.91 309.64 226.18");
    let message = "err 3 A1's travel must cover its current and target angles; send stand first";
    // The refusals come while `stand` brakes, in the move to the pose, and in the pose.
    for frames in [2, 10, 150] {
        robot.run_frames(frames);
        assert_eq!(robot.send_line("limit 1 61.37 149"), message);
        assert_eq!(read_cal(&mut robot), lines_before);
    }
    assert_eq!(robot.status_value("pose"), "150.00,47.91,309.64,226.18");
    robot.send_and_run("stand", 150);
    robot.expect_accepted("limit 1 61.37 149");
    robot.expect_refused("pose 150 47.91 309.64 226.18", "3 A1 must be 61.37..149.00");
}

#[test]
fn a_refused_factory_or_load_command_changes_nothing() {
    let mut robot = wake_and_send(&["trim 1 10", "limit 1 61.37 149", "save"]);
    robot.expect_accepted("limit 1 61.37 215.36");
    robot.send_and_run("pose 155 47.91 309.64 226.18", 150);
    let lines_before = read_cal(&mut robot);
    robot.expect_refused("load", "3 A1's travel must cover its current");
    assert_eq!(read_cal(&mut robot), lines_before);
    let mut trimmed_robot = wake_and_send(&["trim 3 4"]);
    let lines_before = read_cal(&mut trimmed_robot);
    trimmed_robot.board.memory.bytes_mut()[0] = 0;
    trimmed_robot.expect_refused("load", "9 no saved calibration to load");
    assert_eq!(read_cal(&mut trimmed_robot), lines_before);
    // Saved settings with a wrong CRC, which ends at byte 44, are not loaded, and the current ones stay.
    let robot = wake_and_send(&["save"]);
    trimmed_robot.board.memory = robot.board.memory.clone();
    trimmed_robot.board.memory.bytes_mut()[44] ^= 1;
    trimmed_robot.expect_refused("load", "9 ");
    assert_eq!(read_cal(&mut trimmed_robot), lines_before);
    // A trim shifts the travel: the pose below is within the shifted travel, but outside robot.toml's travel.
    let narrow_max = Sweep(2200);
    let robot =
        Sample::asymmetric().with_changes(|content| content.calibration[0].travel_max = narrow_max);
    let mut narrow_robot = wake_robot(robot);
    narrow_robot.expect_accepted("trim 1 -5");
    narrow_robot.send_and_run("limit 1 67 149", 100);
    narrow_robot.send_and_run("pose 146 47.91 309.64 226.18", 150);
    let lines_before = read_cal(&mut narrow_robot);
    narrow_robot.expect_refused("factory", "3 A1's travel must cover its current");
    assert_eq!(read_cal(&mut narrow_robot), lines_before);
}

#[test]
fn saved_settings_are_loaded_only_if_their_travel_covers_the_gaits() {
    for servo in Servo::ALL {
        for (min_excess, max_excess, is_loaded) in [(1, 1, true), (-1, 0, false), (0, -1, false)] {
            let mut robot = wake_asymmetric_robot();
            let sample = Sample::asymmetric();
            let mut settings = Settings::for_robot(&sample);
            let mut adjustment = settings.adjustment(servo);
            let needed_travel = sample.needed_travel(servo);
            adjustment.travel_min = Sweep(needed_travel.min.0 - min_excess);
            adjustment.travel_max = Sweep(needed_travel.max.0 + max_excess);
            settings.set_adjustment(servo, adjustment);
            let write_job = COPY_ADDRESSES[0].start_write();
            write_job.complete(settings.bytes(), &mut robot.board.memory);
            let lines_before = read_cal(&mut robot);
            let answer = robot.send_line("load");
            let is_refused = answer == "err 9 no saved calibration to load";
            assert_eq!(is_refused, !is_loaded, "{servo:?}: {answer}");
            let is_unchanged = read_cal(&mut robot) == lines_before;
            assert_eq!(is_unchanged, is_refused, "{servo:?}");
        }
    }
}

#[test]
fn center_leads_to_the_neutral_pulses_of_robot_toml_despite_trims() {
    let mut robot = wake_and_send(&["trim 1 3", "trim 2 -4.5", "trim 3 2", "trim 4 -1"]);
    robot.run_frames(100);
    robot.expect_refused("center 1", "2 ");
    robot.send_and_run("center", 200);
    let widths = run_frame_and_read_widths(&mut robot);
    for (width, servo) in widths.into_iter().zip(Sample::asymmetric().calibration()) {
        let neutral = servo.neutral_width.0;
        assert!(width.abs_diff(neutral) <= 1, "{width} for {neutral}");
    }
    robot.send_and_run("stand", 200);
    let motion = robot.motion();
    let neutral_pulses = Pose::NEUTRAL.pulses(motion.calibration());
    assert_eq!(motion.sent_pulses(), &neutral_pulses);
}

#[test]
fn boot_starts_the_named_gait_even_if_other_names_are_similar() {
    let names = ["walk 1", "walk 2", "walk 3", "walk 4"];
    let robot = names
        .into_iter()
        .fold(Sample::asymmetric(), Sample::with_gait);
    for name in names {
        let mut robot = RunningRobot::power_on(*robot);
        robot.run_frames(30);
        robot.expect_all_accepted(&[&format!("boot {name}"), "save"]);
        let mut restarted_robot = robot.power_on_copy();
        restarted_robot.run_frames(151);
        restarted_robot.expect_status(&[("gait", &name.replace(' ', "-"))]);
    }
}

#[test]
fn limits_that_exclude_the_target_pose_are_refused() {
    let mut robot = wake_and_run("sway left", 150);
    // This pose is outside the range of all gaits. The gait brakes first, so the move to the pose has not begun yet.
    robot.send_and_run("pose 152 50 311 224.5", 2);
    robot.expect_refused("limit 1 115 150", "3 A1's travel must cover its current");
    robot.run_frames(300);
    assert_eq!(robot.status_value("pose"), "152.00,50.00,311.00,224.50");
    robot.send_and_run("stand", 200);
    robot.expect_accepted("limit 1 115 150");
}

#[test]
fn after_a_calibration_a_gait_accelerates_gradually_to_full_pace() {
    let mut robot = wake_and_run("sway left", 150);
    let full_advance = measure_phase_advance(&mut robot, 1);
    robot.send_line("trim 2 3");
    let advances = [(); 100].map(|()| measure_phase_advance(&mut robot, 1));
    let first_moving_frame = advances.iter().position(|advance| *advance > 0);
    let first_moving_frame = first_moving_frame.expect("the gait continues");
    assert!(first_moving_frame > 0, "{advances:?}");
    let first_advance = advances[first_moving_frame];
    assert!(first_advance < full_advance / 4, "{advances:?}");
    assert_eq!(advances.last(), Some(&full_advance));
}
