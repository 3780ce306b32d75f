//! The legs seen from above: their pivots, the coupler with the foot, and the strut through
//! which the servo drives the leg.
//!
//! The paper's figures do not show the legs' pivots. Only the circle of the foot matters for
//! walking. A parallelogram moves its coupler without turning it. So the two pivots may be
//! moved together to a place with room, if the foot is moved on the coupler by the same
//! distance in the opposite direction. The driven pivot lies outside the area that the
//! servo's link sweeps. The strut joins the servo's link to the leg; it is the coupler
//! of a second parallelogram: shaft, driven pivot and two equal anchor arms.
//!
//! A hip is the centre of a foot's circle. At neutral the foot is straight beside it,
//! turned by the leg's sweep angle `mount`.

use lizard_contact::{FRONT, Feet, LEFT, Point};
use lizard_kinematics::{Lizard, Vector};

use crate::measures::parts::Parts;
use crate::measures::servo::ARM_SIDE;

/// The dimensions of a leg that are the same in every pose, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegPlan {
    /// The servo's shaft, mm, chassis frame.
    pub shaft: Vector,
    /// The driven crank's pivot, mm, chassis frame.
    pub crank_pivot: Vector,
    /// The follower's pivot, mm, chassis frame.
    pub follower_pivot: Vector,
    /// Unit vector from the driven to the follower's pivot: the coupler's direction in every pose.
    pub coupler_direction: Vector,
    /// Angle from the servo's crank to the leg's crank while the leg does not lag, deg.
    pub crank_offset: f64,
    /// The crank's joint with the coupler, in the crank's frame, mm: x points as the
    /// servo's crank does while the leg does not lag.
    pub joint: Vector,
    /// The foot in the coupler's frame, mm: from the crank's joint along the coupler,
    /// and across it counter-clockwise.
    pub foot: Vector,
    /// Unit vector from the shaft to the driven pivot, the direction of the strut.
    pub strut: Vector,
    /// Length of the strut from anchor to anchor while the leg does not lag, mm.
    pub strut_length: f64,
    /// The strut's anchor, mm. It has the same coordinates in the frame of the servo's link and in the leg's.
    pub anchor: Vector,
}

/// The points of a leg at a pose, mm, chassis frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegPlace {
    /// The pivots on the chassis: the driven crank's and the follower's.
    pub pivots: [Vector; 2],
    /// The joints of both cranks with the coupler, which carries the foot.
    pub joints: [Vector; 2],
    /// The foot on its coupler.
    pub foot: Vector,
    /// The strut's anchors: on the servo's link, and on the leg's crank.
    pub strut: [Vector; 2],
}

impl LegPlan {
    /// Computes the leg of a servo (0 to 3) with this neutral angle (deg, chassis frame).
    pub(crate) fn new(
        servo: usize,
        neutral: f64,
        lizard: &Lizard,
        parts: &Parts,
        feet: &Feet,
    ) -> Self {
        let to_vector = |[forward, left]: Point| Vector::new(-left, forward);
        let hip = to_vector(feet.hips()[servo]);
        let reach = to_vector(feet.positions([0.0; 4])[servo]) - hip;
        let shaft = lizard.shafts()[servo];
        let driven_pivot = shaft + driven_pivot_offset(servo, parts);
        let crank_offset = reach.angle() - neutral;
        // The angle between ground link and crank equals the servo's angle. The follower's pivot
        // may be at either end of the ground link; the end that is farther from the servo is used.
        let ground_link = Vector::direction(crank_offset) * lizard.leg.ground;
        let [idle_pivot, other_pivot] = [driven_pivot + ground_link, driven_pivot - ground_link];
        let idle_pivot =
            match (idle_pivot - shaft).length_squared() > (other_pivot - shaft).length_squared() {
                true => idle_pivot,
                false => other_pivot,
            };
        let coupler_direction =
            (idle_pivot - driven_pivot) * (1.0 / (idle_pivot - driven_pivot).length());
        let foot_offset = hip - driven_pivot;
        let strut_vector = driven_pivot - shaft;
        let [radius, angle] = parts.anchor;
        Self {
            shaft,
            crank_pivot: driven_pivot,
            follower_pivot: idle_pivot,
            coupler_direction,
            crank_offset,
            joint: Vector::direction(crank_offset) * lizard.leg.crank,
            foot: Vector::new(
                foot_offset.dot(coupler_direction),
                coupler_direction.cross(foot_offset),
            ),
            strut: strut_vector * (1.0 / strut_vector.length()),
            strut_length: strut_vector.length(),
            anchor: Vector::direction(-ARM_SIDE[servo] * angle) * radius,
        }
    }

