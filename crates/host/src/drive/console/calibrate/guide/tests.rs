use super::*;
use crate::drive::console::double::{PAPER, calibration_of, connect_paper_robot};
use lizard_core::virtual_board::RunningRobot;
use lizard_robot::STILL_FRAMES;

fn press<P: Read + Write>(guide: &mut Guide<'_, P>, keys: &[Key]) -> bool {
    let mut is_done = false;
    for key in keys {
        is_done = guide.press_key(*key).expect("the robot answers");
    }
    is_done
}

const CONFIRM_SIGN_KEYS: [Key; 2] = [Key::Act, Key::Yes];

#[test]
fn a_whole_calibration_turns_a_sign_trims_a_servo_walks_and_saves() {
    let mut link = connect_paper_robot();
    let [min, max] = calibration_of(&mut link).servos[0].limit;
    let mut guide = Guide::new(&mut link).expect("it answers");
    press(&mut guide, &[Key::Next, Key::Next]);
    press(&mut guide, &CONFIRM_SIGN_KEYS);
    assert!(
        guide
            .view()
            .title
            .contains("which way does A2, front right turn")
    );
    press(&mut guide, &[Key::Act, Key::No, Key::Act, Key::Yes]);
    press(&mut guide, &CONFIRM_SIGN_KEYS);
    press(&mut guide, &CONFIRM_SIGN_KEYS);
    assert!(
        guide.view().title.contains("straighten A1"),
        "{:?}",
        guide.view()
    );
    press(
        &mut guide,
        &[Key::Turn(0.5), Key::Turn(0.5), Key::Turn(-0.1), Key::Next],
    );
    press(
        &mut guide,
        &[Key::Turn(-0.5), Key::Next, Key::Next, Key::Next],
    );
    assert!(guide.view().title.contains("scales and limits"));
    press(&mut guide, &[Key::Next, Key::Back, Key::Next, Key::Act]);
    guide.read_messages().expect("it answers");
    assert!(guide.view().text[1].starts_with("It walks"));
    press(&mut guide, &[Key::Next]);
    assert!(
        guide.view().text.contains(&format!(
            "    A1, front left  sign +  trim +0.90  limits {min:.2} to {max:.2}  scale 10.00"
        )),
        "{:?}",
        guide.view()
    );
    // The space bar does nothing here: only Enter is offered.
    press(&mut guide, &[Key::Act]);
    assert!(!guide.is_saved());
    assert!(!press(&mut guide, &[Key::Next]));
    assert!(guide.is_saved(), "{:?}", guide.view());
    press(&mut guide, &[Key::Back]);
    assert!(press(&mut guide, &[Key::Leave]), "what is saved stays");
    let after_leaving = calibration_of(&mut link);
    assert_eq!(after_leaving.servos[0].trim, 0.9);
    link.command("factory").expect("it is accepted");
    link.command("load").expect("it was saved");
    let loaded = calibration_of(&mut link);
    assert_eq!(loaded.servos[0].trim, 0.9);
    assert_eq!(loaded.servos[1].trim, -0.5);
    assert_eq!(loaded.servos[1].dir, '-');
    assert_eq!(loaded.servos[2].dir, '+');
}

