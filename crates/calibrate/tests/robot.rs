//! Calibrations of the firmware's own console, without a chip and without a wait.

use std::convert::Infallible;
use std::time::Duration;

use lizard_calibrate::{Console, ConsoleError, Guide, Reply, SCALE_TURNS, SendError, read, send};
use lizard_core::virtual_board::RunningRobot;
use lizard_robot::edit::without_gait;
use lizard_robot::{Calibration, Robot};
use pollster::block_on;
use proptest::collection::vec;
use proptest::prelude::*;

/// The robot.toml of the paper's robot.
const PAPER: &str = include_str!("../../../robots/paper.toml");

/// A robot, whose lines arrive.
struct Direct(RunningRobot);

impl Direct {
    fn of(text: &str) -> Self {
        let robot = Robot::parse(text).expect("its robot.toml is right");
        let mut running = RunningRobot::power_on(*robot.firmware());
        running.run_frames(10);
        Self(running)
    }

    fn calibration(&mut self) -> Calibration {
        block_on(read(self)).expect("it answers")
    }
}

impl Console for Direct {
    type Error = Infallible;

    async fn ask(&mut self, line: &str) -> Result<Reply, Infallible> {
        self.0.read_lines();
        let mut notes = self.0.send(format!("{line}\r").as_bytes());
        let is_answer = |line: &String| !line.starts_with('#');
        while !notes.iter().any(is_answer) {
            notes.extend(self.0.run_frames(1));
        }
        let index = notes.iter().position(is_answer).expect("it was found");
        let answer = notes.remove(index);
        notes.truncate(index);
        Ok(Reply { notes, answer })
    }

    async fn pause(&mut self, time: Duration) -> Result<(), Infallible> {
        self.0.run_frames(time.as_millis().div_ceil(20) as u32);
        Ok(())
    }
}

/// The factory settings of the paper's robot.
fn factory_settings() -> Calibration {
    Direct::of(PAPER).calibration()
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
    let mut robot = Direct::of(PAPER);
    let mut calibration = factory_settings();
    calibration.servos[1].trim = -3.25;
    calibration.servos[2].dir = '-';
    calibration.servos[3].scale = 10.57;
    calibration.servos[0].limit = [70.0, -150.0];
    calibration.boot = "arc left".to_owned();
    calibration.deadman = 1500;
    block_on(send(&mut robot, &calibration)).expect("it takes them");
    let read_back = robot.calibration();
    assert!(calibration.is_equivalent_to(&read_back), "{read_back:?}");
    assert!(!calibration.is_equivalent_to(&factory_settings()));
}

#[test]
fn a_setting_that_the_current_ones_forbid_is_retried_after_the_others() {
    // With a travel of 400 us to each side, a large trim and a large scale exclude each other.
    let narrow_robot = PAPER.replace("min_us = 600.0", "min_us = 1100.0");
    let narrow_robot = narrow_robot.replace("max_us = 2400.0", "max_us = 1900.0");
    let mut robot = Direct::of(&narrow_robot);
    let initial = robot.calibration();
    let [mut scaled, mut trimmed] = [initial.clone(), initial];
    scaled.servos[0].scale = 16.0;
    trimmed.servos[0].trim = 15.0;
    for calibration in [&trimmed, &scaled, &trimmed] {
        block_on(send(&mut robot, calibration)).expect("it takes them");
        let read_back = robot.calibration();
        assert!(calibration.is_equivalent_to(&read_back), "{read_back:?}");
    }
}

