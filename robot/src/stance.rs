//! Where the legs are, seen from above: each is a parallelogram whose crank turns with
//! its servo.
//!
//! The paper gives no mounting. Taken is what the contact model takes: at neutral the
//! foot is straight beside the hip, swept by `mount`.

use lizard_kinematics::{Vector, wrap};

use crate::friction::Point;
use crate::robot::Robot;
use crate::servo::FORWARD;

/// A leg at a servo angle; points in mm, chassis frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegPlace {
    /// The middle of its ground link.
    pub hip: Vector,
    /// From the hip to the front pivot on the chassis; the other is opposite.
    pub half: Vector,
    /// Along its crank.
    pub reach: Vector,
}

impl LegPlace {
    /// The two pivots on the chassis.
    pub fn pivots(&self) -> [Vector; 2] {
        [self.hip - self.half, self.hip + self.half]
    }

    /// The two joints of the link that carries the foot.
    pub fn joints(&self) -> [Vector; 2] {
        self.pivots().map(|pivot| pivot + self.reach)
    }

    /// The foot.
    pub fn foot(&self) -> Vector {
        self.hip + self.reach
    }
}

impl Robot {
    /// The leg of a servo (0 to 3) when that is at an angle in deg, chassis frame.
    pub fn leg(&self, servo: usize, angle: f64) -> LegPlace {
        let feet = &self.ground().feet;
        let point = |[forward, left]: Point| Vector::new(-left, forward);
        let hip = point(feet.hips()[servo]);
        let reach = |sweep: f64| point(feet.at([sweep; 4])[servo]) - hip;
        let neutral = self.servos()[servo].neutral;
        // The ground link stands where it makes the servo's angle with the crank.
        let link = Vector::direction(wrap(reach(0.0).angle() - neutral));
        LegPlace {
            hip,
            half: link * (self.lizard().leg.ground / 2.0),
            reach: reach(FORWARD[servo] * (angle - neutral)),
        }
    }
}

#[cfg(test)]
mod tests {
    use lizard_kinematics::wrap;

    use crate::testing::all;

    #[test]
    fn a_crank_is_as_long_as_it_is_and_at_its_servos_angle_to_the_ground_link() {
        for (name, robot) in all() {
            for (servo, of) in robot.servos().iter().enumerate() {
                for angle in [of.neutral - 30.0, of.neutral, of.neutral + 12.5] {
                    let leg = robot.leg(servo, angle);
                    let between = wrap(leg.reach.angle() - leg.half.angle() - angle);
                    let off = wrap(between + 180.0) - 180.0;
                    assert!(off.abs() < 1e-9, "{name} {servo} {off}");
                    let long = leg.reach.length() - robot.lizard().leg.crank;
                    assert!(long.abs() < 1e-9, "{name} {servo}");
                    let wide = (leg.pivots()[1] - leg.pivots()[0]).length();
                    assert!((wide - robot.lizard().leg.ground).abs() < 1e-9);
                }
            }
        }
    }
}
