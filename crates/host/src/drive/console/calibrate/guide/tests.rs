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

const CONFIRM_SIGN_KEYS: [Key; 2] = [Key::Act, Key::Yes];

#[test]
fn a_complete_calibration_saves_signs_and_trims() {
    let mut link = connect_paper_robot();
    let [min, max] = read_calibration(&mut link).servos[0].limit;
    let mut guide = Guide::new(&mut link).expect("the robot answers");
    press_keys(&mut guide, &[Key::Next, Key::Next]);
    press_keys(&mut guide, &CONFIRM_SIGN_KEYS);
    assert!(
        guide
            .view()
            .title
            .contains("which way does A2, front right turn")
    );
    press_keys(&mut guide, &[Key::Act, Key::No, Key::Act, Key::Yes]);
    press_keys(&mut guide, &CONFIRM_SIGN_KEYS);
    press_keys(&mut guide, &CONFIRM_SIGN_KEYS);
    assert!(
        guide.view().title.contains("straighten A1"),
        "{:?}",
        guide.view()
    );
    press_keys(
        &mut guide,
        &[
            Key::LeftRight(0.5),
            Key::LeftRight(0.5),
            Key::UpDown(-0.1),
            Key::Next,
        ],
    );
    press_keys(
        &mut guide,
        &[Key::LeftRight(-0.5), Key::Next, Key::Next, Key::Next],
    );
    assert!(guide.view().title.contains("scales and limits"));
    press_keys(&mut guide, &[Key::Next, Key::Back, Key::Next, Key::Act]);
    guide.read_messages().expect("the robot answers");
    assert!(guide.view().instructions[1].starts_with("The robot walks"));
    press_keys(&mut guide, &[Key::Next]);
    assert!(
        guide.view().instructions.contains(&format!(
            "    A1, front left  sign +  trim +0.90  limits {min:.2} to {max:.2}  scale 10.00"
        )),
        "{:?}",
        guide.view()
    );
    // The space bar has no effect in this step.
    press_keys(&mut guide, &[Key::Act]);
    assert!(!guide.is_saved());
    assert!(!press_keys(&mut guide, &[Key::Next]));
    assert!(guide.is_saved(), "{:?}", guide.view());
    press_keys(&mut guide, &[Key::Back]);
    assert!(
        press_keys(&mut guide, &[Key::Leave]),
        "the guide is finished"
    );
    let after_leaving = read_calibration(&mut link);
    assert_eq!(after_leaving.servos[0].trim, 0.9);
    link.command("factory").expect("the line is accepted");
    link.command("load").expect("the calibration was saved");
    let loaded = read_calibration(&mut link);
    assert_eq!(loaded.servos[0].trim, 0.9);
    assert_eq!(loaded.servos[1].trim, -0.5);
    assert_eq!(loaded.servos[1].dir, '-');
    assert_eq!(loaded.servos[2].dir, '+');
}