#[test]
fn settings_that_do_not_suit_the_gaits_are_refused_and_the_old_ones_come_back() {
    let mut guide = block_on(Guide::begin(Direct::of(PAPER))).expect("it answers");
    block_on(guide.trim(2, 1.5)).expect("it is accepted");
    let mut calibration = factory_settings();
    calibration.servos[0].trim = 4.0;
    calibration.servos[1].limit = [40.0, 43.0];
    let error = block_on(guide.replace(&calibration)).expect_err("too narrow");
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
fn a_sign_or_a_scale_whose_trim_is_refused_is_taken_back() {
    let mut guide = block_on(Guide::begin(Direct::of(PAPER))).expect("it answers");
    block_on(guide.trim(0, 19.0)).expect("it is accepted");
    // The horn stays where it is, so half the scale needs twice the trim: more than a trim may have.
    let refusal = block_on(guide.scale(0, 5.0)).expect_err("the trim is too large");
    assert!(
        refusal
            .to_string()
            .starts_with("the robot refuses `trim 1 38.00`"),
        "{refusal}"
    );
    let robots = guide.console().calibration().servos[0];
    assert_eq!((robots.scale, robots.trim), (10.0, 19.0));
    assert_eq!(guide.calibration().servos[0], robots);
}

#[test]
fn a_scale_is_measured_by_a_turn_as_large_as_the_robot_accepts() {
    let mut guide = block_on(Guide::begin(Direct::of(PAPER))).expect("it answers");
    let told = block_on(guide.turn(0, &SCALE_TURNS)).expect("one is accepted");
    let pose = guide.console().0.status_value("pose");
    let a1: f64 = pose
        .split(',')
        .next()
        .and_then(|angle| angle.parse().ok())
        .expect("a pose");
    assert!((a1 - 138.59 - told).abs() < 0.02, "{pose} after {told}");
    assert!(told.abs() >= 20.0, "{told}");
    // A servo that turns a tenth too far needs a tenth less pulse.
    let scale = block_on(guide.scale_by_turn(0, told, told * 1.1)).expect("it is accepted");
    assert_eq!(scale, 9.09);
    assert_eq!(guide.console().calibration().servos[0].scale, 9.09);
}

#[test]
fn angles_are_those_of_the_console_and_the_first_refusal_is_the_one_that_is_told() {
    let mut guide = block_on(Guide::begin(Direct::of(PAPER))).expect("it answers");
    let angle = block_on(guide.point(0, 140.004 - 360.0)).expect("it is accepted");
    assert_eq!(angle, 140.0);
    block_on(guide.limit(0, [-300.0, 580.0])).expect("it is accepted");
    assert_eq!(guide.calibration().servos[0].limit, [60.0, 220.0]);
    let refusal = block_on(guide.turn(0, &[170.0, 180.0])).expect_err("too far");
    assert!(refusal.to_string().contains("`pose 308.59 "), "{refusal}");
}

#[test]
fn the_test_walk_is_walk_or_the_first_gait_that_the_robot_has() {
    let others = [
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
    for (count, expected) in [(0, Some("walk")), (4, Some("trot")), (others.len(), None)] {
        let removed = &others[..count];
        let text = removed
            .iter()
            .fold(PAPER.to_owned(), |text, name| without_gait(&text, name));
        let mut guide = block_on(Guide::begin(Direct::of(&text))).expect("it answers");
        let gait = block_on(guide.walk()).expect("it is accepted");
        assert_eq!(gait.as_deref(), expected);
        let gait = guide.console().0.status_value("gait");
        assert_eq!(gait, expected.unwrap_or("stand"));
    }
}

/// The moment at which a line is lost.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lost {
    Line,
    Answer,
}

/// A connection that loses one line, counted from the beginning, or its answer.
struct Cut {
    robot: Direct,
    lines: Vec<String>,
    cut: Option<(usize, Lost)>,
}

impl Console for Cut {
    type Error = &'static str;

    async fn ask(&mut self, line: &str) -> Result<Reply, &'static str> {
        let index = self.lines.len();
        self.lines.push(line.to_owned());
        match self.cut {
            Some((cut, Lost::Line)) if cut == index => Err("the line was lost"),
            Some((cut, Lost::Answer)) if cut == index => {
                let _ = self.robot.ask(line).await;
                Err("the answer was lost")
            }
            _ => Ok(self.robot.ask(line).await.expect("it answers")),
        }
    }

    async fn pause(&mut self, time: Duration) -> Result<(), &'static str> {
        self.robot.pause(time).await.expect("it waits");
        Ok(())
    }
}

/// A calibration with every kind of setting, each on another servo, and two saves.
async fn calibrate<C: Console>(guide: &mut Guide<C>) -> Result<(), ConsoleError<C::Error>> {
    guide.trim(3, 2.0).await?;
    guide.reverse(3).await?;
    guide.save().await?;
    guide.scale(3, 11.0).await?;
    guide.limit(0, [60.0, 220.0]).await?;
    guide.save().await?;
    guide.trim(1, -0.5).await
}

/// Plays the calibration with one line lost, then ends it; returns the guide.
fn cut(cut: (usize, Lost)) -> (Guide<Cut>, bool) {
    let robot = Direct::of(PAPER);
    let connection = Cut {
        robot,
        lines: Vec::new(),
        cut: Some(cut),
    };
    let mut guide = match block_on(Guide::begin(connection)) {
        Ok(guide) => guide,
        Err(error) => panic!("{error}"),
    };
    let result = block_on(calibrate(&mut guide));
    (guide, result.is_err())
}

