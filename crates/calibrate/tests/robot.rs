//! Tests of calibrations with the firmware's console, without a chip and faster than real time.

use std::convert::Infallible;
use std::time::Duration;

use lizard_calibrate::{
    Console, ConsoleError, ReplaceError, Reply, SCALE_TURNS_DEG, Session, read_settings,
    send_settings,
};
use lizard_core::virtual_board::RunningRobot;
use lizard_robot::edit::without_gait;
use lizard_robot::{Calibration, Robot};
use pollster::block_on;
use proptest::collection::vec;
use proptest::prelude::*;

/// The robot.toml of the paper's robot.
const PAPER: &str = include_str!("../../../robots/paper.toml");

/// A lossless connection.
struct DirectConsole(RunningRobot);

impl DirectConsole {
    fn power_on(robot_toml: &str) -> Self {
        let robot = Robot::parse(robot_toml).expect("robot.toml is valid");
        let mut running = RunningRobot::power_on(*robot.firmware());
        running.run_frames(10);
        Self(running)
    }

    fn read_calibration(&mut self) -> Calibration {
        block_on(read_settings(self)).expect("the robot answers")
    }
}

impl Console for DirectConsole {
    type Error = Infallible;

    async fn ask(&mut self, line: &str) -> Result<Reply, Infallible> {
        self.0.read_lines();
        let mut notes = self.0.send(format!("{line}\r").as_bytes());
        loop {
            if let Some(index) = notes.iter().position(|line| !line.starts_with('#')) {
                let answer = notes.remove(index);
                notes.truncate(index);
                return Ok(Reply { notes, answer });
            }
            notes.extend(self.0.run_frames(1));
        }
    }

    async fn pause(&mut self, duration: Duration) -> Result<(), Infallible> {
        self.0.run_frames(duration.as_millis().div_ceil(20) as u32);
        Ok(())
    }
}

/// Reads the factory settings of the paper's robot.
fn read_factory_settings() -> Calibration {
    DirectConsole::power_on(PAPER).read_calibration()
}

/// Starts a session with a new robot.
fn begin_session(robot_toml: &str) -> Session<DirectConsole> {
    block_on(Session::begin(DirectConsole::power_on(robot_toml))).expect("the robot answers")
}

#[test]
fn a_new_robot_has_the_settings_of_robot_toml() {
    let calibration = read_factory_settings();
    assert_eq!(calibration.boot, "stand");
    assert_eq!(calibration.deadman, 0);
    let neutrals = [138.59, 41.41, 318.59, 221.41];
    for (servo, neutral) in calibration.servos.iter().zip(neutrals) {
        assert_eq!((servo.trim, servo.dir, servo.scale), (0.0, '+', 10.0));
        let min = (neutral - 90.0_f64).rem_euclid(360.0);
        assert!((servo.limit[0] - min).abs() < 0.011, "{servo:?}");
    }
}

#[test]
fn read_settings_returns_the_sent_settings() {
    let mut robot = DirectConsole::power_on(PAPER);
    let mut calibration = read_factory_settings();
    calibration.servos[1].trim = -3.25;
    calibration.servos[2].dir = '-';
    calibration.servos[3].scale = 10.57;
    calibration.servos[0].limit = [70.0, -150.0];
    calibration.boot = "arc left".to_owned();
    calibration.deadman = 1500;
    block_on(send_settings(&mut robot, &calibration)).expect("the robot accepts the settings");
    let read_back = robot.read_calibration();
    assert!(calibration.is_equivalent_to(&read_back), "{read_back:?}");
    assert!(!calibration.is_equivalent_to(&read_factory_settings()));
}

