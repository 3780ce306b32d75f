//! Tests of rest, and of waking the servos one after another when it ends.

use super::*;

#[test]
fn while_it_rests_no_frame_has_a_pulse_and_the_pose_is_kept() {
    let mut motion = Motion::in_gait("sway", 90);
    let pose = *motion.pose();
    motion.rest();
    for _ in 0..50 {
        assert_eq!(motion.tick(), Pulses::default());
        assert_eq!(motion.activity(), Activity::Rest);
        assert_eq!(motion.pose(), &pose);
        assert_eq!(motion.phase(), 0);
    }
}

#[test]
fn stop_and_rest_change_nothing_while_it_rests() {
    for order in [Motion::stop, Motion::rest] {
        let mut motion = resting();
        order(&mut motion);
        assert_eq!(motion.activity(), Activity::Rest);
        assert_eq!(motion.tick(), Pulses::default());
    }
}

#[test]
fn a_gait_or_a_pose_wakes_the_servos_where_they_were_left_first() {
    for is_pose in [false, true] {
        let mut motion = resting();
        let left_pose = *motion.pose();
        if is_pose {
            motion.head_for_pose(THERE);
            assert_eq!(motion.activity(), Activity::Pose);
        } else {
            motion.start("swing");
            assert_eq!(motion.gait(), Some("swing"));
        }
        for _ in 0..WAKING {
            motion.tick();
            assert_eq!(motion.pose(), &left_pose);
        }
        assert_eq!(motion.tick(), motion.held());
        assert!(motion.is_moving());
        motion.run(LONG_ENOUGH);
        if is_pose {
            assert_eq!(motion.pose(), &Pose(THERE.map(Sweep)));
        } else {
            assert!(motion.is_cycling());
        }
    }
}

#[test]
fn servos_wake_one_by_one_a_tenth_of_a_second_apart_and_stay_awake() {
    let mut woken_motion = resting();
    woken_motion.start("stand");
    for mut motion in [Motion::new(*Sample::odd()), woken_motion] {
        let held_pulses = motion.held();
        let mut first_frames = [0; 4];
        for frame in 1..=WAKING {
            for (index, width) in motion.tick().0.into_iter().enumerate() {
                if width != Width(0) && first_frames[index] == 0 {
                    first_frames[index] = frame;
                }
                let expected = if first_frames[index] > 0 {
                    held_pulses.0[index]
                } else {
                    Width(0)
                };
                assert_eq!(width, expected);
            }
        }
        assert_eq!(first_frames, [5, 10, 15, 20]);
    }
}

#[test]
fn a_robot_that_is_told_to_rest_while_it_wakes_wakes_from_the_beginning_later() {
    let mut motion = Motion::new(*Sample::odd());
    motion.run(12);
    motion.rest();
    assert_eq!(motion.tick(), Pulses::default());
    motion.start("stand");
    let pulse_flags = (0..WAKING).map(|_| motion.tick().0.map(|width| u8::from(width.0 > 0)));
    let awake_counts: Vec<u8> = pulse_flags.map(|servos| servos.iter().sum()).collect();
    let expected: Vec<u8> = (1..=WAKING).map(|frame| (frame / 5) as u8).collect();
    assert_eq!(awake_counts, expected);
}

#[test]
fn stop_while_it_wakes_lets_the_servos_wake_and_nothing_move() {
    let mut motion = resting();
    motion.start("sway");
    motion.run(7);
    motion.stop();
    let pose = *motion.pose();
    motion.run(LONG_ENOUGH);
    assert_eq!(motion.activity(), Activity::Stop);
    assert_eq!(motion.pose(), &pose);
    assert_eq!(motion.tick(), motion.held());
    assert!(motion.held().0.iter().all(|width| *width > Width(0)));
}

#[test]
fn a_command_during_waking_waits_until_all_servos_are_awake() {
    let mut motion = Motion::new(*Sample::odd());
    motion.run(3);
    motion.head_for_pose(THERE);
    motion.run(WAKING - 3);
    assert_eq!(motion.pose(), &Pose::NEUTRAL);
    motion.run(LONG_ENOUGH);
    assert_eq!(motion.pose(), &Pose(THERE.map(Sweep)));
}