#[test]
fn cancelling_restores_the_calibration_and_saves_nothing() {
    let keys: Vec<Key> = [Key::Next, Key::Next]
        .into_iter()
        .chain([Key::Act, Key::No, Key::Act, Key::Yes])
        .chain(CONFIRM_SIGN_KEYS.repeat(3))
        .chain([
            Key::LeftRight(4.0),
            Key::Next,
            Key::Next,
            Key::Next,
            Key::Next,
            Key::Next,
            Key::Act,
        ])
        .collect();
    for length in [1, 4, 13, 19] {
        let mut link = connect_paper_robot();
        link.command("trim 1 2.50").expect("the line is accepted");
        link.command("boot walk").expect("the line is accepted");
        let before = read_calibration(&mut link);
        let mut guide = Guide::new(&mut link).expect("the robot answers");
        press_keys(&mut guide, &keys[..length]);
        assert!(press_keys(&mut guide, &[Key::Leave]), "after {length} keys");
        let after = read_calibration(&mut link);
        assert_eq!(after, before, "after {length} keys");
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
    let settings = read_calibration(&mut link);
    assert_eq!(
        (settings.servos[0].trim, settings.servos[0].dir),
        (-3.0, '-')
    );
}

#[test]
fn the_sign_step_needs_a_movement_of_one_servo_before_the_answer() {
    let mut link = connect_paper_robot();
    let mut guide = Guide::new(&mut link).expect("the robot answers");
    press_keys(&mut guide, &[Key::Next, Key::Next, Key::Yes]);
    assert!(guide.view().message.contains("space bar first"));
    press_keys(&mut guide, &[Key::Next]);
    assert!(guide.view().title.contains("A1"), "no step is skipped");
    press_keys(&mut guide, &[Key::Act]);
    let status = link.ask("status").expect("the robot answers").answer;
    assert!(
        status.contains("pose=148.59,41.41,318.59,221.41"),
        "{status}"
    );
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
    for _ in 0..4 {
        press_keys(&mut guide, &CONFIRM_SIGN_KEYS);
    }
    press_keys(&mut guide, &[Key::LeftRight(19.9), Key::LeftRight(0.5)]);
    let view = guide.view();
    assert!(
        view.message
            .starts_with("The robot refuses `trim 1 20.40`: 3 trim must")
    );
    assert!(
        view.instructions
            .contains(&"    trim +19.90 deg".to_owned()),
        "{view:?}"
    );
    press_keys(&mut guide, &[Key::Back]);
    assert!(guide.view().title.contains("which way does A4"));
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
    assert!(
        guide
            .view()
            .title
            .contains("how far does A1, front left turn")
    );
    press_keys(&mut guide, &[Key::LeftRight(0.5)]);
    assert!(guide.view().message.contains("space bar first"));
    press_keys(&mut guide, &[Key::Act]);
    let moved_degrees = guide.moved_degrees.expect("the servo has moved");
    assert!(moved_degrees.abs() >= 20.0, "{moved_degrees}");
    // Makes four corrections of half a degree each.
    press_keys(&mut guide, &[Key::LeftRight(0.5); 4]);
    let expected_scale = 10.0 * (1.0 + 0.5 / moved_degrees).powi(4);
    let settings = read_calibration(&mut link).servos[0];
    assert!(
        (settings.scale - expected_scale).abs() < 0.03,
        "{settings:?}"
    );
    // The neutral pulse is unchanged: its offset is trim times scale.
    assert!(
        (settings.trim * settings.scale - 20.0).abs() < 0.2,
        "{settings:?}"
    );
}

#[test]
fn limits_move_at_most_to_the_travel_that_the_gaits_need() {
    let mut link = connect_paper_robot();
    let before = read_calibration(&mut link).servos[0];
    let mut guide = Guide::new(&mut link).expect("the robot answers");
    press_keys(&mut guide, &keys_to_first_scale());
    press_keys(&mut guide, &[Key::Next; 4]);
    let title = guide.view().title;
    assert!(title.contains("how far may A1, front left turn"), "{title}");
    // With Shift, an arrow stands for 0.1 degrees, but moves the same limit by 1 degree.
    press_keys(
        &mut guide,
        &[
            Key::LeftRight(0.5),
            Key::LeftRight(0.1),
            Key::LeftRight(0.5),
        ],
    );
    press_keys(&mut guide, &[Key::UpDown(-0.1); 2]);
    let settings = guide.robot.calibration().servos[0];
    assert_eq!(
        settings.limit,
        [before.limit[0] + 3.0, before.limit[1] - 2.0]
    );
    press_keys(&mut guide, &[Key::UpDown(-0.1); 90]);
    let view = guide.view();
    assert!(view.message.contains("refuses `limit 1"), "{view:?}");
    let settings = read_calibration(&mut link).servos[0];
    let shown_limits = format!(
        "    limits {:.2} to {:.2} deg",
        settings.limit[0], settings.limit[1]
    );
    assert!(
        view.instructions.contains(&shown_limits),
        "{view:?}, {settings:?}"
    );
}