#[test]
fn a_setting_that_conflicts_with_the_current_settings_is_sent_again_after_the_others() {
    // With a travel of 400 us to each side, a large trim and a large scale are incompatible.
    let narrow_robot = PAPER.replace("min_us = 600.0", "min_us = 1100.0");
    let narrow_robot = narrow_robot.replace("max_us = 2400.0", "max_us = 1900.0");
    let mut robot = DirectConsole::power_on(&narrow_robot);
    let initial = robot.read_calibration();
    let [mut scaled, mut trimmed] = [initial.clone(), initial];
    scaled.servos[0].scale = 16.0;
    trimmed.servos[0].trim = 15.0;
    for calibration in [&trimmed, &scaled, &trimmed] {
        block_on(send_settings(&mut robot, calibration)).expect("the robot accepts the settings");
        let read_back = robot.read_calibration();
        assert!(calibration.is_equivalent_to(&read_back), "{read_back:?}");
    }
}

#[test]
fn replace_restores_the_old_settings_if_the_robot_refuses_the_new_settings() {
    let mut session = begin_session(PAPER);
    block_on(session.change_trim(2, 1.5)).expect("the robot accepts the settings");
    let mut calibration = read_factory_settings();
    calibration.servos[0].trim = 4.0;
    calibration.servos[1].limit = [40.0, 43.0];
    let error = block_on(session.replace(&calibration)).expect_err("the travel is too narrow");
    assert!(matches!(error, ReplaceError::Refused(_)), "{error:?}");
    let message = error.to_string();
    let reason = "`limit 2 40.00 43.00`: err 3 A2's travel must";
    assert!(message.contains(reason), "{message}");
    let mut expected = read_factory_settings();
    expected.servos[2].trim = 1.5;
    let actual = session.console().read_calibration();
    assert!(actual.is_equivalent_to(&expected));
    assert!(session.calibration().is_equivalent_to(&expected));
}

#[test]
fn set_scale_restores_the_old_scale_if_the_robot_refuses_the_trim() {
    let mut session = begin_session(PAPER);
    block_on(session.change_trim(0, 19.0)).expect("the robot accepts the settings");
    // The horn stays on its tooth, so half the scale needs twice the trim, which exceeds the largest trim.
    let refusal = block_on(session.set_scale(0, 5.0)).expect_err("the trim is too large");
    let message = refusal.to_string();
    assert!(message.starts_with("the robot refuses `trim 1 38.00`"));
    let robot_settings = session.console().read_calibration().servos[0];
    assert_eq!((robot_settings.scale, robot_settings.trim), (10.0, 19.0));
    assert_eq!(session.calibration().servos[0], robot_settings);
}

#[test]
fn the_scale_is_measured_by_the_largest_turn_that_the_robot_accepts() {
    let mut session = begin_session(PAPER);
    let commanded_deg =
        block_on(session.turn_servo(0, &SCALE_TURNS_DEG)).expect("the robot accepts a turn");
    let pose = session.console().0.status_value("pose");
    let a1 = pose.split(',').next().and_then(|angle| angle.parse().ok());
    let a1: f64 = a1.expect("the pose has an angle of A1");
    let case = format!("pose {pose} after a turn of {commanded_deg} deg");
    assert!((a1 - 138.59 - commanded_deg).abs() < 0.02, "{case}");
    assert!(commanded_deg.abs() >= 20.0, "a turn of {commanded_deg} deg");
    // A servo that turns 10 % too far needs a scale that is smaller by a factor of 1.1.
    let scale = block_on(session.set_scale_from_turn(0, commanded_deg, commanded_deg * 1.1))
        .expect("the robot accepts the settings");
    assert_eq!(scale, 9.09);
    assert_eq!(session.console().read_calibration().servos[0].scale, 9.09);
}

