//! Tests of each row of the state table in the module's documentation, and of the invariants of every frame.

use std::vec::Vec;

use super::*;
use crate::guard::clearance::Clearance;
use crate::numbers::units::{CYCLE, PulseWidth, Sweep};
use crate::sample::{GAIT_NAMES, Sample};

mod any_order;
mod counted;
mod guarded;
mod settling;
mod waking;

/// Frames until all servos are awake.
const FRAMES_TO_WAKE: u32 = 20;

/// Enough frames for braking, for the longest move in these tests, and for accelerating to full pace.
const TRANSITION_FRAMES: u32 = 150;

impl Motion {
    /// Creates the motion of a robot at power-on: its servos wake, then the robot stands.
    pub(crate) fn new(robot: Robot<'static>) -> Self {
        let mut motion = Self::unstarted(robot);
        motion.speed_percent = FULL_SPEED_PERCENT;
        motion.start_standing();
        motion.calibrate_all(&robot.calibration());
        motion
    }

    /// Creates the motion of [`Sample::asymmetric`], awake and in `stand` at full pace.
    fn standing() -> Self {
        Self::awake(Sample::asymmetric())
    }

    /// Creates the motion of a robot that is awake and in `stand` at full pace, which it reaches in seven frames.
    fn awake(robot: Sample) -> Self {
        let mut motion = Self::new(*robot);
        motion.run(FRAMES_TO_WAKE + 7);
        motion
    }

    /// Creates a motion `frames` frames after the command for a gait.
    fn in_gait(name: &str, frames: u32) -> Self {
        let mut motion = Self::standing();
        motion.start(name);
        motion.run(frames);
        motion
    }

    fn run(&mut self, frames: u32) {
        for _ in 0..frames {
            self.advance_frame();
        }
    }

    fn start(&mut self, name: &str) {
        self.start_gait(self.robot.gait_id(name), 0);
    }

    fn start_for(&mut self, name: &str, cycles: u16) {
        self.start_gait(self.robot.gait_id(name), cycles);
    }

    fn go_to_sweeps(&mut self, sweeps: [i16; 4]) {
        let pose = Pose(sweeps.map(Sweep));
        self.go_to(&pose).expect("the pose is safe");
    }

    fn is_in_move(&self) -> bool {
        matches!(self.state, State::Moving { .. })
    }

    fn is_cycling(&self) -> bool {
        matches!(self.state, State::Cycling { .. })
    }

    fn gait_name(&self) -> Option<&'static str> {
        match self.activity() {
            Activity::Gait(id) => Some(GAIT_NAMES[id.index()]),
            _ => None,
        }
    }

    fn pace(&self) -> u16 {
        match self.state {
            State::Moving { pace, .. } | State::Cycling { pace, .. } => pace,
            _ => 0,
        }
    }

    /// The pulses of the current pose.
    pub(crate) fn pose_pulses(&self) -> Pulses {
        self.servo_state.pose.pulses(&self.calibration)
    }
}

/// The sweeps of a safe pose, in 1/65536 turn.
const SWEEPS: [i16; 4] = [900, -700, 800, -1100];
/// The sweeps of another safe pose, in which each servo is turned the other way.
const OPPOSITE_SWEEPS: [i16; 4] = [-600, 500, -800, 700];

/// Checks that two motions are equal for 100 frames.
fn assert_same_motion(mut first: Motion, mut second: Motion) {
    for _ in 0..100 {
        assert_eq!(first.advance_frame(), second.advance_frame());
        assert_eq!(first.activity(), second.activity());
        assert_eq!(first.phase(), second.phase());
        assert_eq!(first.hazard(), second.hazard());
    }
}

// Resting and holding.

fn make_resting_motion() -> Motion {
    let mut motion = Motion::in_gait("sway", 90);
    motion.rest();
    motion.run(10);
    motion
}

#[test]
fn a_pose_is_held_and_counts_as_pose_if_it_was_commanded_and_as_stop_otherwise() {
    let mut stopped_motion = Motion::in_gait("sway", 90);
    stopped_motion.stop();
    let mut posed_motion = Motion::standing();
    posed_motion.go_to_sweeps(SWEEPS);
    posed_motion.run(TRANSITION_FRAMES);
    assert_eq!(posed_motion.pose(), &Pose(SWEEPS.map(Sweep)));
    assert_eq!(posed_motion.state, State::Holding { is_commanded: true });
    for (mut motion, activity) in [
        (stopped_motion, Activity::Stop),
        (posed_motion, Activity::Pose),
    ] {
        let held_pulses = motion.pose_pulses();
        for _ in 0..50 {
            assert_eq!(motion.advance_frame(), held_pulses);
            assert_eq!(motion.activity(), activity);
        }
    }
}

