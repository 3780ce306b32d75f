//! Tests of calibrations on the firmware's own console, without a chip and faster than real time.

use std::convert::Infallible;
use std::time::Duration;

use lizard_calibrate::{
    Console, ConsoleError, Guide, Reply, SCALE_TURNS_DEG, SendError, read_settings, send_settings,
};
use lizard_core::virtual_board::RunningRobot;
use lizard_robot::edit::without_gait;
use lizard_robot::{Calibration, Robot};
use pollster::block_on;
use proptest::collection::vec;
use proptest::prelude::*;

/// The robot.toml of the paper's robot.
const PAPER: &str = include_str!("../../../robots/paper.toml");

/// A connection that loses nothing.
struct DirectConsole(RunningRobot);

impl DirectConsole {
    fn power_on(robot_toml: &str) -> Self {
        let robot = Robot::parse(robot_toml).expect("robot.toml is valid");
        let mut running = RunningRobot::power_on(*robot.firmware());
        running.run_frames(10);
        Self(running)
    }

    fn calibration(&mut self) -> Calibration {
        block_on(read_settings(self)).expect("the robot answers")
    }
}

impl Console for DirectConsole {
    type Error = Infallible;

    async fn ask(&mut self, line: &str) -> Result<Reply, Infallible> {
        self.0.read_lines();
        let mut notes = self.0.send(format!("{line}\r").as_bytes());
        let is_answer = |line: &String| !line.starts_with('#');
        while !notes.iter().any(is_answer) {
            notes.extend(self.0.run_frames(1));
        }
        let index = notes
            .iter()
            .position(is_answer)
            .expect("an answer has arrived");
        let answer = notes.remove(index);
        notes.truncate(index);
        Ok(Reply { notes, answer })
    }

    async fn pause(&mut self, duration: Duration) -> Result<(), Infallible> {
        self.0.run_frames(duration.as_millis().div_ceil(20) as u32);
        Ok(())
    }
}

/// The factory settings of the paper's robot.
fn factory_settings() -> Calibration {
    DirectConsole::power_on(PAPER).calibration()
}

#[test]
fn the_settings_of_a_new_robot_are_those_of_robot_toml() {
    let calibration = factory_settings();
    assert_eq!(
        (calibration.boot.as_str(), calibration.deadman),
        ("stand", 0)
    );
    let neutrals = [138.59, 41.41, 318.59, 221.41];
    for (servo, neutral) in calibration.servos.iter().zip(neutrals) {
        assert_eq!((servo.trim, servo.dir, servo.scale), (0.0, '+', 10.0));
        let min = (neutral - 90.0_f64).rem_euclid(360.0);
        assert!((servo.limit[0] - min).abs() < 0.011, "{servo:?}");
    }
}

#[test]
fn settings_that_were_sent_are_read_back() {
    let mut robot = DirectConsole::power_on(PAPER);
    let mut calibration = factory_settings();
    calibration.servos[1].trim = -3.25;
    calibration.servos[2].dir = '-';
    calibration.servos[3].scale = 10.57;
    calibration.servos[0].limit = [70.0, -150.0];
    calibration.boot = "arc left".to_owned();
    calibration.deadman = 1500;
    block_on(send_settings(&mut robot, &calibration)).expect("the robot accepts the settings");
    let read_back = robot.calibration();
    assert!(calibration.is_equivalent_to(&read_back), "{read_back:?}");
    assert!(!calibration.is_equivalent_to(&factory_settings()));
}

#[test]
fn a_setting_that_the_current_ones_forbid_is_retried_after_the_others() {
    // With a travel of 400 us to each side, a large trim and a large scale exclude each other.
    let narrow_robot = PAPER.replace("min_us = 600.0", "min_us = 1100.0");
    let narrow_robot = narrow_robot.replace("max_us = 2400.0", "max_us = 1900.0");
    let mut robot = DirectConsole::power_on(&narrow_robot);
    let initial = robot.calibration();
    let [mut scaled, mut trimmed] = [initial.clone(), initial];
    scaled.servos[0].scale = 16.0;
    trimmed.servos[0].trim = 15.0;
    for calibration in [&trimmed, &scaled, &trimmed] {
        block_on(send_settings(&mut robot, calibration)).expect("the robot accepts the settings");
        let read_back = robot.calibration();
        assert!(calibration.is_equivalent_to(&read_back), "{read_back:?}");
    }
}

