use super::*;
use crate::drive::console::test_double::{PAPER_TOML, connect_paper_robot, read_calibration};
use lizard_core::virtual_board::RunningRobot;
use lizard_robot::STILL_FRAMES;

/// Presses the keys in order; returns true if the guide is finished after the last key.
fn press_keys<P: Read + Write>(guide: &mut Guide<'_, P>, keys: &[Key]) -> bool {
    let mut is_done = false;
    for key in keys {
        is_done = guide.press_key(*key).expect("the robot answers");
    }
    is_done
}

/// Checks that the title of the current step contains `part`.
#[track_caller]
fn assert_title<P: Read + Write>(guide: &Guide<'_, P>, part: &str) {
    assert!(guide.view().title.contains(part), "{:?}", guide.view());
}

const CONFIRM_SIGN_KEYS: [Key; 2] = [Key::Act, Key::Yes];

#[test]
fn a_complete_calibration_saves_signs_and_trims() {
    let mut link = connect_paper_robot();
    let [min, max] = read_calibration(&mut link).servos[0].limit;
    let mut guide = Guide::new(&mut link).expect("the robot answers");
    press_keys(&mut guide, &[Key::Next, Key::Next]);
    press_keys(&mut guide, &CONFIRM_SIGN_KEYS);
    assert_title(&guide, "which way does A2, front right turn");
    press_keys(&mut guide, &[Key::Act, Key::No, Key::Act, Key::Yes]);
    press_keys(&mut guide, &CONFIRM_SIGN_KEYS.repeat(2));
    assert_title(&guide, "straighten A1");
    press_keys(&mut guide, &[Key::LeftRight(0.5); 2]);
    press_keys(&mut guide, &[Key::UpDown(-0.1), Key::Next]);
    press_keys(&mut guide, &[Key::LeftRight(-0.5)]);
    press_keys(&mut guide, &[Key::Next; 3]);
    assert_title(&guide, "scales and limits");
    press_keys(&mut guide, &[Key::Next, Key::Back, Key::Next, Key::Act]);
    guide.read_messages().expect("the robot answers");
    assert!(guide.view().instructions[1].starts_with("The robot walks"));
    press_keys(&mut guide, &[Key::Next]);
    let settings_line =
        format!("    A1, front left  sign +  trim +0.90  limits {min:.2} to {max:.2}  scale 10.00");
    let view = guide.view();
    assert!(view.instructions.contains(&settings_line), "{view:?}");
    // The space bar has no effect in this step.
    press_keys(&mut guide, &[Key::Act]);
    assert!(!guide.has_saved());
    assert!(!press_keys(&mut guide, &[Key::Next]));
    assert!(guide.has_saved(), "{:?}", guide.view());
    press_keys(&mut guide, &[Key::Back]);
    let is_finished = press_keys(&mut guide, &[Key::Leave]);
    assert!(is_finished, "the guide is finished");
    assert!(guide.has_saved(), "the saved calibration stays");
    assert_eq!(read_calibration(&mut link).servos[0].trim, 0.9);
    link.command("factory").expect("the line is accepted");
    link.command("load").expect("the calibration was saved");
    let loaded = read_calibration(&mut link);
    assert_eq!(loaded.servos[0].trim, 0.9);
    assert_eq!(loaded.servos[1].trim, -0.5);
    assert_eq!(loaded.servos[1].dir, '-');
    assert_eq!(loaded.servos[2].dir, '+');
}

#[test]
fn the_notes_after_a_banner_do_not_replace_the_message_about_the_reset() {
    let mut link = connect_paper_robot();
    let mut guide = Guide::new(&mut link).expect("the robot answers");
    guide.robot.console().port().reset();
    guide.read_messages().expect("the robot answers");
    let view = guide.view();
    assert!(view.message.starts_with("The board was reset"), "{view:?}");
}

#[test]
fn cancelling_restores_the_calibration_and_saves_nothing() {
    let mut keys = vec![Key::Next, Key::Next, Key::Act, Key::No, Key::Act, Key::Yes];
    keys.extend(CONFIRM_SIGN_KEYS.repeat(3));
    keys.push(Key::LeftRight(4.0));
    keys.extend([Key::Next; 5]);
    keys.push(Key::Act);
    for length in [1, 4, 13, 19] {
        let mut link = connect_paper_robot();
        link.command("trim 1 2.50").expect("the line is accepted");
        link.command("boot walk").expect("the line is accepted");
        let before = read_calibration(&mut link);
        let mut guide = Guide::new(&mut link).expect("the robot answers");
        press_keys(&mut guide, &keys[..length]);
        assert!(press_keys(&mut guide, &[Key::Leave]), "after {length} keys");
        assert_eq!(read_calibration(&mut link), before, "after {length} keys");
        let status = link.ask("status").expect("the robot answers").answer;
        assert!(status.starts_with("ok gait=stand"), "{status}");
        let load = link.ask("load").expect("the robot answers").answer;
        assert!(load.starts_with("err 9"), "nothing was saved: {load}");
    }
}

