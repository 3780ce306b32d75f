//! From any motion to any other: limits that every frame keeps, and the end
//! that every wish comes to.

use lizard::clearance::Clearance;
use lizard::gait::GaitId;
use lizard::motion::Activity;
use lizard::pose::Pose;
use lizard::robot::{SERVOS, SLEW};
use proptest::prelude::*;

use crate::frames::{Robot, WAKING, Wish};
use crate::truth::Numbers;

/// Frames in which any wish comes to its end: braking, the longest stroke at
/// the slew limit, gathering pace.
const LONG_ENOUGH: u32 = 8 + 52 + 8;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn no_frame_is_too_fast_too_sudden_or_unsafe_whatever_is_asked(wishes in Wish::sequence()) {
        let mut robot = Robot::new();
        for (wish, frames) in wishes {
            let unsafe_pose = match wish {
                Wish::Pose(pose) => Clearance::of(&pose).hazard().is_some(),
                _ => false,
            };
            let resting = robot.is_resting();
            let refused = robot.wish(wish).is_err();
            prop_assert_eq!(refused, unsafe_pose && !resting);
            robot.run(frames);
        }
    }

    #[test]
    fn every_wish_comes_to_its_end_or_the_guard_says_why_not(
        wishes in Wish::sequence(),
        last in Wish::any(),
    ) {
        let mut robot = Robot::new();
        for (wish, frames) in wishes {
            let _ = robot.wish(wish);
            robot.run(frames);
        }
        if robot.wish(Wish::Gait(GaitId::STAND)).is_err() || robot.wish(last).is_err() {
            return Ok(());
        }
        robot.run(WAKING + LONG_ENOUGH);
        if robot.motion.hazard().is_some() {
            prop_assert!(matches!(robot.motion.activity(), Activity::Stop | Activity::Rest));
            return Ok(());
        }
        let before = robot.pose();
        let phase = robot.motion.phase();
        robot.frame();
        match last {
            Wish::Gait(gait) => {
                prop_assert_eq!(robot.motion.activity(), Activity::Gait(gait));
                prop_assert_eq!(robot.pose(), gait.load().pose(robot.motion.phase()));
                prop_assert_ne!(robot.motion.phase(), phase);
            }
            Wish::Pose(pose) => {
                prop_assert_eq!(robot.motion.activity(), Activity::Pose);
                prop_assert_eq!((before, robot.pose()), (pose, pose));
            }
            Wish::Stop => prop_assert_eq!(robot.motion.activity(), Activity::Stop),
            Wish::Rest => prop_assert_eq!(robot.motion.activity(), Activity::Rest),
            Wish::Speed(_) => prop_assert_eq!(robot.motion.activity(), Activity::Gait(GaitId::STAND)),
        }
    }

    #[test]
    fn a_pose_that_is_refused_changes_nothing(
        wishes in Wish::sequence(),
        pose in prop::array::uniform4(-16_384i16..=16_384),
    ) {
        prop_assume!(Clearance::of(&Pose(pose)).hazard().is_some());
        let (mut asked, mut spared) = (Robot::new(), Robot::new());
        for (wish, frames) in wishes {
            for robot in [&mut asked, &mut spared] {
                let _ = robot.wish(wish);
                robot.run(frames);
            }
        }
        if !asked.is_resting() {
            prop_assert!(asked.wish(Wish::Pose(Pose(pose))).is_err());
        }
        for _ in 0..60 {
            prop_assert_eq!(asked.frame(), spared.frame());
            prop_assert_eq!(asked.motion.activity(), spared.motion.activity());
            prop_assert_eq!(asked.motion.phase(), spared.motion.phase());
        }
    }
}

#[test]
fn the_figures_that_the_docs_quote_are_reached_and_not_passed() {
    // Many wishes in a row, so that the extremes are met.
    let gaits: Vec<GaitId> = GaitId::all().collect();
    let mut numbers = Numbers::new(5);
    let mut robot = Robot::standing();
    for _ in 0..6000 {
        let wish = match numbers.within(0, 9) {
            0..5 => Wish::Gait(gaits[numbers.within(0, gaits.len() as i16 - 1) as usize]),
            5 => Wish::Speed(numbers.within(10, 100) as u8),
            _ => Wish::Pose(numbers.safe_pose()),
        };
        let _ = robot.wish(wish);
        robot.run(numbers.within(1, 90) as u32);
    }
    let [gait, stroke] = robot
        .fastest
        .map(|steps| f64::from(steps) * crate::frames::STEP_PER_FRAME);
    println!(
        "fastest frame of a gait {gait:.1} deg/s, of a stroke {stroke:.1} deg/s, \
         largest change of speed {:.1} deg/s in a frame",
        robot.jerk
    );
    assert!(stroke > 290.0 && gait > 290.0 && robot.jerk > 110.0);
}