#[test]
fn settings_that_do_not_suit_the_gaits_are_refused_and_the_old_ones_are_restored() {
    let mut guide =
        block_on(Guide::begin(DirectConsole::power_on(PAPER))).expect("the robot answers");
    block_on(guide.trim(2, 1.5)).expect("the robot accepts the settings");
    let mut calibration = factory_settings();
    calibration.servos[0].trim = 4.0;
    calibration.servos[1].limit = [40.0, 43.0];
    let error = block_on(guide.replace(&calibration)).expect_err("the travel is too narrow");
    assert!(matches!(error, SendError::Refused(_)), "{error:?}");
    let message = error.to_string();
    assert!(
        message.contains("`limit 2 40.00 43.00`: 3 A2 would"),
        "{message}"
    );
    let mut expected = factory_settings();
    expected.servos[2].trim = 1.5;
    assert!(guide.console().calibration().is_equivalent_to(&expected));
    assert!(guide.calibration().is_equivalent_to(&expected));
}

#[test]
fn a_scale_whose_trim_is_refused_is_undone() {
    let mut guide =
        block_on(Guide::begin(DirectConsole::power_on(PAPER))).expect("the robot answers");
    block_on(guide.trim(0, 19.0)).expect("the robot accepts the settings");
    // The horn keeps its tooth, so half the scale needs twice the trim, which exceeds the largest trim.
    let refusal = block_on(guide.set_scale(0, 5.0)).expect_err("the trim is too large");
    assert!(
        refusal
            .to_string()
            .starts_with("the robot refuses `trim 1 38.00`"),
        "{refusal}"
    );
    let robot_settings = guide.console().calibration().servos[0];
    assert_eq!((robot_settings.scale, robot_settings.trim), (10.0, 19.0));
    assert_eq!(guide.calibration().servos[0], robot_settings);
}

#[test]
fn a_scale_is_measured_by_a_turn_as_large_as_the_robot_accepts() {
    let mut guide =
        block_on(Guide::begin(DirectConsole::power_on(PAPER))).expect("the robot answers");
    let commanded_deg =
        block_on(guide.turn(0, &SCALE_TURNS_DEG)).expect("the robot accepts a turn");
    let pose = guide.console().0.status_value("pose");
    let a1: f64 = pose
        .split(',')
        .next()
        .and_then(|angle| angle.parse().ok())
        .expect("the pose has an angle of A1");
    assert!(
        (a1 - 138.59 - commanded_deg).abs() < 0.02,
        "{pose} after {commanded_deg}"
    );
    assert!(commanded_deg.abs() >= 20.0, "{commanded_deg}");
    // A servo that turns 10 % too far needs a scale that is smaller by the factor 1.1.
    let scale = block_on(guide.scale_by_turn(0, commanded_deg, commanded_deg * 1.1))
        .expect("the robot accepts the settings");
    assert_eq!(scale, 9.09);
    assert_eq!(guide.console().calibration().servos[0].scale, 9.09);
}

#[test]
fn angles_are_rounded_as_on_the_console_and_the_first_refusal_is_reported() {
    let mut guide =
        block_on(Guide::begin(DirectConsole::power_on(PAPER))).expect("the robot answers");
    let angle = block_on(guide.point(0, 140.004 - 360.0)).expect("the robot accepts the settings");
    assert_eq!(angle, 140.0);
    block_on(guide.limit(0, [-300.0, 580.0])).expect("the robot accepts the settings");
    assert_eq!(guide.calibration().servos[0].limit, [60.0, 220.0]);
    let refusal =
        block_on(guide.turn(0, &[170.0, 180.0])).expect_err("the angles are out of reach");
    assert!(refusal.to_string().contains("`pose 308.59 "), "{refusal}");
}