#[test]
fn reversing_a_sign_keeps_the_neutral_pulse() {
    let mut link = connect_paper_robot();
    link.command("trim 1 3").expect("the line is accepted");
    let mut guide = Guide::new(&mut link).expect("the robot answers");
    press_keys(&mut guide, &[Key::Next, Key::Next, Key::Act, Key::No]);
    assert_eq!(guide.robot.calibration().servos[0].trim, -3.0);
    let settings = read_calibration(&mut link).servos[0];
    assert_eq!((settings.trim, settings.dir), (-3.0, '-'));
}

#[test]
fn the_sign_step_needs_a_movement_of_one_servo_before_the_answer() {
    let mut link = connect_paper_robot();
    let mut guide = Guide::new(&mut link).expect("the robot answers");
    press_keys(&mut guide, &[Key::Next, Key::Next, Key::Yes]);
    assert!(guide.view().message.contains("space bar first"));
    press_keys(&mut guide, &[Key::Next]);
    assert_title(&guide, "A1"); // no step is skipped
    press_keys(&mut guide, &[Key::Act]);
    let status = link.ask("status").expect("the robot answers").answer;
    let pose = "pose=148.59,41.41,318.59,221.41";
    assert!(status.contains(pose), "{status}");
}

#[test]
fn a_motion_shows_before_the_robot_counts_as_standing() {
    // Includes the slowest valid robot and the smallest turn per key press.
    let slow_robot = PAPER_TOML.replacen("\nslew = 300.0", "\nslew = 10.0", 1);
    assert_ne!(slow_robot, PAPER_TOML);
    for (robot_toml, degrees) in [
        (PAPER_TOML, 10.0),
        (PAPER_TOML, 0.1),
        (slow_robot.as_str(), 10.0),
        (slow_robot.as_str(), 0.1),
    ] {
        let robot = lizard_robot::Robot::parse(robot_toml).expect("the robot.toml is valid");
        let mut running = RunningRobot::power_on(*robot.firmware());
        running.run_frames(200);
        let before = running.status_value("pose");
        let [a1, a2, a3, a4] = robot.servos().map(|servo| servo.neutral);
        let line = format!("pose {:.2} {a2:.2} {a3:.2} {a4:.2}", a1 + degrees);
        assert!(running.send_line(&line).starts_with("ok pose"), "{line}");
        let unchanged_frames = (0..100).take_while(|_| {
            running.run_frames(1);
            running.status_value("pose") == before
        });
        let unchanged_frame_count = unchanged_frames.count() as u64;
        assert!(
            unchanged_frame_count + 2 < STILL_FRAMES,
            "{degrees} deg: {unchanged_frame_count} frames show no motion"
        );
    }
}

#[test]
fn a_refused_trim_is_shown_and_changes_nothing() {
    let mut link = connect_paper_robot();
    let mut guide = Guide::new(&mut link).expect("the robot answers");
    press_keys(&mut guide, &[Key::Back, Key::Next, Key::Next]);
    press_keys(&mut guide, &CONFIRM_SIGN_KEYS.repeat(4));
    press_keys(&mut guide, &[Key::LeftRight(19.9), Key::LeftRight(0.5)]);
    let view = guide.view();
    let refusal = "The robot refuses `trim 1 20.40`: err 3 trim must";
    assert!(view.message.starts_with(refusal), "{view:?}");
    let trim_line = "    trim +19.90 deg".to_owned();
    assert!(view.instructions.contains(&trim_line), "{view:?}");
    press_keys(&mut guide, &[Key::Back]);
    assert_title(&guide, "which way does A4");
}

#[test]
fn a_reset_is_reported_and_the_lost_trim_is_no_longer_shown() {
    let mut link = connect_paper_robot();
    let mut guide = Guide::new(&mut link).expect("the robot answers");
    press_keys(&mut guide, &[Key::Next, Key::Next, Key::Act]);
    let old_settings = guide.robot.calibration().servos[0];
    guide.robot.console().port().reset();
    press_keys(&mut guide, &[Key::No]);
    let view = guide.view();
    assert!(view.message.starts_with("The board was reset"), "{view:?}");
    assert_eq!(guide.robot.calibration().servos[0], old_settings);

    press_keys(&mut guide, &CONFIRM_SIGN_KEYS.repeat(4));
    press_keys(&mut guide, &[Key::LeftRight(0.5)]);
    guide.robot.console().port().reset();
    press_keys(&mut guide, &[Key::Next]);
    let view = guide.view();
    assert!(view.message.starts_with("The board was reset"), "{view:?}");
    assert_eq!(guide.robot.calibration().servos[0].trim, 0.0);

    // `save` stores the shown settings, not those that the board has loaded.
    press_keys(&mut guide, &[Key::Back, Key::LeftRight(0.5)]);
    press_keys(&mut guide, &[Key::Next; 6]);
    assert_title(&guide, "save");
    guide.robot.console().port().reset();
    press_keys(&mut guide, &[Key::Next]);
    assert!(guide.has_saved(), "{:?}", guide.view());
    link.command("load").expect("the calibration was saved");
    assert_eq!(read_calibration(&mut link).servos[0].trim, 0.5);
}

