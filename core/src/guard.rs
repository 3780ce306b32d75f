//! The singularity guard: how clear of every hazard a pose is.
//!
//! No frame reaches a servo before it has passed here, be it from a gait, a
//! point-to-point move or a pose that somebody typed. The decision is a point
//! test for any pose within the servos' travel, not a box, and holds for head and
//! tail alike: in its own frame the tail is built as the head.
//!
//! Every condition depends on one servo or on two, so all poses can be checked
//! against floating point by walking every pair of angles: `make prove`.

use lizard_avr::flash;

use crate::five_bar::EndMargins;
use crate::hazard::{Hazard, Margin};
use crate::part::{End, Servo, Side};
use crate::pose::Pose;
use crate::robot::Robot;
use crate::root::root;
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

/// The ten margins in the order in which they are checked.
const MARGINS: usize = 10;

flash! {
    const ORDER: [Margin; MARGINS] = [
        Margin::Type2(End::Head),
        Margin::Type2(End::Tail),
        Margin::Type1(Servo::A1),
        Margin::Type1(Servo::A2),
        Margin::Type1(Servo::A3),
        Margin::Type1(Servo::A4),
        Margin::Leg(Servo::A1),
        Margin::Leg(Servo::A2),
        Margin::Leg(Servo::A3),
        Margin::Leg(Servo::A4),
    ];
}

/// Every margin of one pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clearance {
    /// Type-2 of head and tail; type-1 of A1 to A4; legs of A1 to A4: sin theta_lg in
    /// the frame of its end, which is negative beyond a change point (0, 180 deg),
    /// where the parallelogram may have come out crossed.
    pub margins: [Sine; MARGINS],
    /// The sliders' squared lengths, left and right, in their steps.
    pub sliders_sq: [u32; 2],
}

impl Clearance {
    /// Measures a pose.
    pub fn of<R: Robot>(robot: &R, pose: &Pose) -> Self {
        let [a1, a2, a3, a4] = pose.angles(&robot.neutral()).map(Direction::of);
        let (rear_right, rear_left) = (a3.in_tail_frame(), a4.in_tail_frame());
        let cranks = [[a1, a2], [rear_left, rear_right]];
        let mut ends = [EndMargins::default(); 2];
        for (margins, (end, [left, right])) in
            ends.iter_mut().zip(End::ALL.into_iter().zip(cranks))
        {
            *margins = robot.end(end).margins(left, right);
        }
        let [head, tail] = ends;
        let left = robot.side(Side::Left);
        let right = robot.side(Side::Right).mirrored();
        Self {
            margins: [
                head.type2,
                tail.type2,
                head.type1_left,
                head.type1_right,
                tail.type1_right,
                tail.type1_left,
                Sine(a1.sin),
                Sine(a2.sin),
                Sine(rear_right.sin),
                Sine(rear_left.sin),
            ],
            sliders_sq: [
                left.length_sq(a1, rear_left),
                right.length_sq(a2.mirrored(), rear_right.mirrored()),
            ],
        }
    }

    /// The smallest of the ten margins.
    pub fn smallest(&self) -> Sine {
        let mut least = Sine(i16::MAX);
        for margin in &self.margins {
            least = least.min(*margin);
        }
        least
    }

    /// The first limit that this pose breaks: margins, then strokes left and right.
    pub fn hazard<R: Robot>(&self, robot: &R) -> Option<Hazard> {
        let limits = robot.limits();
        for (place, value) in self.margins.iter().enumerate() {
            let least = match place {
                0..2 => limits.type2,
                2..6 => limits.type1,
                _ => limits.leg,
            };
            if *value < least {
                return Some(Hazard::Margin {
                    margin: ORDER.at(place).load(),
                    value: *value,
                });
            }
        }
        for (side, length_sq) in Side::ALL.into_iter().zip(self.sliders_sq) {
            let slider = robot.side(side);
            if !slider.allows(length_sq) {
                let length = root(length_sq);
                return Some(Hazard::Stroke { side, length });
            }
        }
        None
    }
}