#[test]
fn the_test_walk_is_walk_or_the_first_gait_that_the_robot_has() {
    let removable_gaits = [
        "walk",
        "back",
        "arc-left",
        "arc-right",
        "trot",
        "crawl",
        "left",
        "right",
        "look",
    ];
    for (count, expected) in [
        (0, Some("walk")),
        (4, Some("trot")),
        (removable_gaits.len(), None),
    ] {
        let removed_gaits = &removable_gaits[..count];
        let robot_toml = removed_gaits
            .iter()
            .fold(PAPER.to_owned(), |text, name| without_gait(&text, name));
        let mut guide = block_on(Guide::begin(DirectConsole::power_on(&robot_toml)))
            .expect("the robot answers");
        let gait = block_on(guide.walk()).expect("the robot accepts the settings");
        assert_eq!(gait.as_deref(), expected);
        let gait = guide.console().0.status_value("gait");
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

/// A connection that loses the line with a given index or its answer, and records all lines.
struct SingleLossConsole {
    robot: DirectConsole,
    lines: Vec<String>,
    loss: Option<(usize, Loss)>,
}

impl Console for SingleLossConsole {
    type Error = &'static str;

    async fn ask(&mut self, line: &str) -> Result<Reply, &'static str> {
        let index = self.lines.len();
        self.lines.push(line.to_owned());
        match self.loss {
            Some((lost_index, Loss::Line)) if lost_index == index => Err("the line was lost"),
            Some((lost_index, Loss::Answer)) if lost_index == index => {
                let _ = self.robot.ask(line).await;
                Err("the answer was lost")
            }
            _ => Ok(self.robot.ask(line).await.expect("the robot answers")),
        }
    }

    async fn pause(&mut self, duration: Duration) -> Result<(), &'static str> {
        self.robot
            .pause(duration)
            .await
            .expect("a pause cannot fail");
        Ok(())
    }
}

/// Performs a calibration with every kind of setting and two saves.
async fn calibrate<C: Console>(guide: &mut Guide<C>) -> Result<(), ConsoleError<C::Error>> {
    guide.trim(3, 2.0).await?;
    guide.reverse(3).await?;
    guide.save().await?;
    guide.set_scale(3, 11.0).await?;
    guide.limit(0, [60.0, 220.0]).await?;
    guide.save().await?;
    guide.trim(1, -0.5).await
}

/// Performs the calibration with one loss; returns the guide, and true if the calibration has failed.
fn calibrate_with_loss(loss: (usize, Loss)) -> (Guide<SingleLossConsole>, bool) {
    let robot = DirectConsole::power_on(PAPER);
    let connection = SingleLossConsole {
        robot,
        lines: Vec::new(),
        loss: Some(loss),
    };
    let mut guide = match block_on(Guide::begin(connection)) {
        Ok(guide) => guide,
        Err(error) => panic!("{error}"),
    };
    let result = block_on(calibrate(&mut guide));
    (guide, result.is_err())
}

/// Makes the robot load the settings with which it starts after a reset, and returns them.
fn load_stored(guide: &mut Guide<SingleLossConsole>) -> Calibration {
    let robot = &mut guide.console().robot;
    if !robot.0.send_line("load").starts_with("ok") {
        robot.0.expect_accepted("factory");
    }
    robot.calibration()
}

#[test]
fn whichever_line_or_answer_is_lost_the_guide_ends_with_the_settings_of_the_robot() {
    // Line 0 reads the settings when the guide starts; without them there is no guide.
    let mut loss_count = 0;
    for index in 1.. {
        for loss in [Loss::Line, Loss::Answer] {
            let (mut guide, has_failed) = calibrate_with_loss((index, loss));
            if !has_failed {
                assert!(loss_count > 30, "{loss_count}");
                return;
            }
            loss_count += 1;
            let is_query = guide.console().lines[index] == "status";
            assert!(is_query || guide.has_unsaved_changes(), "{index}, {loss:?}");
            // A cancelled calibration restores the stored settings, so a reset changes nothing.
            block_on(guide.restore()).expect("the robot answers");
            let active = guide.console().robot.calibration();
            assert!(
                active.is_equivalent_to(guide.calibration()),
                "{index}, {loss:?}"
            );
            assert!(!guide.has_unsaved_changes(), "{index}, {loss:?}");
            let stored_settings = load_stored(&mut guide);
            assert!(
                stored_settings.is_equivalent_to(&active),
                "{index}, {loss:?}: {stored_settings:?}, {active:?}"
            );

            // A save stores the settings that the guide shows.
            let (mut guide, _) = calibrate_with_loss((index, loss));
            block_on(guide.save()).expect("the robot answers");
            let shown = guide.calibration().clone();
            assert!(
                shown.is_equivalent_to(&guide.console().robot.calibration()),
                "{index}, {loss:?}"
            );
            assert!(
                shown.is_equivalent_to(&load_stored(&mut guide)),
                "{index}, {loss:?}"
            );
        }
    }
}

