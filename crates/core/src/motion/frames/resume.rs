//! The first frames after a reset, in which the servos wake in their current pose.
//!
//! A servo does not report its angle. But a robot that rested or held a pose until the reset is still in the saved
//! pose. Therefore its servos can wake in this pose and need not jump to the neutral pose.

use super::{AWAKE_FRAMES, Motion, WAKE_INTERVAL_FRAMES};
use crate::memory::restart::ServoState;
use crate::motion::state::{State, Target};
use crate::numbers::gaits::GaitId;
use crate::numbers::pose::Pose;

impl Motion {
    /// Wakes the servos one after another; then the robot stands. The servos wake in the rest pose, or in the neutral
    /// pose if there is no rest pose, or if it is unsafe or beyond a servo's travel.
    #[inline(never)]
    pub fn wake(&mut self, rest_pose: Option<&Pose>) {
        self.start_standing();
        if let Some(pose) = rest_pose
            && self.can_hold(pose)
        {
            self.servo_state.pose = *pose;
            self.state = State::Holding {
                is_commanded: false,
            };
            self.next_target = Some(Target::Gait(GaitId::STAND));
        }
    }

    /// Keeps the robot at rest, without pulses. The robot will later wake in the pose of `servo_state`, if there is one
    /// and this pose is safe and within the servos' travel.
    #[inline(never)]
    pub fn resume_rest(&mut self, servo_state: Option<&ServoState>) {
        self.freeze(State::Resting);
        if let Some(servo_state) = servo_state
            && self.can_hold(&servo_state.pose)
        {
            self.servo_state.pose = servo_state.pose;
            self.servo_state.sent_pulses = servo_state.sent_pulses;
        }
    }

    /// Resumes the pulses of servos that held a pose until a reset. Returns false if this pose is unsafe or beyond a
    /// servo's travel. If `will_stand` is true, the servos wake one after another, to limit the load on the supply, and
    /// then the robot stands; otherwise all servos that had pulses get them immediately.
    #[inline(never)]
    pub fn resume(&mut self, servo_state: &ServoState, will_stand: bool) -> bool {
        if !self.can_hold(&servo_state.pose) {
            return false;
        }
        self.servo_state.pose = servo_state.pose;
        self.servo_state.sent_pulses = servo_state.sent_pulses;
        self.freeze(State::Holding {
            is_commanded: false,
        });
        if will_stand {
            self.next_target = Some(Target::Gait(GaitId::STAND));
        } else {
            // A servo that was not yet awake at the reset wakes after a full interval.
            let frames_awake = servo_state.frames_awake.min(AWAKE_FRAMES);
            self.servo_state.frames_awake = frames_awake - frames_awake % WAKE_INTERVAL_FRAMES;
        }
        self.settle();
        true
    }

    /// True if a pose is safe and within the servos' travel.
    fn can_hold(&self, pose: &Pose) -> bool {
        self.first_hazard(pose).is_none()
    }
}
