//! The legs seen from above: their pivots, the coupler with the foot, and the strut through which the servo drives the
//! leg.
//!
//! The paper's figures do not show the legs' pivots. Only the foot's circle matters for walking, and a parallelogram
//! moves its coupler without turning it. Both pivots may therefore be shifted together to a position with enough room,
//! if the foot is shifted on the coupler by the same distance in the opposite direction. The driven crank's pivot lies
//! outside the area that the servo's link sweeps. The strut joins the servo's link to the leg. It is the coupler of a
//! second parallelogram, whose ground link goes from the servo's shaft to the crank's pivot, and whose cranks are two
//! equal arms that carry the strut's anchors.
//!
//! A hip is the centre of a foot's circle. In the neutral pose the foot is exactly to the side of its hip if the mount
//! angle is zero; otherwise the leg is swept by this angle.

use lizard_contact::{FRONT_SIGN, LEFT_SIGN, LegGeometry, Point};
use lizard_kinematics::{Lizard, Vector};

use crate::config::parts::Parts;
use crate::config::servo::ARM_TURN_SIGN;

/// The dimensions of a leg that are the same in every pose, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegPlan {
    /// The servo's shaft, mm, chassis frame.
    pub shaft: Vector,
    /// The driven crank's pivot, mm, chassis frame.
    pub crank_pivot: Vector,
    /// The follower's pivot, mm, chassis frame.
    pub follower_pivot: Vector,
    /// Unit vector from the crank's pivot to the follower's: the coupler's direction in every pose.
    pub coupler_direction: Vector,
    /// Angle from the servo's crank to the leg's crank while the leg does not lag, deg.
    pub crank_offset: f64,
    /// The crank's joint with the coupler, in the crank's frame, mm: x is parallel to the servo's crank while the leg
    /// does not lag.
    pub crank_joint: Vector,
    /// The foot in the coupler's frame, mm: x along the coupler from the crank's joint, y a quarter turn
    /// counter-clockwise from x.
    pub foot: Vector,
    /// Unit vector from the shaft to the crank's pivot: the direction of the strut.
    pub strut_direction: Vector,
    /// Length of the strut from anchor to anchor while the leg does not lag, mm.
    pub strut_length: f64,
    /// The strut's anchor, mm. It has the same coordinates in the frame of the servo's link and in the leg's frame.
    pub anchor: Vector,
}

/// The points of a leg at a pose, mm, chassis frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegPoints {
    /// The pivots on the chassis: the driven crank's and the follower's.
    pub pivots: [Vector; 2],
    /// The joints of both cranks with the coupler, which carries the foot.
    pub joints: [Vector; 2],
    /// The foot on its coupler.
    pub foot: Vector,
    /// The strut's anchors: on the servo's link, and on the leg's crank.
    pub strut_anchors: [Vector; 2],
}

impl LegPlan {
    /// Computes the leg of a servo (0 to 3) that has this neutral angle (deg, chassis frame).
    pub(crate) fn new(
        servo: usize,
        neutral: f64,
        lizard: &Lizard,
        parts: &Parts,
        geometry: &LegGeometry,
    ) -> Self {
        let to_vector = |[forward, left]: Point| Vector::new(-left, forward);
        let hip = to_vector(geometry.hips()[servo]);
        let hip_to_foot = to_vector(geometry.foot_positions([0.0; 4])[servo]) - hip;
        let shaft = lizard.shafts()[servo];
        let crank_pivot = shaft + chassis_offset(servo, parts.pivot);
        let crank_offset = hip_to_foot.angle() - neutral;
        // The angle between ground link and crank equals the servo's angle. The ground link may extend from the
        // crank's pivot in either direction; the follower's pivot is at the end that is farther from the servo.
        let ground_link = Vector::from_angle(crank_offset) * lizard.leg.ground;
        let [first_candidate, second_candidate] =
            [crank_pivot + ground_link, crank_pivot - ground_link];
        let follower_pivot = match (first_candidate - shaft).length_squared()
            > (second_candidate - shaft).length_squared()
        {
            true => first_candidate,
            false => second_candidate,
        };
        let coupler_direction =
            (follower_pivot - crank_pivot) * (1.0 / (follower_pivot - crank_pivot).length());
        let foot_offset = hip - crank_pivot;
        let strut_vector = crank_pivot - shaft;
        let [radius, angle] = parts.anchor;
        Self {
            shaft,
            crank_pivot,
            follower_pivot,
            coupler_direction,
            crank_offset,
            crank_joint: Vector::from_angle(crank_offset) * lizard.leg.crank,
            foot: Vector::new(
                foot_offset.dot(coupler_direction),
                coupler_direction.cross(foot_offset),
            ),
            strut_direction: strut_vector * (1.0 / strut_vector.length()),
            strut_length: strut_vector.length(),
            anchor: Vector::from_angle(-ARM_TURN_SIGN[servo] * angle) * radius,
        }
    }