/// Returns the keys from the first step to the scale of A1.
fn keys_to_first_scale() -> Vec<Key> {
    let mut keys = vec![Key::Next, Key::Next];
    keys.extend(CONFIRM_SIGN_KEYS.repeat(4));
    keys.extend([Key::Next; 4]);
    keys.push(Key::Yes);
    keys
}

#[test]
fn a_scale_correction_keeps_the_neutral_pulse() {
    let mut link = connect_paper_robot();
    link.command("trim 1 2.00").expect("the line is accepted");
    let mut guide = Guide::new(&mut link).expect("the robot answers");
    press_keys(&mut guide, &keys_to_first_scale());
    assert_title(&guide, "how far does A1, front left turn");
    press_keys(&mut guide, &[Key::LeftRight(0.5)]);
    assert!(guide.view().message.contains("space bar first"));
    press_keys(&mut guide, &[Key::Act]);
    let moved_degrees = guide.moved_degrees.expect("the servo has moved");
    assert!(moved_degrees.abs() >= 20.0, "{moved_degrees}");
    // Makes four corrections of half a degree each.
    press_keys(&mut guide, &[Key::LeftRight(0.5); 4]);
    let expected = 10.0 * (1.0 + 0.5 / moved_degrees).powi(4);
    let settings = read_calibration(&mut link).servos[0];
    assert!((settings.scale - expected).abs() < 0.03, "{settings:?}");
    // The neutral pulse is unchanged.
    let pulse_offset = settings.trim * settings.scale;
    assert!((pulse_offset - 20.0).abs() < 0.2, "{settings:?}");
}

#[test]
fn limits_move_at_most_to_the_travel_that_the_gaits_need() {
    let mut link = connect_paper_robot();
    let before = read_calibration(&mut link).servos[0];
    let mut guide = Guide::new(&mut link).expect("the robot answers");
    press_keys(&mut guide, &keys_to_first_scale());
    press_keys(&mut guide, &[Key::Next; 4]);
    assert_title(&guide, "how far may A1, front left turn");
    // With Shift, an arrow stands for 0.1 degrees, but moves the same limit by 1 degree.
    press_keys(&mut guide, &[0.5, 0.1, 0.5].map(Key::LeftRight));
    press_keys(&mut guide, &[Key::UpDown(-0.1); 2]);
    let limit = guide.robot.calibration().servos[0].limit;
    assert_eq!(limit, [before.limit[0] + 3.0, before.limit[1] - 2.0]);
    press_keys(&mut guide, &[Key::UpDown(-0.1); 90]);
    let view = guide.view();
    assert!(view.message.contains("refuses `limit 1"), "{view:?}");
    let [min, max] = read_calibration(&mut link).servos[0].limit;
    let shown_limits = format!("    limits {min:.2} to {max:.2} deg");
    let is_shown = view.instructions.contains(&shown_limits);
    assert!(is_shown, "{view:?}, {shown_limits}");
}

#[test]
fn a_test_walk_ends_without_lines_and_the_robots_own_deadman_comes_back() {
    for own_deadman in ["# deadman 0", "# deadman 2000"] {
        let mut link = connect_paper_robot();
        let line = own_deadman.trim_start_matches("# ");
        link.command(line).expect("the line is accepted");
        let mut guide = Guide::new(&mut link).expect("the robot answers");
        press_keys(&mut guide, &keys_to_first_scale()[..14]);
        press_keys(&mut guide, &[Key::Next, Key::Act]);
        let status = guide.robot.console().ask("status");
        let status = status.expect("the robot answers").answer;
        assert!(status.starts_with("ok gait=walk"), "{status}");
        // The robot receives nothing for two seconds.
        guide.robot.console().port().run_frames(100);
        let status = guide.robot.console().ask("status");
        let status = status.expect("the robot answers").answer;
        let is_stopped = status.starts_with("ok gait=stop") && status.contains(" fault=link ");
        assert!(is_stopped, "{status}");
        press_keys(&mut guide, &[Key::Leave]);
        let cal = link.ask("cal").expect("the robot answers");
        let has_own = cal.notes.iter().any(|note| note == own_deadman);
        assert!(has_own, "{:?}", cal.notes);
    }
}