#[test]
fn a_servo_moves_from_angle_to_angle_without_a_return_to_neutral() {
    let mut connection = SingleLossConsole {
        robot: DirectConsole::power_on(PAPER),
        lines: Vec::new(),
        loss: None,
    };
    let mut guide = block_on(Guide::begin(&mut connection)).expect("the robot answers");
    for degrees in [140.0, 141.0] {
        block_on(guide.point(0, degrees)).expect("the robot accepts the settings");
    }
    let stand_lines = connection.lines.iter().filter(|line| *line == "stand");
    assert_eq!(stand_lines.count(), 1);
}

#[test]
fn settings_that_were_unsaved_at_the_start_are_restored_even_after_a_lost_save() {
    // If only the answer was lost, the robot has saved the new trim.
    for (loss, trim) in [(Loss::Line, 2.0), (Loss::Answer, 3.0)] {
        let mut guide = guide_after(&["trim 1 5", "save", "trim 1 2"], 2, loss);
        block_on(guide.trim(0, 1.0)).expect("the robot accepts the settings");
        block_on(guide.save()).expect_err("the exchange is lost");
        for _ in 0..2 {
            block_on(guide.restore()).expect("the robot answers");
            let active = guide.console().robot.calibration();
            assert_eq!(active.servos[0].trim, trim);
        }
    }
}

/// A guide that starts after the paper's robot has received some lines, with a loss at the line with this index.
fn guide_after(lines: &[&str], index: usize, loss: Loss) -> Guide<SingleLossConsole> {
    let mut robot = DirectConsole::power_on(PAPER);
    for line in lines {
        block_on(robot.ask(line)).expect("the robot answers");
    }
    let connection = SingleLossConsole {
        robot,
        lines: Vec::new(),
        loss: Some((index, loss)),
    };
    block_on(Guide::begin(connection)).expect("the robot answers")
}

#[test]
fn settings_saved_before_the_start_are_not_restored_after_a_lost_save() {
    let mut guide = guide_after(&["trim 1 5", "save", "trim 1 2"], 2, Loss::Line);
    block_on(guide.trim(0, 1.0)).expect("the robot accepts the settings");
    block_on(guide.save()).expect_err("the exchange is lost");
    block_on(guide.trim(0, -1.0)).expect("the robot accepts the settings");
    block_on(guide.restore()).expect("the robot answers");
    assert_eq!(guide.console().robot.calibration().servos[0].trim, 2.0);
}

#[test]
fn a_setting_whose_answer_was_lost_is_read_again_before_the_next_change() {
    let mut guide = guide_after(&[], 1, Loss::Answer);
    block_on(guide.set_scale(0, 11.0)).expect_err("the exchange is lost");
    let scale =
        block_on(guide.scale_by_turn(0, 30.0, 30.0)).expect("the robot accepts the settings");
    assert_eq!(scale, 11.0);

    let mut guide = guide_after(&[], 1, Loss::Answer);
    block_on(guide.trim(0, 1.5)).expect_err("the exchange is lost");
    let mut calibration = factory_settings();
    calibration.servos[1].limit = [40.0, 43.0];
    block_on(guide.replace(&calibration)).expect_err("the travel is too narrow");
    assert_eq!(guide.console().robot.calibration().servos[0].trim, 1.5);
}

/// A connection that answers `ok` to every trim of A2 without passing it on.
struct TrimIgnoringConsole(DirectConsole);

impl Console for TrimIgnoringConsole {
    type Error = Infallible;

    async fn ask(&mut self, line: &str) -> Result<Reply, Infallible> {
        match line.starts_with("trim 2") {
            true => Ok(Reply {
                notes: Vec::new(),
                answer: format!("ok {line}"),
            }),
            false => self.0.ask(line).await,
        }
    }

    async fn pause(&mut self, duration: Duration) -> Result<(), Infallible> {
        self.0.pause(duration).await
    }
}