#[test]
fn angles_are_rounded_as_on_the_console_and_the_first_refusal_is_returned() {
    let mut session = begin_session(PAPER);
    let angle =
        block_on(session.move_servo(0, 140.004 - 360.0)).expect("the robot accepts the pose");
    assert_eq!(angle, 140.0);
    block_on(session.set_limit(0, [-300.0, 580.0])).expect("the robot accepts the settings");
    assert_eq!(session.calibration().servos[0].limit, [60.0, 220.0]);
    let refusal =
        block_on(session.turn_servo(0, &[170.0, 180.0])).expect_err("the angles are out of reach");
    assert!(refusal.to_string().contains("`pose 308.59 "), "{refusal}");
}

#[test]
fn start_walk_starts_walk_or_the_first_other_gait() {
    let removable_gaits = "walk back arc-left arc-right trot crawl left right look";
    for (count, expected) in [(0, Some("walk")), (4, Some("trot")), (9, None)] {
        let removed_gaits = removable_gaits.split(' ').take(count);
        let robot_toml =
            removed_gaits.fold(PAPER.to_owned(), |text, name| without_gait(&text, name));
        let mut session = begin_session(&robot_toml);
        let gait = block_on(session.start_walk()).expect("the robot accepts the gait");
        assert_eq!(gait.as_deref(), expected);
        let gait = session.console().0.status_value("gait");
        assert_eq!(gait, expected.unwrap_or("stand"));
    }
}

/// The part of an exchange that is lost.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Loss {
    /// The robot does not receive the line.
    Line,
    /// The robot executes the line, but its answer does not arrive.
    Answer,
}

/// A connection that loses some lines or answers, and records the lines.
struct LossyConsole {
    robot: DirectConsole,
    lines: Vec<String>,
    /// The index of each affected line, and the lost part of its exchange.
    losses: Vec<(usize, Loss)>,
    /// The beginning of the lines that get the answer `ok`, but do not reach the robot.
    ignored_prefix: &'static str,
    /// The robot's settings at the last `save` that it executed; before the first, those at the start of the session.
    saved: Calibration,
}

impl Console for LossyConsole {
    type Error = &'static str;

    async fn ask(&mut self, line: &str) -> Result<Reply, &'static str> {
        let index = self.lines.len();
        self.lines.push(line.to_owned());
        let mut losses = self.losses.iter();
        let loss = losses.find(|(lost_index, _)| *lost_index == index);
        if let Some((_, Loss::Line)) = loss {
            return Err("the line was lost");
        }
        if line.starts_with(self.ignored_prefix) {
            let (notes, answer) = (Vec::new(), format!("ok {line}"));
            return Ok(Reply { notes, answer });
        }
        let reply = self.robot.ask(line).await.expect("the robot answers");
        if line == "save" && reply.answer.starts_with("ok") {
            self.saved = self.robot.read_calibration();
        }
        match loss {
            None => Ok(reply),
            Some(_) => Err("the answer was lost"),
        }
    }

    async fn pause(&mut self, duration: Duration) -> Result<(), &'static str> {
        let Ok(()) = self.robot.pause(duration).await;
        Ok(())
    }
}

/// Sends `first_lines` to the paper's robot without losses, and starts a session over a lossy connection, which counts
/// lines from 0.
fn begin_lossy_session(first_lines: &[&str], losses: Vec<(usize, Loss)>) -> Session<LossyConsole> {
    let mut robot = DirectConsole::power_on(PAPER);
    for line in first_lines {
        block_on(robot.ask(line)).expect("the robot answers");
    }
    let saved = robot.read_calibration();
    let connection = LossyConsole {
        robot,
        lines: Vec::new(),
        losses,
        ignored_prefix: "none of the lines",
        saved,
    };
    block_on(Session::begin(connection)).expect("the robot answers")
}

/// Performs a calibration that changes settings of every kind and saves twice.
async fn calibrate<C: Console>(session: &mut Session<C>) -> Result<(), ConsoleError<C::Error>> {
    session.change_trim(3, 2.0).await?;
    session.reverse_sign(3).await?;
    session.save().await?;
    session.set_scale(3, 11.0).await?;
    session.set_limit(0, [60.0, 220.0]).await?;
    session.save().await?;
    session.change_trim(1, -0.5).await
}