#[test]
fn from_a_held_pose_the_next_frame_begins_the_move_to_a_gait_or_a_pose() {
    for is_gait in [false, true] {
        let mut motion = Motion::in_gait("sway", 90);
        motion.stop();
        motion.run(5);
        let held_pose = *motion.pose();
        if is_gait {
            motion.start("sway");
        } else {
            motion.go_to_sweeps(SWEEPS);
        }
        motion.advance_frame();
        assert!(motion.is_in_move());
        assert_ne!(motion.pose(), &held_pose);
    }
}

// Moving.

#[test]
fn after_the_move_to_it_a_gait_accelerates_from_phase_0_even_if_it_was_the_stopped_gait() {
    for name in GAIT_NAMES {
        for (stopped_name, held_frames) in [("swing", 0), ("sway", 5)] {
            let mut motion = Motion::in_gait(stopped_name, 90);
            motion.stop();
            motion.run(held_frames);
            motion.start(name);
            let id = motion.robot.gait_id(name);
            let gait = motion.robot.gait(id);
            motion.advance_frame();
            assert!(motion.is_in_move());
            while motion.is_in_move() {
                assert_eq!(motion.phase(), 0);
                motion.advance_frame();
            }
            assert_eq!(motion.state, State::cycling(&motion.robot, id));
            assert_eq!(motion.pose(), &gait.pose(motion.robot.waves(), 0));
            let mut phase = 0;
            for pace in [147, 294, 441, 588, 735, 882, 1024, 1024] {
                motion.advance_frame();
                phase = gait.advance(phase, pace);
                assert_eq!((motion.pace(), motion.phase()), (pace, phase));
                assert_eq!(motion.pose(), &gait.pose(motion.robot.waves(), phase));
            }
        }
    }
}

#[test]
fn a_move_brakes_on_its_line_before_it_turns_to_another_pose() {
    // First, `stand` brakes for seven frames. The move takes 24 frames, and its braking at most seven.
    const FAR_SWEEPS: [i16; 4] = [2900, -2400, 2600, -3300];
    for frames in 8..24 {
        let mut motion = Motion::standing();
        motion.go_to_sweeps(FAR_SWEEPS);
        motion.run(frames);
        motion.go_to_sweeps(OPPOSITE_SWEEPS);
        assert_eq!(motion.activity(), Activity::Pose);
        let mut pace = motion.pace();
        while pace > 0 {
            motion.advance_frame();
            pace = pace.saturating_sub(147);
            assert!(motion.is_in_move() && motion.next_target.is_some());
            assert_eq!(motion.pace(), pace);
            // The pose is still on the line if every servo has covered the same fraction of its distance.
            let fraction_of = |n: usize| f64::from(motion.pose().0[n].0) / f64::from(FAR_SWEEPS[n]);
            assert!((fraction_of(0) - fraction_of(3)).abs() < 0.002);
        }
        motion.advance_frame();
        assert!(motion.next_target.is_none());
        motion.run(TRANSITION_FRAMES);
        assert_eq!(motion.pose(), &Pose(OPPOSITE_SWEEPS.map(Sweep)));
    }
}

#[test]
fn a_move_to_a_gait_continues_when_that_gait_is_commanded_again() {
    let mut motion = Motion::standing();
    motion.go_to_sweeps(SWEEPS);
    motion.run(TRANSITION_FRAMES);
    motion.start("sway");
    motion.run(4);
    assert!(motion.is_in_move());
    let mut repeated_motion = motion.clone();
    repeated_motion.start("sway");
    assert_same_motion(repeated_motion, motion);
}

// Cycling.

#[test]
fn the_same_gait_commanded_again_continues_in_the_middle_of_its_cycle() {
    // `stray` becomes unsafe in the middle of its cycle.
    for name in GAIT_NAMES.into_iter().filter(|name| *name != "stray") {
        let build_motion = || Motion::in_gait(name, 60);
        let mut repeated_motion = build_motion();
        repeated_motion.start(name);
        assert_same_motion(repeated_motion, build_motion());
    }
}

