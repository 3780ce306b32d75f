//! Tests of the guard's effect on a motion.

use super::*;

/// Returns the motion of a robot that the guard holds.
fn run_until_held() -> Motion {
    let mut motion = Motion::standing();
    motion.start("stray");
    for _ in 0..200 {
        motion.advance_frame();
        if motion.hazard().is_some() {
            return motion;
        }
    }
    panic!("the guard has not held the robot in `stray`");
}

#[test]
fn an_unsafe_pose_is_never_sent_and_the_last_safe_pose_is_held() {
    let mut motion = Motion::standing();
    motion.start("stray");
    let mut last_safe_pose = *motion.pose();
    while motion.hazard().is_none() {
        last_safe_pose = *motion.pose();
        motion.advance_frame();
    }
    let hazard = motion.hazard();
    let last_safe_pulses = last_safe_pose.pulses(&motion.calibration);
    assert_eq!(motion.pose(), &last_safe_pose);
    assert_eq!(motion.activity(), Activity::Stop);
    assert_eq!(motion.phase(), 0);
    for _ in 0..100 {
        assert_eq!(motion.advance_frame(), last_safe_pulses);
        assert_eq!(motion.hazard(), hazard);
    }
    // The reported hazard occurs in the gait's poses.
    let gait = motion.robot.gait(motion.robot.gait_id("stray"));
    let mut hazards = (0..CYCLE).step_by(1000).filter_map(|phase| {
        let pose = gait.pose(motion.robot.waves(), phase);
        Clearance::measure(&motion.robot, &pose).first_hazard(&motion.robot)
    });
    let has_same_cause = |other_hazard: Hazard| match (other_hazard, hazard) {
        (Hazard::Margin { margin: a, .. }, Some(Hazard::Margin { margin: b, .. })) => a == b,
        (Hazard::Stroke { side: a, .. }, Some(Hazard::Stroke { side: b, .. })) => a == b,
        _ => false,
    };
    assert!(hazards.any(has_same_cause), "{hazard:?}");
}

#[test]
fn the_hazard_is_kept_after_stop_and_a_refused_pose_until_it_is_cleared() {
    let mut stopped_motion = run_until_held();
    stopped_motion.stop();
    stopped_motion.run(20);
    let is_held = stopped_motion.hazard().is_some();
    assert!(is_held, "stop must not clear the hazard");
    let mut refused_motion = run_until_held();
    assert!(refused_motion.go_to(&Pose([Sweep(13_000); 4])).is_err());
    refused_motion.run(20);
    let is_held = refused_motion.hazard().is_some();
    assert!(is_held, "a refused pose must not clear the hazard");
    let mut motion = run_until_held();
    motion.clear_hazard();
    motion.start("sway");
    motion.run(TRANSITION_FRAMES);
    assert_eq!(motion.hazard(), None);
    assert_eq!(motion.gait_name(), Some("sway"));
}

#[test]
fn a_refused_pose_changes_nothing_and_returns_its_hazard() {
    for name in GAIT_NAMES {
        for frame_count in [0, 3, 20, 70] {
            let mut motion = Motion::in_gait(name, frame_count);
            let pose = Pose([Sweep(12_000), Sweep(0), Sweep(0), Sweep(0)]);
            let expected_hazard =
                Clearance::measure(&motion.robot, &pose).first_hazard(&motion.robot);
            assert_eq!(motion.go_to(&pose).err(), expected_hazard);
            assert!(expected_hazard.is_some());
            assert_same_motion(motion, Motion::in_gait(name, frame_count));
        }
    }
}