/// Performs the calibration with one loss; returns the session, and true if the calibration has failed.
fn calibrate_with_loss(loss: (usize, Loss)) -> (Session<LossyConsole>, bool) {
    let mut session = begin_lossy_session(&[], vec![loss]);
    let result = block_on(calibrate(&mut session));
    (session, result.is_err())
}

/// Makes the robot load its saved settings or, without any, its factory settings, and returns them.
fn load_stored_settings(session: &mut Session<LossyConsole>) -> Calibration {
    let robot = &mut session.console().robot;
    if !robot.0.send_line("load").starts_with("ok") {
        robot.0.expect_accepted("factory");
    }
    robot.read_calibration()
}

#[test]
fn session_and_robot_agree_on_the_settings_after_the_loss_of_any_line_or_answer() {
    // Line 0 reads the settings; without its answer, the session cannot start.
    let mut loss_count = 0;
    for index in 1.. {
        for loss in [Loss::Line, Loss::Answer] {
            let (mut session, has_failed) = calibrate_with_loss((index, loss));
            if !has_failed {
                assert!(loss_count > 30, "{loss_count} losses");
                return;
            }
            loss_count += 1;
            let is_query = session.console().lines[index] == "status";
            let context = format!("line {index}, lost: {loss:?}");
            assert!(is_query || session.has_unsaved_changes(), "{context}");
            // A cancelled calibration restores the stored settings, so a reset changes nothing.
            block_on(session.restore()).expect("the robot answers");
            let active = session.console().robot.read_calibration();
            assert!(active.is_equivalent_to(session.calibration()), "{context}");
            assert!(!session.has_unsaved_changes(), "{context}");
            let stored = load_stored_settings(&mut session);
            let case = format!("{context}: stored {stored:?}, active {active:?}");
            assert!(stored.is_equivalent_to(&active), "{case}");

            // A save stores the settings that the session shows.
            let (mut session, _) = calibrate_with_loss((index, loss));
            block_on(session.save()).expect("the robot answers");
            let shown = session.calibration().clone();
            for actual in [
                session.console().robot.read_calibration(),
                load_stored_settings(&mut session),
            ] {
                assert!(shown.is_equivalent_to(&actual), "{context}: {actual:?}");
            }
        }
    }
}

#[test]
fn move_servo_does_not_return_to_neutral_between_two_angles() {
    let mut session = begin_lossy_session(&[], Vec::new());
    for degrees in [140.0, 141.0] {
        block_on(session.move_servo(0, degrees)).expect("the robot accepts the pose");
    }
    let lines = session.console().lines.iter();
    assert_eq!(lines.filter(|line| *line == "stand").count(), 1);
}

#[test]
fn restore_returns_to_settings_that_were_unsaved_at_the_start_even_after_a_lost_save() {
    // If only the answer was lost, the robot has saved the new trim. Even after a later change, `restore` does not
    // return to the trim of 5 that was saved before the start.
    for (loss, later_change, trim) in [
        (Loss::Line, None, 2.0),
        (Loss::Answer, None, 3.0),
        (Loss::Line, Some(-1.0), 2.0),
    ] {
        let mut session = begin_lossy_session(&["trim 1 5", "save", "trim 1 2"], vec![(3, loss)]);
        block_on(session.change_trim(0, 1.0)).expect("the robot accepts the settings");
        block_on(session.save()).expect_err("the exchange is lost");
        if let Some(change) = later_change {
            block_on(session.change_trim(0, change)).expect("the robot accepts the settings");
        }
        for _ in 0..2 {
            block_on(session.restore()).expect("the robot answers");
            let active = session.console().robot.read_calibration();
            assert_eq!(active.servos[0].trim, trim, "{loss:?}, {later_change:?}");
        }
    }
}

