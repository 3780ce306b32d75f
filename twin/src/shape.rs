//! Where every joint is: what a picture of the robot needs.

use lizard_kinematics::{End, Side, Solution, Vector};
use lizard_robot::Robot;
use lizard_robot::servo::FORWARD;

/// The joints of a robot, mm, chassis frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// The servos' shafts.
    pub shafts: [Vector; 4],
    /// Tips of the cranks that carry head and tail.
    pub tips: [Vector; 4],
    /// Tips of the arms that carry the sliders.
    pub arms: [Vector; 4],
    /// The head and the tail.
    pub ends: [Vector; 2],
    /// The legs.
    pub legs: [LegShape; 4],
}

/// A leg: a parallelogram beside its hip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegShape {
    /// The two pivots on the chassis, the middle between which is the hip.
    pub pivots: [Vector; 2],
    /// The two joints of the coupler that carries the foot.
    pub joints: [Vector; 2],
    /// The foot.
    pub foot: Vector,
    /// Where the spring is hooked: in the middle of the servo's crank and of the leg's.
    pub spring: [Vector; 2],
}

impl Shape {
    /// The joints at servo angles (deg, chassis frame), with legs at these sweeps from
    /// neutral (deg, foot forward positive), all in servo order; none where a loop does
    /// not close.
    #[must_use]
    pub fn of(robot: &Robot, angles: [f64; 4], legs: [f64; 4]) -> Option<Self> {
        let solved = robot.lizard().solve(&angles.into()).ok()?;
        Some(Self::of_solved(robot, &solved, legs))
    }

    /// The same of a pose that is solved.
    #[must_use]
    pub fn of_solved(robot: &Robot, solved: &Solution, legs: [f64; 4]) -> Self {
        let shafts = robot.lizard().shafts();
        let tips = solved.crank_tips();
        let mut arms = shafts;
        for side in Side::ALL {
            let [front, rear] = side.servos();
            let slider = solved.side(side);
            arms[front] = shafts[rear] + slider.front_tip;
            arms[rear] = shafts[rear] + slider.rear_tip;
        }
        Self {
            shafts,
            tips,
            arms,
            ends: End::ALL.map(|end| solved.point(end)),
            legs: std::array::from_fn(|i| {
                let middle = (shafts[i] + tips[i]) * 0.5;
                LegShape::of(robot, i, legs[i], middle)
            }),
        }
    }
}

impl LegShape {
    /// A servo's leg at a sweep from neutral (deg, foot forward positive), its spring
    /// hooked to this point of the crank.
    #[must_use]
    pub fn of(robot: &Robot, servo: usize, sweep: f64, hook: Vector) -> Self {
        let angle = robot.servos()[servo].neutral + FORWARD[servo] * sweep;
        let place = robot.leg(servo, angle);
        let pivots = place.pivots();
        // The leg's own link is the one nearer to the servo.
        let away = pivots.map(|pivot| (pivot - hook).length());
        let driven = pivots[usize::from(away[1] < away[0])];
        Self {
            pivots,
            joints: place.joints(),
            foot: place.foot(),
            spring: [hook, driven + place.reach * 0.5],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper() -> Robot {
        Robot::parse(include_str!("../../robots/paper.toml")).expect("paper.toml is right")
    }

    fn shape(robot: &Robot, legs: [f64; 4]) -> Shape {
        Shape::of(robot, robot.neutral().into(), legs).expect("neutral closes")
    }

    #[test]
    fn every_link_has_its_length() {
        let robot = paper();
        let shape = shape(&robot, [20.0, -10.0, 5.0, 0.0]);
        let length = |a: Vector, b: Vector| (a - b).length();
        for (i, leg) in shape.legs.iter().enumerate() {
            assert!((length(shape.shafts[i], shape.tips[i]) - 30.0).abs() < 1e-9);
            assert!((length(shape.shafts[i], shape.arms[i]) - 30.0).abs() < 1e-9);
            assert!((length(shape.tips[i], shape.ends[i / 2]) - 50.0).abs() < 1e-9);
            assert!((length(leg.pivots[0], leg.pivots[1]) - 50.0).abs() < 1e-9);
            assert!((length(leg.joints[0], leg.joints[1]) - 50.0).abs() < 1e-9);
            assert!((length(leg.pivots[0], leg.joints[0]) - 45.0).abs() < 1e-9);
            assert!((length(leg.pivots[1], leg.joints[1]) - 45.0).abs() < 1e-9);
        }
    }

    #[test]
    fn at_neutral_each_foot_is_straight_beside_its_hip() {
        let robot = paper();
        let feet = shape(&robot, [0.0; 4]).legs.map(|leg| leg.foot);
        for (foot, (x, y)) in
            feet.into_iter()
                .zip([(-80.0, 55.0), (80.0, 55.0), (80.0, -55.0), (-80.0, -55.0)])
        {
            assert!((foot - Vector::new(x, y)).length() < 1e-9, "{foot:?}");
        }
        for (before, after) in feet.into_iter().zip(shape(&robot, [10.0; 4]).legs) {
            assert!(after.foot.y > before.y + 7.0, "forward");
        }
    }
}