#[test]
fn settings_that_differ_when_read_back_are_an_error() {
    let mut guide = block_on(Guide::begin(TrimIgnoringConsole(DirectConsole::power_on(
        PAPER,
    ))))
    .expect("the robot answers");
    let mut calibration = factory_settings();
    calibration.servos[0].trim = 1.0;
    calibration.servos[1].trim = 1.0;
    let error = block_on(guide.replace(&calibration)).expect_err("a trim differs");
    assert_eq!(error, SendError::Differs);
    let active = guide.console().0.calibration();
    assert!(active.is_equivalent_to(&factory_settings()), "{active:?}");
}

/// A connection that loses some lines or their answers, and records the settings that the robot has saved.
struct LossyConsole {
    robot: DirectConsole,
    line_count: usize,
    losses: Vec<(usize, Loss)>,
    saved: Calibration,
}

impl Console for LossyConsole {
    type Error = &'static str;

    async fn ask(&mut self, line: &str) -> Result<Reply, &'static str> {
        let index = self.line_count;
        self.line_count += 1;
        let loss = self
            .losses
            .iter()
            .find(|(lost_index, _)| *lost_index == index);
        if let Some((_, Loss::Line)) = loss {
            return Err("the line was lost");
        }
        let reply = self.robot.ask(line).await.expect("the robot answers");
        if line == "save" && reply.answer.starts_with("ok") {
            self.saved = self.robot.calibration();
        }
        match loss {
            None => Ok(reply),
            Some(_) => Err("the answer was lost"),
        }
    }

    async fn pause(&mut self, duration: Duration) -> Result<(), &'static str> {
        self.robot
            .pause(duration)
            .await
            .expect("a pause cannot fail");
        Ok(())
    }
}

/// Performs the action with this number, and ignores a failure, as a person may do.
async fn perform(guide: &mut Guide<LossyConsole>, action: usize, servo: usize, amount: f64) {
    let neutral = [138.59, 41.41, 318.59, 221.41][servo];
    let _ = match action {
        0 => guide.trim(servo, amount).await,
        1 => guide.reverse(servo).await,
        2 => guide.set_scale(servo, 10.0 + amount / 4.0).await,
        3 => {
            let commanded_deg = guide.turn(servo, &SCALE_TURNS_DEG).await.unwrap_or(30.0);
            guide
                .scale_by_turn(servo, commanded_deg, commanded_deg + amount)
                .await
                .map(drop)
        }
        4 => {
            guide
                .limit(servo, [neutral - 80.0 + amount, neutral + 85.0])
                .await
        }
        5 | 6 => guide.save().await,
        7 => guide.restore().await.map(drop),
        _ => {
            let mut calibration = factory_settings();
            calibration.servos[servo].trim = amount.round();
            let _ = guide.replace(&calibration).await;
            Ok(())
        }
    };
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn after_any_actions_and_losses_the_robot_ends_with_the_settings_that_it_saved_last(
        actions in vec((0..9_usize, 0..4_usize, -5.0..5.0), 1..12),
        losses in vec((1..150_usize, prop_oneof![Just(Loss::Line), Just(Loss::Answer)]), 0..12),
        ends_with_save in any::<bool>(),
    ) {
        let mut robot = DirectConsole::power_on(PAPER);
        for line in ["trim 1 5", "save", "trim 1 2"] {
            block_on(robot.ask(line)).expect("the robot answers");
        }
        let saved = robot.calibration();
        let connection = LossyConsole { robot, line_count: 0, losses, saved };
        let mut guide = block_on(Guide::begin(connection)).expect("nothing is lost yet");
        for (action, servo, amount) in actions {
            block_on(perform(&mut guide, action, servo, amount));
        }
        guide.console().losses.clear();
        match ends_with_save {
            true => block_on(guide.save()).expect("the robot answers"),
            false => block_on(guide.restore()).map(drop).expect("the robot answers"),
        }
        prop_assert!(!guide.has_unsaved_changes());
        let shown = guide.calibration().clone();
        let LossyConsole { robot, saved, .. } = guide.console();
        let active = robot.calibration();
        prop_assert!(active.is_equivalent_to(&shown), "{active:?}, shown {shown:?}");
        prop_assert!(active.is_equivalent_to(saved), "{active:?}, saved {saved:?}");
    }
}