    /// Computes the points of the leg from the angles of the servo and of the leg, both in deg, chassis frame. The
    /// angles differ by the leg's lag.
    pub fn points_at(&self, servo_angle: f64, leg_angle: f64) -> LegPoints {
        let rotate = |angle: f64, vector: Vector| {
            let x = Vector::from_angle(angle);
            x * vector.x + x.rotated_left() * vector.y
        };
        let pivots = [self.crank_pivot, self.follower_pivot];
        let joints = pivots.map(|pivot| pivot + rotate(leg_angle, self.crank_joint));
        LegPoints {
            pivots,
            joints,
            foot: joints[0]
                + self.coupler_direction * self.foot.x
                + self.coupler_direction.rotated_left() * self.foot.y,
            strut_anchors: [
                self.shaft + rotate(servo_angle, self.anchor),
                self.crank_pivot + rotate(leg_angle, self.anchor),
            ],
        }
    }
}

/// Converts an offset from a servo, given as the distances outward and towards the robot's middle, to the chassis
/// frame.
pub(crate) fn chassis_offset(servo: usize, [outward, inward]: [f64; 2]) -> Vector {
    Vector::new(-LEFT_SIGN[servo] * outward, -FRONT_SIGN[servo] * inward)
}

#[cfg(test)]
mod tests {
    use lizard_kinematics::{Vector, wrap};

    use crate::config::servo::FORWARD_TURN_SIGN;
    use crate::testing::{all_robots, robot};

    #[test]
    fn a_crank_has_its_length_and_its_servos_angle_to_the_ground_link() {
        for (name, robot) in all_robots() {
            let leg_links = robot.lizard().leg;
            for (servo, settings) in robot.servos().iter().enumerate() {
                for sweep in [-30.0, 0.0, 12.5] {
                    let angle = settings.neutral + sweep;
                    let leg = robot.legs()[servo].points_at(angle, angle);
                    let [ground, coupler] = [leg.pivots, leg.joints]
                        .map(|[crank_point, follower_point]| follower_point - crank_point);
                    let crank = leg.joints[0] - leg.pivots[0];
                    // A ground link may have either of two opposite directions.
                    let angle_error = wrap(2.0 * (crank.angle() - ground.angle() - angle));
                    assert!(
                        angle_error.abs() < 1e-9,
                        "{name}, servo {servo}: the angle error is {angle_error} deg"
                    );
                    let length_error = crank.length() - leg_links.crank;
                    assert!(length_error.abs() < 1e-9, "{name}, servo {servo}");
                    assert!((ground.length() - leg_links.ground).abs() < 1e-9);
                    assert!((coupler - ground).length() < 1e-9, "the coupler is turned");
                }
            }
        }
    }

    #[test]
    fn feet_have_the_same_positions_as_in_the_contact_model() {
        for (name, robot) in all_robots() {
            for sweep in [-25.0, 0.0, 17.0] {
                let feet = robot.ground().legs.foot_positions([sweep; 4]);
                for (servo, leg) in robot.legs().iter().enumerate() {
                    let angle = robot.servos()[servo].neutral + FORWARD_TURN_SIGN[servo] * sweep;
                    let [forward, left] = feet[servo];
                    let error = leg.points_at(angle, angle).foot - Vector::new(-left, forward);
                    let is_small = error.length() < 1e-9;
                    assert!(is_small, "{name}, servo {servo}: {error:?} mm");
                }
            }
        }
    }

    #[test]
    fn the_papers_legs_are_pivoted_beside_their_servos() {
        let error = |a: Vector, x: f64, y: f64| (a - Vector::new(x, y)).length();
        let [left, right, ..] = *robot("paper").legs();
        let pivot = right.crank_pivot;
        assert!(error(pivot, 10.0 + 28.5, 67.5 - 10.0) < 1e-9, "{right:?}");
        // The ground link is 50 mm long, and turned by 41.41 deg from straight sideways towards the middle.
        let (across_mm, back_mm) = (37.5, 50.0 * 0.4375f64.sqrt());
        assert!(error(right.follower_pivot - pivot, across_mm, -back_mm) < 1e-4);
        assert!(
            error(left.crank_pivot, -pivot.x, pivot.y) < 1e-9,
            "{left:?}"
        );
    }

    #[test]
    fn a_strut_keeps_its_length_while_the_leg_does_not_lag() {
        for (name, robot) in all_robots() {
            for (servo, leg) in robot.legs().iter().enumerate() {
                let length_at = |angle: f64, lag: f64| {
                    let [servo_anchor, leg_anchor] =
                        leg.points_at(angle, angle - lag).strut_anchors;
                    (leg_anchor - servo_anchor).length()
                };
                let neutral = robot.servos()[servo].neutral;
                for angle in [neutral - 30.0, neutral, neutral + 30.0] {
                    let error = length_at(angle, 0.0) - leg.strut_length;
                    assert!(error.abs() < 1e-9, "{name}, servo {servo}: {error} mm");
                }
                assert!((length_at(neutral, 5.0) - leg.strut_length).abs() > 0.5);
            }
        }
    }
}