#[test]
fn cancelling_at_any_step_restores_everything() {
    let keys: Vec<Key> = [Key::Next, Key::Next]
        .into_iter()
        .chain([Key::Act, Key::No, Key::Act, Key::Yes])
        .chain(CONFIRM_SIGN_KEYS.repeat(3))
        .chain([
            Key::Turn(4.0),
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
        link.command("trim 1 2.50").expect("it is accepted");
        link.command("boot walk").expect("it is accepted");
        let before = calibration_of(&mut link);
        let mut guide = Guide::new(&mut link).expect("it answers");
        press(&mut guide, &keys[..length]);
        assert!(press(&mut guide, &[Key::Leave]), "after {length} keys");
        let after = calibration_of(&mut link);
        assert_eq!(after, before, "after {length} keys");
        let status = link.ask("status").expect("it answers").answer;
        assert!(status.starts_with("ok gait=stand"), "{status}");
        let load = link.ask("load").expect("it answers").answer;
        assert!(load.starts_with("err 9"), "nothing was saved: {load}");
    }
}

#[test]
fn the_horn_keeps_its_pulse_when_a_sign_is_turned_round() {
    let mut link = connect_paper_robot();
    link.command("trim 1 3").expect("it is accepted");
    let mut guide = Guide::new(&mut link).expect("it answers");
    press(&mut guide, &[Key::Next, Key::Next, Key::Act, Key::No]);
    assert_eq!(guide.robot.calibration().servos[0].trim, -3.0);
    let current = calibration_of(&mut link);
    assert_eq!((current.servos[0].trim, current.servos[0].dir), (-3.0, '-'));
}

#[test]
fn one_servo_alone_is_moved_and_only_after_the_space_bar_is_an_answer_taken() {
    let mut link = connect_paper_robot();
    let mut guide = Guide::new(&mut link).expect("it answers");
    press(&mut guide, &[Key::Next, Key::Next, Key::Yes]);
    assert!(guide.view().message.contains("space bar first"));
    press(&mut guide, &[Key::Next]);
    assert!(guide.view().title.contains("A1"), "no step is left out");
    press(&mut guide, &[Key::Act]);
    let status = link.ask("status").expect("it answers").answer;
    assert!(
        status.contains("pose=148.59,41.41,318.59,221.41"),
        "{status}"
    );
}

#[test]
fn a_motion_is_noticed_before_the_robot_counts_as_standing() {
    // The slowest that a robot may be, and the smallest turn of a key.
    let slow_robot = PAPER.replacen("\nslew = 300.0", "\nslew = 10.0", 1);
    assert_ne!(slow_robot, PAPER);
    for (text, degrees) in [
        (PAPER, 10.0),
        (PAPER, 0.1),
        (slow_robot.as_str(), 10.0),
        (slow_robot.as_str(), 0.1),
    ] {
        let robot = lizard_robot::Robot::parse(text).expect("it is right");
        let mut running = RunningRobot::power_on(*robot.firmware());
        running.run_frames(200);
        let before = running.status("pose");
        let [a1, a2, a3, a4] = robot.servos().map(|servo| servo.neutral);
        let line = format!("pose {:.2} {a2:.2} {a3:.2} {a4:.2}", a1 + degrees);
        assert!(running.send_line(&line).starts_with("ok pose"), "{line}");
        let unseen_frames = (0..100).take_while(|_| {
            running.run_frames(1);
            running.status("pose") == before
        });
        let unseen_frames = unseen_frames.count() as u64;
        assert!(
            unseen_frames + 2 < STILL_FRAMES,
            "{degrees} deg: {unseen_frames} frames show nothing"
        );
    }
}

#[test]
fn steps_can_be_repeated_and_a_refused_trim_is_shown_and_changes_nothing() {
    let mut link = connect_paper_robot();
    let mut guide = Guide::new(&mut link).expect("it answers");
    press(&mut guide, &[Key::Back, Key::Next, Key::Next]);
    for _ in 0..4 {
        press(&mut guide, &CONFIRM_SIGN_KEYS);
    }
    press(&mut guide, &[Key::Turn(19.9), Key::Turn(0.5)]);
    let view = guide.view();
    assert!(
        view.message
            .starts_with("The robot refuses `trim 1 20.40`: 3 trim must")
    );
    assert!(
        view.text.contains(&"    trim +19.90 deg".to_owned()),
        "{view:?}"
    );
    press(&mut guide, &[Key::Back]);
    assert!(guide.view().title.contains("which way does A4"));
}

/// The keys from the beginning to the first scale.
fn keys_to_scales() -> Vec<Key> {
    let mut keys = vec![Key::Next, Key::Next];
    keys.extend(CONFIRM_SIGN_KEYS.repeat(4));
    keys.extend([Key::Next; 4]);
    keys.push(Key::Yes);
    keys
}

#[test]
fn a_scale_is_set_where_the_crank_points_and_its_middle_stays() {
    let mut link = connect_paper_robot();
    link.command("trim 1 2.00").expect("it is accepted");
    let mut guide = Guide::new(&mut link).expect("it answers");
    press(&mut guide, &keys_to_scales());
    assert!(
        guide
            .view()
            .title
            .contains("how far does A1, front left turn")
    );
    press(&mut guide, &[Key::Turn(0.5)]);
    assert!(guide.view().message.contains("space bar first"));
    press(&mut guide, &[Key::Act]);
    let moved_degrees = guide.moved_degrees.expect("it was moved");
    assert!(moved_degrees.abs() >= 20.0, "{moved_degrees}");
    // Four corrections by half a degree of a turn of `moved_degrees` degrees.
    press(&mut guide, &[Key::Turn(0.5); 4]);
    let expected = 10.0 * (1.0 + 0.5 / moved_degrees).powi(4);
    let current = calibration_of(&mut link).servos[0];
    assert!((current.scale - expected).abs() < 0.03, "{current:?}");
    // The neutral pulse is unchanged: its offset is trim times scale.
    assert!(
        (current.trim * current.scale - 20.0).abs() < 0.2,
        "{current:?}"
    );
}

#[test]
fn each_end_of_the_travel_is_moved_and_not_into_what_the_gaits_need() {
    let mut link = connect_paper_robot();
    let before = calibration_of(&mut link).servos[0];
    let mut guide = Guide::new(&mut link).expect("it answers");
    press(&mut guide, &keys_to_scales());
    press(&mut guide, &[Key::Next; 4]);
    let title = guide.view().title;
    assert!(title.contains("how far may A1, front left turn"), "{title}");
    press(&mut guide, &[Key::Turn(0.5); 3]);
    press(&mut guide, &[Key::Turn(-0.1); 2]);
    let current = guide.robot.calibration().servos[0];
    assert_eq!(
        current.limit,
        [before.limit[0] + 3.0, before.limit[1] - 2.0]
    );
    press(&mut guide, &[Key::Turn(-0.1); 90]);
    let view = guide.view();
    assert!(view.message.contains("refuses `limit 1"), "{view:?}");
    let current = calibration_of(&mut link).servos[0];
    let shown = format!(
        "    limits {:.2} to {:.2} deg",
        current.limit[0], current.limit[1]
    );
    assert!(view.text.contains(&shown), "{view:?}, {current:?}");
}