#[test]
fn a_pose_moves_all_servos_together_and_they_arrive_in_the_same_frame() {
    let mut numbers = Numbers::new(6);
    let mut arrived_early = 0;
    for _ in 0..2000 {
        let mut robot = Robot::standing();
        let goal = numbers.safe_pose();
        robot.wish(Wish::Pose(goal)).expect("a safe pose");
        let mut before = robot.pose();
        let mut frames = 0;
        while robot.pose() != goal && robot.motion.hazard().is_none() {
            before = robot.pose();
            robot.frame();
            frames += 1;
            assert!(frames <= LONG_ENOUGH);
        }
        if robot.motion.hazard().is_some() {
            continue;
        }
        // In the frame before the last, the farthest is at least as far as it
        // can see; one whose whole way is a few degrees may be a step short.
        for n in 0..4 {
            let way = f64::from(goal.0[n]).abs();
            let left = f64::from(goal.0[n].abs_diff(before.0[n]));
            let share =
                f64::from(before.farthest(&goal)) / f64::from(Pose::NEUTRAL.farthest(&goal));
            assert!((left - share * way).abs() <= 3.0, "{goal:?} A{}", n + 1);
            arrived_early += u32::from(left == 0.0 && share * way > 1.5);
        }
    }
    assert_eq!(arrived_early, 0);
}

#[test]
fn servos_wake_one_after_another_before_anything_moves() {
    for reawakened in [false, true] {
        let mut robot = Robot::new();
        let pose = Pose([700, -300, 250, -900]);
        if reawakened {
            robot.run(WAKING);
            robot.wish(Wish::Pose(pose)).expect("a safe pose");
            robot.run(LONG_ENOUGH);
            robot.wish(Wish::Rest).expect("always");
            robot.run(10);
            robot.wish(Wish::Gait(GaitId::STAND)).expect("always");
        }
        let held = if reawakened { pose } else { Pose::NEUTRAL };
        let mut awake_since = [0; 4];
        for frame in 1..=WAKING {
            let pulses = robot.frame();
            for (servo, width) in pulses.0.into_iter().enumerate() {
                if width > 0 && awake_since[servo] == 0 {
                    awake_since[servo] = frame;
                }
                // Once awake, a servo gets the width where it was left.
                assert!(width == 0 || width == SERVOS[servo].width(held.0[servo]));
                assert_eq!(width > 0, awake_since[servo] > 0, "awake for good");
            }
        }
        // A tenth of a second from one to the next.
        assert_eq!(awake_since, [5, 10, 15, 20]);
        robot.run(LONG_ENOUGH);
        assert_eq!(robot.pose(), Pose::NEUTRAL);
    }
}

#[test]
fn a_wish_while_waking_waits_until_all_are_awake() {
    let mut robot = Robot::new();
    robot.run(3);
    let pose = Pose([800, -800, 0, 0]);
    robot.wish(Wish::Pose(pose)).expect("a safe pose");
    robot.run(WAKING - 3);
    assert_eq!(robot.pose(), Pose::NEUTRAL);
    robot.run(LONG_ENOUGH);
    assert_eq!(robot.pose(), pose);
}

#[test]
fn a_wish_in_the_middle_of_a_stroke_turns_it_aside_without_a_jump() {
    // Robot::frame checks speed and its changes in every frame.
    let (there, back) = (
        Pose([3000, -3000, 3000, -3000]),
        Pose([-3000, 3000, -3000, 3000]),
    );
    for frame in 0..30 {
        let mut robot = Robot::standing();
        robot.wish(Wish::Pose(there)).expect("a safe pose");
        robot.run(frame);
        robot.wish(Wish::Pose(back)).expect("a safe pose");
        robot.run(LONG_ENOUGH);
        assert_eq!(robot.pose(), back);
        assert!(robot.fastest[1] <= SLEW);
    }
}
