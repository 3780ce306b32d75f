//! The first frames after a reset: the servos wake in the pose in which they are.
//!
//! A servo does not report its angle. But a robot that rested or held a pose until the reset is still in the pose that
//! was saved. So its servos can wake there and need not jump to the neutral pose.

use super::{AWAKE_FRAMES, Motion, WAKE_INTERVAL_FRAMES};
use crate::memory::restart::Stance;
use crate::motion::state::{State, Target};
use crate::numbers::gaits::GaitId;
use crate::numbers::pose::Pose;

impl Motion {
    /// Wakes the servos one after the other; then the robot stands. They wake in the pose in which the robot rested,
    /// or, if that is unsafe or beyond the travel, in the neutral one.
    #[inline(never)]
    pub fn wake(&mut self, rest_pose: Option<&Pose>) {
        self.begin();
        if let Some(pose) = rest_pose
            && self.may_hold(pose)
        {
            self.stance.pose = *pose;
            self.state = State::Holding {
                is_commanded: false,
            };
            self.next_target = Some(Target::Gait(GaitId::STAND));
        }
    }

    /// Keeps the robot at rest, without pulses. It will later wake in the pose of the stance, if that pose is safe and
    /// within the travel.
    #[inline(never)]
    pub fn resume_rest(&mut self, stance: Option<&Stance>) {
        self.freeze(State::Resting);
        if let Some(stance) = stance
            && self.may_hold(&stance.pose)
        {
            self.stance.pose = stance.pose;
            self.stance.sent_pulses = stance.sent_pulses;
        }
    }

    /// Resumes the pulses of servos that were held until a reset. Returns false if their pose is unsafe or beyond the
    /// travel. If `will_stand`, the servos wake one after the other, to spare the supply, and then the robot stands;
    /// otherwise all servos that had pulses get them immediately.
    #[inline(never)]
    pub fn resume(&mut self, stance: &Stance, will_stand: bool) -> bool {
        if !self.may_hold(&stance.pose) {
            return false;
        }
        self.stance.pose = stance.pose;
        self.stance.sent_pulses = stance.sent_pulses;
        self.freeze(State::Holding {
            is_commanded: false,
        });
        if will_stand {
            self.next_target = Some(Target::Gait(GaitId::STAND));
        } else {
            // The next servo to wake waits for a full interval.
            let frames_awake = stance.frames_awake.min(AWAKE_FRAMES);
            self.stance.frames_awake = frames_awake - frames_awake % WAKE_INTERVAL_FRAMES;
        }
        self.settle();
        true
    }

    /// True if a pose is safe and within the travel.
    fn may_hold(&self, pose: &Pose) -> bool {
        self.hazard_of(pose).is_none()
    }
}
