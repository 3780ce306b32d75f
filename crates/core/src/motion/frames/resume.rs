//! The first frames after a reset: the servos wake in the pose in which they are.
//!
//! A servo does not report its angle. But a robot that rested or held a pose until the reset is still in the pose
//! that was saved, so it can wake there and need not jump to the neutral pose.

use super::{AWAKE_FRAMES, Motion, WAKE_INTERVAL_FRAMES};
use crate::memory::restart::Stance;
use crate::motion::state::{State, Target};
use crate::numbers::gaits::GaitId;
use crate::numbers::pose::Pose;

impl Motion {
    /// Wakes the servos one after the other in the pose in which the robot rested, if it is safe and within the
    /// travel, else in the neutral one; then the robot stands.
    #[inline(never)]
    pub fn wake(&mut self, rest_pose: Option<&Pose>) {
        self.begin();
        if let Some(pose) = rest_pose
            && self.may_hold(pose)
        {
            self.stance.pose = *pose;
            self.state = State::Holding { is_ordered: false };
            self.next = Some(Target::Gait(GaitId::STAND));
        }
    }

    /// Keeps the robot at rest, without pulses. It will wake in the pose of the stance, if that is safe and within
    /// the travel.
    #[inline(never)]
    pub fn resume_rest(&mut self, stance: Option<&Stance>) {
        self.freeze(State::Resting);
        if let Some(stance) = stance
            && self.may_hold(&stance.pose)
        {
            self.stance.pose = stance.pose;
            self.stance.sent = stance.sent;
        }
    }

    /// Resumes servos that were held until a reset, with the pulses that they had. Returns false if their pose
    /// is unsafe or beyond the travel. If the robot `will_stand`, the servos wake one after the other, to spare
    /// the supply, and then it stands; otherwise all that had pulses get them immediately.
    #[inline(never)]
    pub fn resume(&mut self, stance: &Stance, will_stand: bool) -> bool {
        if !self.may_hold(&stance.pose) {
            return false;
        }
        self.stance.pose = stance.pose;
        self.stance.sent = stance.sent;
        self.freeze(State::Holding { is_ordered: false });
        if will_stand {
            self.next = Some(Target::Gait(GaitId::STAND));
        } else {
            // The next servo to wake waits for a full interval.
            let frames_awake = stance.frames_awake.min(AWAKE_FRAMES);
            self.stance.frames_awake = frames_awake - frames_awake % WAKE_INTERVAL_FRAMES;
        }
        self.settle();
        true
    }

    fn may_hold(&self, pose: &Pose) -> bool {
        self.hazard_of(pose).is_none()
    }
}
