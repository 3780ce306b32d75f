//! The robot's motion, frame by frame, with everything checked that no frame
//! may do, whatever has been asked of the robot.

use lizard::gait::GaitId;
use lizard::hazard::Hazard;
use lizard::motion::{Activity, Motion};
use lizard::pose::{Pose, Pulses};
use lizard::robot::{SERVOS, SLEW};
use lizard_host_tests::robot;
use proptest::prelude::*;

use crate::truth::{Verdict, angles};

/// Frames until all servos are awake.
pub const WAKING: u32 = 20;

/// The most that a servo's speed changes from one frame to the next, deg/s, but
/// for `stop`, `rest` and the guard, which freeze it. Met where a stroke of
/// eight frames ends and another one leads straight back (137), and nearly so in
/// the returns of crawl and trot.
pub const JERK: f64 = 150.0;

/// A step of angle in a frame, as deg/s.
pub const STEP_PER_FRAME: f64 = 50.0 * 360.0 / 65536.0;

/// Something to ask of the robot.
#[derive(Clone, Copy, Debug)]
pub enum Wish {
    Gait(GaitId),
    Pose(Pose),
    Stop,
    Rest,
    Speed(u8),
}

impl Wish {
    /// Any wish at all, poses within the servos' travel.
    pub fn any() -> impl Strategy<Value = Self> {
        let gaits: Vec<GaitId> = GaitId::all().collect();
        let near = prop::array::uniform4(-6000i16..=6000);
        let far = prop::array::uniform4(-16_384i16..=16_384);
        prop_oneof![
            6 => prop::sample::select(gaits).prop_map(Self::Gait),
            3 => near.prop_map(|sweeps| Self::Pose(Pose(sweeps))),
            2 => far.prop_map(|sweeps| Self::Pose(Pose(sweeps))),
            1 => Just(Self::Stop),
            1 => Just(Self::Rest),
            2 => (10u8..=100).prop_map(Self::Speed),
        ]
    }

    /// Wishes, and for how many frames the robot is left with each.
    pub fn sequence() -> impl Strategy<Value = Vec<(Self, u32)>> {
        prop::collection::vec((Self::any(), 0u32..120), 1..14)
    }
}

/// A robot whose every frame is checked as it is sent.
pub struct Robot {
    pub motion: Motion,
    /// Degrees a second of each servo in the last frame.
    speeds: [f64; 4],
    /// True if the next frame may stop dead.
    may_stop: bool,
    /// The fastest frame so far in gaits, and in strokes, in steps.
    pub fastest: [u16; 2],
    /// The largest change of speed so far, deg/s.
    pub jerk: f64,
}

impl Robot {
    /// A robot at power-on.
    pub fn new() -> Self {
        Self {
            motion: Motion::new(),
            speeds: [0.0; 4],
            may_stop: false,
            fastest: [0; 2],
            jerk: 0.0,
        }
    }

    /// A robot that is awake and stands.
    pub fn standing() -> Self {
        let mut robot = Self::new();
        robot.run(WAKING + 1);
        robot
    }

    pub fn pose(&self) -> Pose {
        *self.motion.pose()
    }

    pub fn is_resting(&self) -> bool {
        self.motion.activity() == Activity::Rest
    }

    /// Asks for something as the console does: while the robot rests, only to
    /// stand, to rest and for a speed.
    pub fn wish(&mut self, wish: Wish) -> Result<(), Hazard> {
        let resting = self.is_resting();
        match wish {
            Wish::Gait(gait) if gait == GaitId::STAND || !resting => self.motion.gait(gait),
            Wish::Pose(pose) if !resting => return self.motion.pose_to(&pose),
            Wish::Stop if !resting => {
                self.motion.stop();
                self.may_stop = true;
            }
            Wish::Rest => {
                self.motion.rest();
                self.may_stop = true;
            }
            Wish::Speed(percent) => self.motion.set_speed(percent),
            _ => {}
        }
        Ok(())
    }

    /// Some frames.
    pub fn run(&mut self, frames: u32) {
        for _ in 0..frames {
            self.frame();
        }
    }

    /// A frame that may do nothing that a frame must not.
    pub fn frame(&mut self) -> Pulses {
        let before = self.pose();
        let held_before = self.motion.hazard().is_some();
        let pulses = self.motion.tick();
        let pose = self.pose();

        let guard_stopped = !held_before && self.motion.hazard().is_some();
        if guard_stopped {
            assert_eq!(pose, before, "the guard holds the last safe pose");
        }
        assert_ne!(
            Verdict::of(angles(&pose)),
            Verdict::Unsafe,
            "{:?}",
            angles(&pose)
        );
        for (servo, limits) in SERVOS.iter().enumerate() {
            let width = pulses.0[servo];
            assert!(width == 0 || width == limits.width(pose.0[servo]));
            assert!(limits.reaches(pose.0[servo]));
        }

        // Within a stroke the phase is 0; elsewhere a gait's is, once a cycle.
        let in_gait = self.motion.phase() != 0;
        let farthest = before.farthest(&pose);
        let fastest = &mut self.fastest[usize::from(!in_gait)];
        *fastest = (*fastest).max(farthest);
        if in_gait {
            let most = robot().pace.gait_slew / STEP_PER_FRAME;
            assert!(f64::from(farthest) <= most, "{farthest} steps in a frame");
        } else {
            assert!(farthest <= SLEW, "{farthest} steps in a frame");
        }

        let speeds: [f64; 4] = std::array::from_fn(|n| {
            (f64::from(pose.0[n]) - f64::from(before.0[n])) * STEP_PER_FRAME
        });
        for (speed, last) in speeds.iter().zip(&self.speeds) {
            let change = (speed - last).abs();
            if !(self.may_stop || guard_stopped) {
                assert!(change <= JERK, "{last} and then {speed} deg/s");
                self.jerk = self.jerk.max(change);
            }
        }
        self.speeds = speeds;
        self.may_stop = false;
        pulses
    }
}