/// The settings with which the robot would begin after a reset.
fn stored(guide: &mut Guide<Cut>) -> Calibration {
    let robot = &mut guide.console().robot;
    if !robot.0.send_line("load").starts_with("ok") {
        robot.0.expect_accepted("factory");
    }
    robot.calibration()
}

#[test]
fn wherever_a_line_or_its_answer_is_lost_the_guide_ends_with_what_the_robot_has() {
    // The first line has read the settings.
    let mut cuts = 0;
    for index in 1.. {
        for lost in [Lost::Line, Lost::Answer] {
            let (mut guide, is_cut) = cut((index, lost));
            if !is_cut {
                assert!(cuts > 30, "{cuts}");
                return;
            }
            cuts += 1;
            let is_question = guide.console().lines[index] == "status";
            assert!(is_question || guide.is_changed(), "{index}, {lost:?}");
            // Leaving restores what is stored, so a reset changes nothing.
            block_on(guide.restore()).expect("it answers again");
            let active = guide.console().robot.calibration();
            assert!(
                active.is_equivalent_to(guide.calibration()),
                "{index}, {lost:?}"
            );
            assert!(!guide.is_changed(), "{index}, {lost:?}");
            let stored_settings = stored(&mut guide);
            assert!(
                stored_settings.is_equivalent_to(&active),
                "{index}, {lost:?}: {stored_settings:?}, {active:?}"
            );

            // Saving stores what the guide shows.
            let (mut guide, _) = cut((index, lost));
            block_on(guide.save()).expect("it answers again");
            let shown = guide.calibration().clone();
            assert!(
                shown.is_equivalent_to(&guide.console().robot.calibration()),
                "{index}, {lost:?}"
            );
            assert!(
                shown.is_equivalent_to(&stored(&mut guide)),
                "{index}, {lost:?}"
            );
        }
    }
}

#[test]
fn one_servo_turns_on_without_a_return_to_neutral() {
    let mut connection = Cut {
        robot: Direct::of(PAPER),
        lines: Vec::new(),
        cut: None,
    };
    let mut guide = block_on(Guide::begin(&mut connection)).expect("it answers");
    for degrees in [140.0, 141.0] {
        block_on(guide.point(0, degrees)).expect("it is accepted");
    }
    let stands = connection.lines.iter().filter(|line| *line == "stand");
    assert_eq!(stands.count(), 1);
}

#[test]
fn settings_that_were_not_saved_before_come_back_also_after_a_lost_save() {
    // What was saved stays saved.
    for (lost, trim) in [(Lost::Line, 2.0), (Lost::Answer, 3.0)] {
        let mut guide = guide_after(&["trim 1 5", "save", "trim 1 2"], 2, lost);
        block_on(guide.trim(0, 1.0)).expect("it is accepted");
        block_on(guide.save()).expect_err("it is lost");
        for _ in 0..2 {
            block_on(guide.restore()).expect("it answers again");
            let active = guide.console().robot.calibration();
            assert_eq!(active.servos[0].trim, trim);
        }
    }
}

/// A guide of the paper's robot, after some lines, whose line of this index has its answer lost.
fn guide_after(lines: &[&str], index: usize, lost: Lost) -> Guide<Cut> {
    let mut robot = Direct::of(PAPER);
    for line in lines {
        block_on(robot.ask(line)).expect("it answers");
    }
    let connection = Cut {
        robot,
        lines: Vec::new(),
        cut: Some((index, lost)),
    };
    block_on(Guide::begin(connection)).expect("it answers")
}

#[test]
fn what_was_saved_long_before_does_not_come_back_with_a_lost_save() {
    let mut guide = guide_after(&["trim 1 5", "save", "trim 1 2"], 2, Lost::Line);
    block_on(guide.trim(0, 1.0)).expect("it is accepted");
    block_on(guide.save()).expect_err("it is lost");
    block_on(guide.trim(0, -1.0)).expect("it is accepted");
    block_on(guide.restore()).expect("it answers again");
    assert_eq!(guide.console().robot.calibration().servos[0].trim, 2.0);
}

