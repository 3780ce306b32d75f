//! Tests of a resting robot, and of servos that wake one after another, at power-on or when a rest ends.

use super::*;

#[test]
fn stop_and_rest_change_nothing_while_the_robot_rests() {
    for order in [Motion::stop, Motion::rest] {
        let mut motion = make_resting_motion();
        order(&mut motion);
        assert_eq!(motion.activity(), Activity::Rest);
        assert_eq!(motion.advance_frame(), Pulses::default());
    }
}

#[test]
fn a_gait_or_a_pose_first_wakes_the_servos_in_the_rest_pose() {
    for goes_to_pose in [false, true] {
        let mut motion = make_resting_motion();
        let pose_before = *motion.pose();
        if goes_to_pose {
            motion.go_to_sweeps(SWEEPS);
            assert_eq!(motion.activity(), Activity::Pose);
        } else {
            motion.start("swing");
            assert_eq!(motion.gait_name(), Some("swing"));
        }
        for _ in 0..FRAMES_TO_WAKE {
            motion.advance_frame();
            assert_eq!(motion.pose(), &pose_before);
        }
        assert_eq!(motion.advance_frame(), motion.pose_pulses());
        assert!(motion.is_in_move());
        motion.run(TRANSITION_FRAMES);
        if goes_to_pose {
            assert_eq!(motion.pose(), &Pose(SWEEPS.map(Sweep)));
        } else {
            assert!(motion.is_cycling());
        }
    }
}

#[test]
fn servos_wake_one_by_one_a_tenth_of_a_second_apart_and_stay_awake() {
    let powered_on_motion = Motion::new(*Sample::asymmetric());
    let mut woken_motion = make_resting_motion();
    woken_motion.start("stand");
    // After a rest during waking, all servos wake again.
    let mut interrupted_motion = powered_on_motion.clone();
    interrupted_motion.run(12);
    interrupted_motion.rest();
    assert_eq!(interrupted_motion.advance_frame(), Pulses::default());
    interrupted_motion.start("stand");
    for mut motion in [powered_on_motion, woken_motion, interrupted_motion] {
        let held_pulses = motion.pose_pulses();
        let mut first_frames = [0; 4];
        for frame in 1..=FRAMES_TO_WAKE {
            for (index, width) in motion.advance_frame().0.into_iter().enumerate() {
                if width != PulseWidth(0) && first_frames[index] == 0 {
                    first_frames[index] = frame;
                }
                let expected_width = match first_frames[index] {
                    0 => PulseWidth(0),
                    _ => held_pulses.0[index],
                };
                assert_eq!(width, expected_width);
            }
        }
        assert_eq!(first_frames, [5, 10, 15, 20]);
    }
}

#[test]
fn after_stop_during_waking_the_servos_wake_but_do_not_move() {
    let mut motion = make_resting_motion();
    motion.start("sway");
    motion.run(7);
    motion.stop();
    let pose = *motion.pose();
    motion.run(TRANSITION_FRAMES);
    assert_eq!(motion.activity(), Activity::Stop);
    assert_eq!(motion.pose(), &pose);
    assert_eq!(motion.advance_frame(), motion.pose_pulses());
    let widths = motion.pose_pulses().0;
    assert!(widths.iter().all(|width| *width > PulseWidth(0)));
}

#[test]
fn a_command_during_waking_waits_until_all_servos_are_awake() {
    let mut motion = Motion::new(*Sample::asymmetric());
    motion.run(3);
    motion.go_to_sweeps(SWEEPS);
    motion.run(FRAMES_TO_WAKE - 3);
    assert_eq!(motion.pose(), &Pose::NEUTRAL);
    motion.run(TRANSITION_FRAMES);
    assert_eq!(motion.pose(), &Pose(SWEEPS.map(Sweep)));
}
