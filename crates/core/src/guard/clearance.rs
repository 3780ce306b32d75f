//! The singularity guard: measures the distance between a pose and every hazard.
//!
//! Every frame passes the guard before it is sent to the servos, whether it comes from a gait, a point-to-point move or
//! the command `pose`. The guard tests the pose itself, for any pose within the servos' travel, and does not
//! approximate the safe poses by a box. The head and the tail share this code, because the tail, in its own frame, has
//! the head's geometry.
//!
//! Every condition depends on one or two servos. Therefore `make prove` can compare the guard at every pose with
//! floating-point arithmetic, by testing every pair of angles.

use lizard_avr::flash;

use crate::guard::hazard::{Hazard, Margin};
use crate::guard::trig::Direction;
use crate::numbers::integer_math::isqrt;
use crate::numbers::part::{End, Servo, Side};
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;
use crate::numbers::units::Sine;

/// The number of margins of a pose.
const MARGIN_COUNT: usize = 10;

/// The index of the first type-1 margin.
const FIRST_TYPE1_INDEX: usize = 2;
/// The index of the first leg margin.
const FIRST_LEG_INDEX: usize = 6;

flash! {
    /// The margins in the order in which they are checked.
    const MARGIN_ORDER: [Margin; MARGIN_COUNT] = [
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

/// Returns the first limit that a pose violates, if any. Skips poses in certified cells, which were proved safe when
/// the section was made.
#[inline(never)]
pub fn find_hazard(robot: &Robot, pose: &Pose) -> Option<Hazard> {
    if robot.is_certified(pose) {
        return None;
    }
    Clearance::measure(robot, pose).first_hazard(robot)
}

/// The margins and slider lengths of a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clearance {
    /// The type-2 margins of head and tail, the type-1 margins of A1 to A4, and the leg margins of A1 to A4. A leg
    /// margin is sin theta_lg in the frame of the leg's five-bar. It is negative beyond a change point (0, 180 deg),
    /// where the parallelogram may have flipped to its crossed form.
    pub margins: [Sine; MARGIN_COUNT],
    /// The squared lengths of the left and the right slider, each in squared steps of the slider's scale.
    pub slider_lengths_sq: [u32; 2],
}

impl Clearance {
    /// Computes every margin and slider length of a pose.
    #[inline(never)]
    pub fn measure(robot: &Robot, pose: &Pose) -> Self {
        let mut cranks = [Direction { sin: 0, cos: 0 }; 4];
        let mut clearance = Self {
            margins: [Sine(0); MARGIN_COUNT],
            slider_lengths_sq: [0; 2],
        };
        #[expect(
            clippy::needless_range_loop,
            reason = "an iterator costs 36 bytes of flash here"
        )]
        for index in 0..cranks.len() {
            let servo = Servo::at(index);
            let mut crank =
                Direction::from_angle(robot.servo_neutral_angle(servo).offset_by(pose.0[index]));
            // In the tail's own frame, see `Direction::in_tail_frame`.
            if servo.is_at_tail() {
                crank.sin = -crank.sin;
            }
            cranks[index] = crank;
            clearance.margins[FIRST_LEG_INDEX + index] = Sine(crank.sin);
        }
        for end in End::ALL {
            clearance.measure_end(robot, end, &cranks);
        }
        for side in Side::ALL {
            clearance.slider_lengths_sq[side as usize] = slider_length_sq(robot, side, &cranks);
        }
        clearance
    }

    /// Computes the margins of an end's five-bar.
    // Not inlined, like `slider_length_sq`. Otherwise the compiler unrolls the loop over both ends, which costs flash.
    #[inline(never)]
    fn measure_end(&mut self, robot: &Robot, end: End, cranks: &[Direction; 4]) {
        let [left, right] = end.servos();
        let margins = robot
            .five_bar(end)
            .margins(left.pick(cranks), right.pick(cranks));
        self.margins[end as usize] = margins.type2;
        self.margins[FIRST_TYPE1_INDEX + left.index()] = margins.type1_left;
        self.margins[FIRST_TYPE1_INDEX + right.index()] = margins.type1_right;
    }

    /// Returns the smallest of the ten margins.
    pub fn min_margin(&self) -> Sine {
        let mut min_margin = Sine(i16::MAX);
        for margin in &self.margins {
            min_margin = min_margin.min(*margin);
        }
        min_margin
    }

    /// Returns the first limit that this pose violates, if any. Checks the margins, then the left and the right stroke.
    #[inline(never)]
    pub fn first_hazard(&self, robot: &Robot) -> Option<Hazard> {
        let limits = robot.limits();
        for (index, value) in self.margins.iter().enumerate() {
            let limit = match index {
                ..FIRST_TYPE1_INDEX => limits.type2,
                FIRST_TYPE1_INDEX..FIRST_LEG_INDEX => limits.type1,
                _ => limits.leg,
            };
            if *value < limit {
                return Some(Hazard::Margin {
                    margin: MARGIN_ORDER.at(index).load(),
                    value: *value,
                });
            }
        }
        for side in Side::ALL {
            let length_sq = self.slider_lengths_sq[side as usize];
            if !robot.slider(side).allows(length_sq) {
                let length = isqrt(length_sq);
                return Some(Hazard::Stroke { side, length });
            }
        }
        None
    }
}

/// Computes the squared length of a side's slider, in squared steps of the slider's scale.
#[inline(never)]
fn slider_length_sq(robot: &Robot, side: Side, cranks: &[Direction; 4]) -> u32 {
    let [mut front, mut rear] = side.servos().map(|servo| *servo.pick(cranks));
    let mut slider = robot.slider(side);
    if matches!(side, Side::Right) {
        slider = slider.mirrored();
        front = front.mirrored();
        rear = rear.mirrored();
    }
    slider.length_sq(&front, &rear)
}

#[cfg(test)]
mod tests;
