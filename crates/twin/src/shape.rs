//! The positions of all joints, for drawings of the robot.

use lizard_contact::FORWARD_TURN_SIGN;
use lizard_kinematics::{End, Side, Solution, Vector};
use lizard_robot::{LegPoints, Robot};

/// The positions of a robot's joints, mm, in the chassis frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Shafts of the servos.
    pub shafts: [Vector; 4],
    /// Crank tips of the head and tail five-bars.
    pub crank_tips: [Vector; 4],
    /// Tips of the arms that carry the sliders.
    pub arm_tips: [Vector; 4],
    /// End points of head and tail: the joints between their two couplers.
    pub ends: [Vector; 2],
    /// The legs, which may lag behind their servos.
    pub legs: [LegPoints; 4],
}

impl Shape {
    /// Computes the joints from servo angles (deg, chassis frame) and the legs' sweeps from neutral (deg, foot forward
    /// positive), all in servo order; returns `None` if the loop of a five-bar or slider does not close.
    pub fn from_angles(robot: &Robot, angles: [f64; 4], leg_sweeps: [f64; 4]) -> Option<Self> {
        let solution = robot.lizard().solve(&angles.into()).ok()?;
        Some(Self::from_solution(robot, &solution, leg_sweeps))
    }

    /// Computes the joints from a solved pose and the legs' sweeps from neutral (deg, foot forward positive).
    pub fn from_solution(robot: &Robot, solution: &Solution, leg_sweeps: [f64; 4]) -> Self {
        let shafts = robot.lizard().shafts();
        let angles: [f64; 4] = solution.pose.into();
        let mut arm_tips = shafts;
        for side in Side::ALL {
            let [front, rear] = side.servos();
            let slider = solution.side(side);
            arm_tips[front] = shafts[rear] + slider.front_tip;
            arm_tips[rear] = shafts[rear] + slider.rear_tip;
        }
        Self {
            shafts,
            crank_tips: solution.crank_tips(),
            arm_tips,
            ends: End::ALL.map(|end| solution.point(end)),
            legs: std::array::from_fn(|i| {
                let leg_angle = robot.servos()[i].neutral + FORWARD_TURN_SIGN[i] * leg_sweeps[i];
                robot.legs()[i].points_at(angles[i], leg_angle)
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper_robot() -> Robot {
        Robot::parse(include_str!("../../../robots/paper.toml")).expect("paper.toml is valid")
    }

    fn neutral_shape(robot: &Robot, leg_sweeps: [f64; 4]) -> Shape {
        Shape::from_angles(robot, robot.neutral_pose().into(), leg_sweeps)
            .expect("every loop closes at neutral")
    }

    #[test]
    fn every_link_has_its_length() {
        let robot = paper_robot();
        let shape = neutral_shape(&robot, [20.0, -10.0, 5.0, 0.0]);
        let distance = |a: Vector, b: Vector| (a - b).length();
        for (i, leg) in shape.legs.iter().enumerate() {
            assert!((distance(shape.shafts[i], shape.crank_tips[i]) - 30.0).abs() < 1e-9);
            assert!((distance(shape.shafts[i], shape.arm_tips[i]) - 30.0).abs() < 1e-9);
            assert!((distance(shape.crank_tips[i], shape.ends[i / 2]) - 50.0).abs() < 1e-9);
            assert!((distance(leg.pivots[0], leg.pivots[1]) - 50.0).abs() < 1e-9);
            assert!((distance(leg.joints[0], leg.joints[1]) - 50.0).abs() < 1e-9);
            assert!((distance(leg.pivots[0], leg.joints[0]) - 45.0).abs() < 1e-9);
            assert!((distance(leg.pivots[1], leg.joints[1]) - 45.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_leg_that_lags_behind_its_servo_stretches_its_strut() {
        let robot = paper_robot();
        let strut_length = |leg: LegPoints| (leg.strut_anchors[1] - leg.strut_anchors[0]).length();
        let [rigid_shape, lagging_shape] =
            [[0.0; 4], [6.0; 4]].map(|leg_sweeps| neutral_shape(&robot, leg_sweeps));
        for i in 0..4 {
            let (rigid_leg, lagging_leg) = (rigid_shape.legs[i], lagging_shape.legs[i]);
            assert_eq!(rigid_leg.pivots, lagging_leg.pivots);
            assert_eq!(
                rigid_leg.strut_anchors[0], lagging_leg.strut_anchors[0],
                "the servo does not move"
            );
            assert!((strut_length(rigid_leg) - robot.legs()[i].strut_length).abs() < 1e-9);
            assert!(
                (strut_length(lagging_leg) - strut_length(rigid_leg)).abs() > 1.5,
                "{lagging_leg:?}"
            );
            assert!(lagging_leg.foot.y > rigid_leg.foot.y + 4.0);
        }
    }

    #[test]
    fn each_foot_is_directly_beside_its_hip_at_neutral() {
        let robot = paper_robot();
        let feet = neutral_shape(&robot, [0.0; 4]).legs.map(|leg| leg.foot);
        let points = [(-80.0, 55.0), (80.0, 55.0), (80.0, -55.0), (-80.0, -55.0)];
        for (foot, (x, y)) in feet.into_iter().zip(points) {
            assert!((foot - Vector::new(x, y)).length() < 1e-9, "{foot:?}");
        }
        for (foot, leg) in feet.into_iter().zip(neutral_shape(&robot, [10.0; 4]).legs) {
            assert!(
                leg.foot.y > foot.y + 7.0,
                "a positive sweep moves the foot forward"
            );
        }
    }
}
