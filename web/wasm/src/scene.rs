//! All that the page shows of one pose.

use lizard_kinematics::{Check, End, Limits, Pose, Side, Solution, Vector};
use lizard_robot::Robot;
use serde::Serialize;

use crate::map::{self, MapPoint};

/// A point, mm, chassis frame: x to the right, y forward.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spot(
    /// To the right.
    pub f64,
    /// Forward.
    pub f64,
);

impl From<Vector> for Spot {
    fn from(point: Vector) -> Self {
        Self(point.x, point.y)
    }
}

/// A leg.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LegScene {
    /// Its pivots on the chassis.
    pub pivots: [Spot; 2],
    /// The joints of the link that carries the foot.
    pub joints: [Spot; 2],
    /// The foot.
    pub foot: Spot,
}

/// A slider between two arms.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SliderScene {
    /// Front and rear shaft.
    pub shafts: [Spot; 2],
    /// Tips of the front and the rear arm.
    pub tips: [Spot; 2],
    /// Where the rear half ends, that the front half slides in.
    pub tube: Spot,
    /// Travel from nominal, mm.
    pub travel: f64,
}

/// A margin and what it must not sink below.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Margin {
    /// Its name, such as `type2_head`.
    pub name: &'static str,
    /// A sine.
    pub value: f64,
}

/// A pose.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scene {
    /// Servo angles, deg, chassis frame, servo order.
    pub angles: [f64; 4],
    /// Shafts in servo order.
    pub shafts: [Spot; 4],
    /// Tips of the cranks in servo order.
    pub tips: [Spot; 4],
    /// Head and tail point.
    pub points: [Spot; 2],
    /// Left and right.
    pub sliders: Vec<SliderScene>,
    /// In servo order.
    pub legs: Vec<LegScene>,
    /// Every margin.
    pub margins: Vec<Margin>,
    /// Which of them is smallest.
    pub smallest: Margin,
    /// Why the guard would not send this pose, in a sentence.
    pub refusal: Option<String>,
    /// Where it is on the map of singularities of head and tail.
    pub map: [MapPoint; 2],
}

impl Scene {
    /// Of servo angles, and of the angles that the legs have, which springs may hold back:
    /// deg, chassis frame, servo order.
    ///
    /// # Errors
    /// The sentence of the loop that does not close.
    pub fn of(robot: &Robot, angles: [f64; 4], legs: [f64; 4]) -> Result<Self, String> {
        let pose = Pose::from(angles);
        let solution = robot
            .lizard()
            .solve(&pose)
            .map_err(|fault| fault.to_string())?;
        let named = |(check, value): (Check, f64)| Margin {
            name: check.name(),
            value,
        };
        Ok(Self {
            angles,
            shafts: robot.lizard().shafts().map(Spot::from),
            tips: solution.crank_tips().map(Spot::from),
            points: End::ALL.map(|end| solution.point(end).into()),
            sliders: Side::ALL.map(|side| slider(robot, &solution, side)).into(),
            legs: (0..4).map(|servo| leg(robot, servo, legs[servo])).collect(),
            margins: solution.margins.iter().map(named).collect(),
            smallest: named(solution.margins.min()),
            refusal: refusal(robot.limits(), &solution),
            map: End::ALL.map(|end| map::place(end, &pose)),
        })
    }
}

fn refusal(limits: &Limits, solution: &Solution) -> Option<String> {
    limits
        .violations(solution)
        .next()
        .map(|broken| broken.to_string())
}

fn leg(robot: &Robot, servo: usize, angle: f64) -> LegScene {
    let place = robot.leg(servo, angle);
    LegScene {
        pivots: place.pivots().map(Spot::from),
        joints: place.joints().map(Spot::from),
        foot: place.foot().into(),
    }
}

fn slider(robot: &Robot, solution: &Solution, side: Side) -> SliderScene {
    let [front, rear] = side.servos();
    let shafts = robot.lizard().shafts();
    let pose = solution.side(side);
    let links = robot.lizard().links;
    let half = match side {
        Side::Left => links.l12,
        Side::Right => links.l17,
    };
    let rear_tip = shafts[rear] + pose.rear_tip;
    SliderScene {
        shafts: [shafts[front].into(), shafts[rear].into()],
        tips: [(shafts[rear] + pose.front_tip).into(), rear_tip.into()],
        tube: (rear_tip + pose.span * (half / pose.d)).into(),
        travel: pose.s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper() -> Robot {
        Robot::parse(include_str!("../../../robots/paper.toml")).expect("right")
    }

    fn at(robot: &Robot, angles: [f64; 4]) -> Result<Scene, String> {
        Scene::of(robot, angles, angles)
    }

    #[test]
    fn the_neutral_pose_is_the_papers() {
        let robot = paper();
        let scene = at(&robot, robot.neutral().into()).expect("closes");
        assert!(
            (scene.points[0].1 - (67.5 + 57.840)).abs() < 1e-3,
            "{:?}",
            scene.points
        );
        assert!(
            scene
                .sliders
                .iter()
                .all(|slider| slider.travel.abs() < 1e-4)
        );
        assert_eq!(scene.refusal, None);
        assert_eq!(scene.margins.len(), 10);
    }

    #[test]
    fn a_pose_near_a_singularity_says_why_not() {
        let robot = paper();
        let scene = at(&robot, [75.0, 105.0, 318.59, 221.41]).expect("closes");
        let refusal = scene.refusal.expect("refused");
        assert!(refusal.contains("type2_head"), "{refusal}");
        let fault = at(&robot, [f64::NAN, 41.0, 318.0, 221.0]).expect_err("no pose");
        assert!(fault.contains("not a finite number"), "{fault}");
    }
}