#[test]
fn a_gait_brakes_along_its_cycle_before_the_move_to_another_gait_begins() {
    let mut motion = Motion::in_gait("sway", 90);
    let gait = motion.robot.gait(motion.robot.gait_id("sway"));
    motion.start("swing");
    let mut phase = motion.phase();
    for pace in [877, 730, 583, 436, 289, 142, 0] {
        motion.advance_frame();
        phase = gait.advance(phase, pace);
        assert_eq!((motion.pace(), motion.phase()), (pace, phase));
        assert_eq!(motion.pose(), &gait.pose(motion.robot.waves(), phase));
        let claim = "the activity is that of the next target";
        assert_eq!(motion.gait_name(), Some("swing"), "{claim}");
    }
    motion.advance_frame();
    assert!(motion.is_in_move());
    motion.run(TRANSITION_FRAMES);
    assert!(motion.is_cycling());
    assert_eq!(motion.gait_name(), Some("swing"));
}

#[test]
fn the_last_of_several_commands_determines_the_motion() {
    let mut motion = Motion::in_gait("sway", 90);
    motion.start("swing");
    motion.run(2);
    motion.go_to_sweeps(SWEEPS);
    motion.run(2);
    motion.start("back");
    motion.run(TRANSITION_FRAMES);
    assert_eq!(motion.gait_name(), Some("back"));
    assert!(motion.is_cycling());
}

#[test]
fn a_gait_that_is_commanded_again_while_it_brakes_for_another_motion_restarts() {
    let mut motion = Motion::in_gait("sway", 90);
    motion.go_to_sweeps(SWEEPS);
    motion.run(2);
    motion.start("sway");
    motion.run(6);
    assert!(motion.is_in_move());
    motion.run(TRANSITION_FRAMES);
    assert_eq!(motion.gait_name(), Some("sway"));
}

#[test]
fn a_new_speed_changes_the_pace_step_by_step() {
    let mut motion = Motion::in_gait("sway", 90);
    motion.set_speed(50);
    assert_eq!(motion.speed_percent(), 50);
    let mut paces = Vec::new();
    for _ in 0..5 {
        motion.advance_frame();
        paces.push(motion.pace());
    }
    assert_eq!(paces, [877, 730, 583, 512, 512]);
    motion.set_speed(100);
    motion.run(10);
    assert_eq!(motion.pace(), pace::FULL_PACE);
}

// `stop` and `rest` in any state.

#[test]
fn stop_freezes_the_pose_in_the_next_frame_of_every_gait_and_of_the_move_to_it() {
    for name in GAIT_NAMES {
        for frames in 0..140 {
            let mut motion = Motion::in_gait(name, frames);
            let pose = *motion.pose();
            motion.stop();
            assert_eq!(motion.phase(), 0, "a frozen robot is in no cycle");
            motion.run(20);
            assert_eq!(motion.activity(), Activity::Stop);
            assert_eq!(motion.pose(), &pose, "{name}, frame {frames}");
            assert_eq!(motion.advance_frame(), motion.pose_pulses());
        }
    }
}

#[test]
fn rest_ends_the_pulses_in_the_next_frame_of_every_gait_and_the_pose_stays() {
    for name in GAIT_NAMES {
        for frames in 0..140 {
            let mut motion = Motion::in_gait(name, frames);
            let pose = *motion.pose();
            motion.rest();
            for _ in 0..50 {
                assert_eq!(motion.advance_frame(), Pulses::default());
                assert_eq!(motion.activity(), Activity::Rest);
                assert_eq!((motion.pose(), motion.phase()), (&pose, 0));
            }
        }
    }
}

#[test]
fn stop_and_rest_cancel_the_next_motion() {
    for command in [Motion::stop, Motion::rest] {
        let mut motion = Motion::in_gait("sway", 90);
        motion.go_to_sweeps(SWEEPS);
        motion.run(3);
        let pose = *motion.pose();
        command(&mut motion);
        motion.run(TRANSITION_FRAMES);
        assert_eq!(motion.pose(), &pose);
    }
}

#[test]
fn frames_are_counted_from_power_on_even_while_the_robot_rests() {
    let mut motion = Motion::new(*Sample::asymmetric());
    motion.run(30);
    motion.rest();
    motion.run(12);
    assert_eq!(motion.frame_count(), 42);
}