#[test]
fn a_setting_whose_answer_was_lost_is_the_old_one_for_what_follows() {
    let mut guide = guide_after(&[], 1, Lost::Answer);
    block_on(guide.scale(0, 11.0)).expect_err("it is lost");
    let scale = block_on(guide.scale_by_turn(0, 30.0, 30.0)).expect("it is accepted");
    assert_eq!(scale, 11.0);

    let mut guide = guide_after(&[], 1, Lost::Answer);
    block_on(guide.trim(0, 1.5)).expect_err("it is lost");
    let mut calibration = factory_settings();
    calibration.servos[1].limit = [40.0, 43.0];
    block_on(guide.replace(&calibration)).expect_err("too narrow");
    assert_eq!(guide.console().robot.calibration().servos[0].trim, 1.5);
}

/// A robot that accepts any trim of A2 and does nothing.
struct Stubborn(Direct);

impl Console for Stubborn {
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

    async fn pause(&mut self, time: Duration) -> Result<(), Infallible> {
        self.0.pause(time).await
    }
}

#[test]
fn settings_that_are_read_back_differently_are_not_accepted() {
    let mut guide = block_on(Guide::begin(Stubborn(Direct::of(PAPER)))).expect("it answers");
    let mut calibration = factory_settings();
    calibration.servos[0].trim = 1.0;
    calibration.servos[1].trim = 1.0;
    let error = block_on(guide.replace(&calibration)).expect_err("one is missing");
    assert_eq!(error, SendError::Differs);
    let active = guide.console().0.calibration();
    assert!(active.is_equivalent_to(&factory_settings()), "{active:?}");
}

/// A connection that loses some lines, or their answers, and remembers what the robot has saved.
struct Lossy {
    robot: Direct,
    lines: usize,
    losses: Vec<(usize, Lost)>,
    saved: Calibration,
}

impl Console for Lossy {
    type Error = &'static str;

    async fn ask(&mut self, line: &str) -> Result<Reply, &'static str> {
        let index = self.lines;
        self.lines += 1;
        let loss = self.losses.iter().find(|(lost, _)| *lost == index);
        if let Some((_, Lost::Line)) = loss {
            return Err("the line was lost");
        }
        let reply = self.robot.ask(line).await.expect("it answers");
        if line == "save" && reply.answer.starts_with("ok") {
            self.saved = self.robot.calibration();
        }
        match loss {
            None => Ok(reply),
            Some(_) => Err("the answer was lost"),
        }
    }

    async fn pause(&mut self, time: Duration) -> Result<(), &'static str> {
        self.robot.pause(time).await.expect("it waits");
        Ok(())
    }
}

/// Does one of the things that a person may do; a failure is shown to the person, who goes on.
async fn act(guide: &mut Guide<Lossy>, action: usize, servo: usize, amount: f64) {
    let neutral = [138.59, 41.41, 318.59, 221.41][servo];
    let _ = match action {
        0 => guide.trim(servo, amount).await,
        1 => guide.reverse(servo).await,
        2 => guide.scale(servo, 10.0 + amount / 4.0).await,
        3 => {
            let told = guide.turn(servo, &SCALE_TURNS).await.unwrap_or(30.0);
            guide
                .scale_by_turn(servo, told, told + amount)
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
    fn whatever_is_done_and_lost_the_robot_has_at_the_end_what_it_saved_last(
        actions in vec((0..9_usize, 0..4_usize, -5.0..5.0), 1..12),
        losses in vec((1..150_usize, prop_oneof![Just(Lost::Line), Just(Lost::Answer)]), 0..12),
        saves in any::<bool>(),
    ) {
        let mut robot = Direct::of(PAPER);
        for line in ["trim 1 5", "save", "trim 1 2"] {
            block_on(robot.ask(line)).expect("it answers");
        }
        let saved = robot.calibration();
        let connection = Lossy { robot, lines: 0, losses, saved };
        let mut guide = block_on(Guide::begin(connection)).expect("its first line arrives");
        for (action, servo, amount) in actions {
            block_on(act(&mut guide, action, servo, amount));
        }
        guide.console().losses.clear();
        match saves {
            true => block_on(guide.save()).expect("it answers again"),
            false => block_on(guide.restore()).map(drop).expect("it answers again"),
        }
        prop_assert!(!guide.is_changed());
        let shown = guide.calibration().clone();
        let Lossy { robot, saved, .. } = guide.console();
        let active = robot.calibration();
        prop_assert!(active.is_equivalent_to(&shown), "{active:?}, shown {shown:?}");
        prop_assert!(active.is_equivalent_to(saved), "{active:?}, saved {saved:?}");
    }
}