    /// Places the leg for the servo's angle and the angle that the leg follows, both
    /// in deg, chassis frame. The angles differ by the leg's lag.
    pub fn at(&self, servo_angle: f64, leg_angle: f64) -> LegPlace {
        let rotate = |angle: f64, vector: Vector| {
            let x = Vector::direction(angle);
            x * vector.x + x.rotated_left() * vector.y
        };
        let pivots = [self.crank_pivot, self.follower_pivot];
        let joints = pivots.map(|pivot| pivot + rotate(leg_angle, self.joint));
        LegPlace {
            pivots,
            joints,
            foot: joints[0]
                + self.coupler_direction * self.foot.x
                + self.coupler_direction.rotated_left() * self.foot.y,
            strut: [
                self.shaft + rotate(servo_angle, self.anchor),
                self.crank_pivot + rotate(leg_angle, self.anchor),
            ],
        }
    }
}

/// The vector from a servo's shaft to the driven pivot of its leg, mm, chassis frame.
fn driven_pivot_offset(servo: usize, parts: &Parts) -> Vector {
    outward(servo, parts.pivot)
}

/// Converts an offset from a servo, given as distances outward and towards the robot's middle, to the chassis frame.
pub(crate) fn outward(servo: usize, [outward, inward]: [f64; 2]) -> Vector {
    Vector::new(-LEFT[servo] * outward, -FRONT[servo] * inward)
}

#[cfg(test)]
mod tests {
    use lizard_kinematics::{Vector, wrap};

    use crate::measures::servo::FORWARD;
    use crate::testing::{all, robot};

    #[test]
    fn a_crank_has_its_length_and_its_servos_angle_to_the_ground_link() {
        for (name, robot) in all() {
            let bars = robot.lizard().leg;
            for (servo, settings) in robot.servos().iter().enumerate() {
                for angle in [
                    settings.neutral - 30.0,
                    settings.neutral,
                    settings.neutral + 12.5,
                ] {
                    let leg = robot.legs()[servo].at(angle, angle);
                    let [ground, coupler] =
                        [leg.pivots, leg.joints].map(|[driven, idle]| idle - driven);
                    let crank = leg.joints[0] - leg.pivots[0];
                    // A ground link may have either of two opposite directions.
                    let angle_error = wrap(2.0 * (crank.angle() - ground.angle() - angle));
                    assert!(angle_error.abs() < 1e-9, "{name} {servo} {angle_error}");
                    assert!((crank.length() - bars.crank).abs() < 1e-9, "{name} {servo}");
                    assert!((ground.length() - bars.ground).abs() < 1e-9);
                    assert!((coupler - ground).length() < 1e-9, "it is not turned");
                }
            }
        }
    }

    #[test]
    fn a_foot_is_where_the_contact_model_has_it() {
        for (name, robot) in all() {
            for sweep in [-25.0, 0.0, 17.0] {
                let feet = robot.ground().feet.positions([sweep; 4]);
                for (servo, leg) in robot.legs().iter().enumerate() {
                    let angle = robot.servos()[servo].neutral + FORWARD[servo] * sweep;
                    let [forward, left] = feet[servo];
                    let error = leg.at(angle, angle).foot - Vector::new(-left, forward);
                    assert!(error.length() < 1e-9, "{name} {servo} {error:?}");
                }
            }
        }
    }

    #[test]
    fn the_papers_legs_are_pivoted_beside_their_servos() {
        let is_near = |a: Vector, x: f64, y: f64| (a - Vector::new(x, y)).length() < 1e-9;
        let right = robot("paper").legs()[1];
        assert!(
            is_near(right.crank_pivot, 10.0 + 28.5, 67.5 - 10.0),
            "{right:?}"
        );
        // The ground link: 50 mm long, and turned by 41.41 deg from straight to the side toward the middle.
        let (across_mm, back_mm) = (37.5, 50.0 * 0.4375f64.sqrt());
        assert!(
            (right.follower_pivot - right.crank_pivot - Vector::new(across_mm, -back_mm)).length()
                < 1e-4
        );
        let left = robot("paper").legs()[0];
        assert!(
            is_near(left.crank_pivot, -right.crank_pivot.x, right.crank_pivot.y),
            "{left:?}"
        );
    }

    #[test]
    fn a_strut_keeps_its_length_while_its_leg_does_not_lag() {
        for (name, robot) in all() {
            for (servo, leg) in robot.legs().iter().enumerate() {
                let length_at = |angle: f64, lag: f64| {
                    let [from, to] = leg.at(angle, angle - lag).strut;
                    (to - from).length()
                };
                let neutral = robot.servos()[servo].neutral;
                for angle in [neutral - 30.0, neutral, neutral + 30.0] {
                    let error = length_at(angle, 0.0) - leg.strut_length;
                    assert!(error.abs() < 1e-9, "{name} {servo} {error}");
                }
                assert!((length_at(neutral, 5.0) - leg.strut_length).abs() > 0.5);
            }
        }
    }
}
