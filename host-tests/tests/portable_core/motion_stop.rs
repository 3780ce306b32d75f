//! `stop` and `rest`, from every frame of every motion.

use lizard::gait::GaitId;
use lizard::motion::Activity;
use lizard::pose::{Pose, Pulses};
use lizard_host_tests::robot;

use crate::frames::{Robot, WAKING, Wish};

/// Frames from a standing start to the end of a whole cycle of a gait at a
/// speed in percent: stroke, gathering pace, cycle.
fn cycle(gait: GaitId, percent: u8) -> u32 {
    let index = GaitId::all().position(|id| id == gait).expect("a gait");
    let period = robot().gaits[index].period * 100.0 / f64::from(percent);
    60 + (period * 50.0).ceil() as u32
}

/// A robot some frames after it was asked for a gait.
fn under_way(gait: GaitId, percent: u8, frames: u32) -> Robot {
    let mut robot = Robot::standing();
    for wish in [Wish::Speed(percent), Wish::Gait(gait)] {
        robot.wish(wish).expect("a gait is no pose");
    }
    robot.run(frames);
    robot
}

#[test]
fn stop_freezes_the_pose_in_the_next_frame_from_every_frame_of_every_gait() {
    for gait in GaitId::all() {
        for percent in [100, 37] {
            let mut moving = Robot::standing();
            for wish in [Wish::Speed(percent), Wish::Gait(gait)] {
                moving.wish(wish).expect("a gait is no pose");
            }
            for frame in 0..cycle(gait, percent) {
                let mut stopped = under_way(gait, percent, frame);
                assert_eq!(stopped.pose(), moving.pose());
                let pose = stopped.pose();
                stopped.wish(Wish::Stop).expect("always");
                for _ in 0..50 {
                    let pulses = stopped.frame();
                    assert_eq!(stopped.pose(), pose, "{gait:?}, frame {frame}");
                    assert_eq!(pulses, pose.pulses());
                }
                assert_eq!(stopped.motion.activity(), Activity::Stop);
                moving.run(1);
            }
        }
    }
}

#[test]
fn stop_freezes_every_frame_of_a_stroke() {
    let goal = Pose([4000, -4000, 3000, -3000]);
    for frame in 0..50 {
        let mut robot = Robot::standing();
        robot.wish(Wish::Pose(goal)).expect("a safe pose");
        robot.run(frame);
        let pose = robot.pose();
        robot.wish(Wish::Stop).expect("always");
        robot.run(50);
        assert_eq!(robot.pose(), pose);
    }
}

#[test]
fn stop_while_a_new_wish_waits_forgets_the_wish() {
    let walk = GaitId::all().nth(1).expect("walk");
    for frame in 0..60 {
        let mut robot = under_way(walk, 100, 60 + frame);
        robot
            .wish(Wish::Pose(Pose([900, 900, 900, 900])))
            .expect("a safe pose");
        robot.run(3);
        let pose = robot.pose();
        robot.wish(Wish::Stop).expect("always");
        robot.run(100);
        assert_eq!(robot.pose(), pose);
    }
}

#[test]
fn rest_ends_the_pulses_in_the_next_frame_from_every_frame_of_every_gait() {
    for gait in GaitId::all() {
        for frame in 0..cycle(gait, 100) {
            let mut robot = under_way(gait, 100, frame);
            let pose = robot.pose();
            robot.wish(Wish::Rest).expect("always");
            for _ in 0..5 {
                assert_eq!(robot.frame(), Pulses::default(), "{gait:?}, frame {frame}");
            }
            assert_eq!(robot.pose(), pose);
        }
    }
}

#[test]
fn after_rest_the_robot_stands_up_from_where_it_was_left() {
    for gait in GaitId::all() {
        for frame in [0, 7, 60, 83] {
            let mut robot = under_way(gait, 100, frame);
            robot.wish(Wish::Rest).expect("always");
            robot.run(40);
            robot.wish(Wish::Gait(GaitId::STAND)).expect("always");
            robot.run(WAKING + 40);
            assert_eq!(robot.pose(), Pose::NEUTRAL);
            assert_eq!(robot.motion.activity(), Activity::Gait(GaitId::STAND));
        }
    }
}

#[test]
fn a_stopped_robot_begins_a_gait_anew_at_its_first_pose() {
    for gait in GaitId::all() {
        let mut robot = under_way(gait, 100, 83);
        robot.wish(Wish::Stop).expect("always");
        robot.run(5);
        robot.wish(Wish::Gait(gait)).expect("a gait is no pose");
        let first = gait.load().pose(0);
        let arrived = (0..60).any(|_| {
            robot.run(1);
            robot.motion.phase() == 0 && robot.pose() == first
        });
        assert!(arrived, "{gait:?}");
    }
}
