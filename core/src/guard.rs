//! The singularity guard: how clear of every hazard a pose is.
//!
//! No frame reaches a servo before it has passed here, be it from a gait, a
//! point-to-point move or a pose that somebody typed. The decision is a point
//! test for any pose within the servos' travel, not a box, and holds for head and
//! tail alike: in its own frame the tail is built as the head.
//!
//! Every condition depends on one servo or on two, so all poses can be checked
//! against floating point by walking every pair of angles: `make prove`.

use crate::five_bar::EndMargins;
use crate::hazard::{Hazard, Margin};
use crate::part::{End, Servo, Side};
use crate::pose::Pose;
use crate::robot::Robot;
use crate::trig::Direction;
use crate::units::Sine;

/// The smallest margins allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Between the couplers of head and tail.
    pub type2: Sine,
    /// Between each crank and its coupler.
    pub type1: Sine,
    /// Of each parallelogram leg.
    pub leg: Sine,
}

/// Every margin of one pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clearance {
    /// Head and tail.
    pub type2: [Sine; 2],
    /// A1 to A4.
    pub type1: [Sine; 4],
    /// A1 to A4: sin theta_lg in the frame of its end, which is negative beyond a
    /// change point (0, 180 deg), where the parallelogram may have come out crossed.
    pub leg: [Sine; 4],
    /// The sliders' squared lengths, left and right, in their steps.
    pub sliders_sq: [u32; 2],
}

impl Clearance {
    /// Measures a pose.
    pub fn of<R: Robot>(robot: &R, pose: &Pose) -> Self {
        let angles = pose.angles(&robot.neutral());
        let [a1, a2, a3, a4] = angles.map(Direction::of);
        let (rear_right, rear_left) = (a3.in_tail_frame(), a4.in_tail_frame());
        let head: EndMargins = robot.end(End::Head).margins(a1, a2);
        let tail: EndMargins = robot.end(End::Tail).margins(rear_left, rear_right);
        let left = robot.side(Side::Left);
        let right = robot.side(Side::Right).mirrored();
        Self {
            type2: [head.type2, tail.type2],
            type1: [
                head.type1_left,
                head.type1_right,
                tail.type1_right,
                tail.type1_left,
            ],
            leg: [a1.sin, a2.sin, rear_right.sin, rear_left.sin].map(Sine),
            sliders_sq: [
                left.length_sq(a1, rear_left),
                right.length_sq(a2.mirrored(), rear_right.mirrored()),
            ],
        }
    }

    /// The smallest of the ten margins.
    pub fn smallest(&self) -> Sine {
        let mut least = Sine(i16::MAX);
        for margin in self.type2.iter().chain(&self.type1).chain(&self.leg) {
            least = least.min(*margin);
        }
        least
    }

    /// The first limit that this pose breaks: type-2 of head and tail, type-1 of A1
    /// to A4, legs of A1 to A4, strokes left and right.
    pub fn hazard<R: Robot>(&self, robot: &R) -> Option<Hazard> {
        let limits = robot.limits();
        for (end, value) in End::BOTH.into_iter().zip(self.type2) {
            if value < limits.type2 {
                let margin = Margin::Type2(end);
                return Some(Hazard::Margin { margin, value });
            }
        }
        for (servo, value) in Servo::ALL.into_iter().zip(self.type1) {
            if value < limits.type1 {
                let margin = Margin::Type1(servo);
                return Some(Hazard::Margin { margin, value });
            }
        }
        for (servo, value) in Servo::ALL.into_iter().zip(self.leg) {
            if value < limits.leg {
                let margin = Margin::Leg(servo);
                return Some(Hazard::Margin { margin, value });
            }
        }
        for (side, length_sq) in Side::BOTH.into_iter().zip(self.sliders_sq) {
            let slider = robot.side(side);
            if !slider.allows(length_sq) {
                let travel = slider.travel(length_sq);
                return Some(Hazard::Stroke { side, travel });
            }
        }
        None
    }
}