#[test]
fn the_session_reads_the_settings_again_after_a_lost_answer() {
    let mut session = begin_lossy_session(&[], vec![(1, Loss::Answer)]);
    block_on(session.set_scale(0, 11.0)).expect_err("the exchange is lost");
    let scale =
        block_on(session.set_scale_from_turn(0, 30.0, 30.0)).expect("the robot accepts the scale");
    assert_eq!(scale, 11.0);

    let mut session = begin_lossy_session(&[], vec![(1, Loss::Answer)]);
    block_on(session.change_trim(0, 1.5)).expect_err("the exchange is lost");
    let mut calibration = read_factory_settings();
    calibration.servos[1].limit = [40.0, 43.0];
    block_on(session.replace(&calibration)).expect_err("the travel is too narrow");
    let active = session.console().robot.read_calibration();
    assert_eq!(active.servos[0].trim, 1.5);
}

#[test]
fn replace_fails_if_the_robot_reports_different_settings() {
    let mut session = begin_lossy_session(&[], Vec::new());
    session.console().ignored_prefix = "trim 2";
    let mut calibration = read_factory_settings();
    calibration.servos[0].trim = 1.0;
    calibration.servos[1].trim = 1.0;
    let error = block_on(session.replace(&calibration)).expect_err("a trim differs");
    assert_eq!(error, ReplaceError::Differs);
    let active = session.console().robot.read_calibration();
    let factory = read_factory_settings();
    assert!(active.is_equivalent_to(&factory), "{active:?}");
}

/// Performs the action with the given number, and ignores a failure, as a person may do.
async fn perform_action(
    session: &mut Session<LossyConsole>,
    action: usize,
    servo: usize,
    amount: f64,
) {
    let neutral_deg = [138.59, 41.41, 318.59, 221.41][servo];
    let _ = match action {
        0 => session.change_trim(servo, amount).await,
        1 => session.reverse_sign(servo).await,
        2 => session.set_scale(servo, 10.0 + amount / 4.0).await,
        3 => {
            let turn_deg = session.turn_servo(servo, &SCALE_TURNS_DEG).await;
            let commanded_deg = turn_deg.unwrap_or(30.0);
            let measured_deg = commanded_deg + amount;
            let scale = session.set_scale_from_turn(servo, commanded_deg, measured_deg);
            scale.await.map(drop)
        }
        4 => {
            let ends_deg = [neutral_deg - 80.0 + amount, neutral_deg + 85.0];
            session.set_limit(servo, ends_deg).await
        }
        5 | 6 => session.save().await,
        7 => session.restore().await.map(drop),
        _ => {
            let mut calibration = read_factory_settings();
            calibration.servos[servo].trim = amount.round();
            let _ = session.replace(&calibration).await;
            Ok(())
        }
    };
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn after_any_actions_and_losses_save_and_restore_make_session_and_robot_agree(
        actions in vec((0..9_usize, 0..4_usize, -5.0..5.0), 1..12),
        losses in vec((1..150_usize, prop_oneof![Just(Loss::Line), Just(Loss::Answer)]), 0..12),
        ends_with_save in any::<bool>(),
    ) {
        let mut session = begin_lossy_session(&["trim 1 5", "save", "trim 1 2"], losses);
        for (action, servo, amount) in actions {
            block_on(perform_action(&mut session, action, servo, amount));
        }
        session.console().losses.clear();
        match ends_with_save {
            true => block_on(session.save()).expect("the robot answers"),
            false => block_on(session.restore()).map(drop).expect("the robot answers"),
        }
        prop_assert!(!session.has_unsaved_changes());
        let shown = session.calibration().clone();
        let LossyConsole { robot, saved, .. } = session.console();
        let active = robot.read_calibration();
        prop_assert!(active.is_equivalent_to(&shown), "{active:?}, shown {shown:?}");
        prop_assert!(active.is_equivalent_to(saved), "{active:?}, saved {saved:?}");
    }
}
