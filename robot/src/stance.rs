//! Where the legs are, seen from above: each is a parallelogram whose crank turns with
//! its servo.
//!
//! The paper gives no mounting. Taken is what the contact model takes: at neutral the
//! foot is straight beside the hip, swept by `mount`.

use lizard_kinematics::{Vector, wrap};

use crate::robot::Robot;

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
        let left = matches!(servo, 0 | 3);
        let front = servo < 2;
        let side = |positive: bool, value: f64| if positive { value } else { -value };
        // Outward sweep turns a left front leg clockwise, and so on.
        let mount = side(left != front, feet.mount);
        let straight = if left { 180.0 } else { 0.0 };
        let turned = straight + mount - self.servos()[servo].neutral;
        let leg = self.lizard().leg;
        LegPlace {
            hip: Vector::new(side(!left, feet.hip_side), side(front, feet.hip_forward)),
            half: Vector::direction(wrap(turned)) * (leg.ground / 2.0),
            reach: Vector::direction(wrap(turned + angle)) * leg.crank,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::servo::FORWARD;
    use crate::testing::all;

    #[test]
    fn a_foot_is_where_the_contact_model_has_it() {
        for (name, robot) in all() {
            let feet = robot.ground().feet;
            for sweep in [-30.0, 0.0, 12.5] {
                let model = feet.at([sweep; 4]);
                for servo in 0..4 {
                    let angle = robot.servos()[servo].neutral + FORWARD[servo] * sweep;
                    let foot = robot.leg(servo, angle).foot();
                    let [forward, left] = model[servo];
                    let off = (foot.y - forward).hypot(foot.x + left);
                    assert!(off < 1e-9, "{name} {servo} {foot:?} {model:?}");
                }
            }
        }
    }
}
