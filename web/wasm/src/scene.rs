//! The points and margins of a pose, as the page draws them.

use lizard_kinematics::{Check, End, Pose, Side, Solution, Vector};
use lizard_robot::{LegPoints, Robot};
use lizard_twin::{Shape, Twin};
use serde::Serialize;
use tsify::Tsify;

use crate::singularity_map::{self, MapPoint};

/// A point, mm, chassis frame: x to the right, y forward.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Tsify)]
pub struct Point(
    /// Distance to the right, mm.
    pub f64,
    /// Distance forward, mm.
    pub f64,
);

impl From<Vector> for Point {
    fn from(point: Vector) -> Self {
        Self(point.x, point.y)
    }
}

/// A leg at a pose.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct LegScene {
    /// Pivots on the chassis: the driven crank's pivot, then the follower's.
    pub pivots: [Point; 2],
    /// Joints of the link that carries the foot.
    pub joints: [Point; 2],
    /// Position of the foot.
    pub foot: Point,
    /// Anchors of the strut: on the servo's link, and on the leg's crank.
    pub strut: [Point; 2],
    /// True if the strut has a spring; false if it is rigid.
    pub has_spring: bool,
}

/// A slider between two arms.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct SliderScene {
    /// Shafts of the front and the rear servo.
    pub shafts: [Point; 2],
    /// Tips of the front arm and the rear arm.
    pub tips: [Point; 2],
    /// Front end of the slider's rear half, into which the front half slides.
    pub tube: Point,
    /// Travel from the nominal length, mm.
    pub travel: f64,
}

/// A margin at a pose.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Margin {
    /// Name, such as `type2_head`.
    pub name: &'static str,
    /// Value, the sine of an angle.
    pub value: f64,
}

/// The robot at a pose.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Scene {
    /// Servo angles, deg, chassis frame, in servo order.
    pub angles: [f64; 4],
    /// Shafts in servo order.
    pub shafts: [Point; 4],
    /// Tips of the cranks in servo order.
    pub tips: [Point; 4],
    /// End points of head and tail.
    pub points: [Point; 2],
    /// The sliders, left and right.
    #[tsify(type = "[SliderScene, SliderScene]")]
    pub sliders: Vec<SliderScene>,
    /// The legs in servo order.
    #[tsify(type = "Four<LegScene>")]
    pub legs: Vec<LegScene>,
    /// All margins of the pose.
    pub margins: Vec<Margin>,
    /// The message about the limit that this pose violates; `None` if the pose is allowed.
    pub refusal: Option<String>,
    /// The pose's points on the maps of singularities of head and tail.
    pub map_points: [MapPoint; 2],
}

impl Scene {
    /// Computes the scene of a twin's current pose.
    ///
    /// # Errors
    /// Returns the message about the loop that does not close.
    pub fn compute(twin: &Twin) -> Result<Self, String> {
        let (robot, angles) = (twin.robot(), twin.angles());
        let pose = Pose::from(angles);
        let solution = robot.lizard().solve(&pose);
        let solution = solution.map_err(|fault| fault.to_string())?;
        let shape = Shape::from_solution(robot, &solution, twin.leg_sweeps());
        let has_spring = twin.ground().drive.kind != lizard_robot::DriveKind::Rigid;
        let refusal = robot.limits().violations(&solution).next();
        let compute_slider = |side| compute_slider_scene(robot, &shape, &solution, side);
        let to_leg = |leg: LegPoints| LegScene {
            pivots: leg.pivots.map(Point::from),
            joints: leg.joints.map(Point::from),
            foot: leg.foot.into(),
            strut: leg.strut_anchors.map(Point::from),
            has_spring,
        };
        let to_margin = |(check, value): (Check, f64)| Margin {
            name: check.name(),
            value,
        };
        Ok(Self {
            angles,
            shafts: shape.shafts.map(Point::from),
            tips: shape.crank_tips.map(Point::from),
            points: shape.ends.map(Point::from),
            sliders: Side::ALL.map(compute_slider).into(),
            legs: shape.legs.map(to_leg).into(),
            margins: solution.margins.iter().map(to_margin).collect(),
            refusal: refusal.map(|violation| violation.to_string()),
            map_points: End::ALL.map(|end| singularity_map::to_map_point(end, &pose)),
        })
    }
}

fn compute_slider_scene(
    robot: &Robot,
    shape: &Shape,
    solution: &Solution,
    side: Side,
) -> SliderScene {
    let servos = side.servos();
    let pose = solution.side(side);
    let links = robot.lizard().links;
    let rear_half = match side {
        Side::Left => links.l12,
        Side::Right => links.l17,
    };
    let tips = servos.map(|servo| shape.arm_tips[servo]);
    SliderScene {
        shafts: servos.map(|servo| shape.shafts[servo].into()),
        tips: tips.map(Point::from),
        tube: (tips[1] + pose.span * (rear_half / pose.d)).into(),
        travel: pose.s,
    }
}

#[cfg(test)]
mod tests {
    use lizard_twin::ServoModel;

    use super::*;
    use crate::paper::{PAPER_TOML, load_paper_robot};

    fn compute_scene(robot: &Robot, angles: [f64; 4]) -> Scene {
        let mut twin = Twin::new(robot, ServoModel::Ideal);
        twin.simulate_angles(angles);
        Scene::compute(&twin).expect("every loop closes")
    }

    #[test]
    fn the_neutral_pose_has_the_papers_head_point_and_no_refusal() {
        let robot = load_paper_robot();
        let scene = compute_scene(&robot, robot.neutral_pose().into());
        let head_y = scene.points[0].1;
        assert!((head_y - (67.5 + 57.840)).abs() < 1e-3, "{head_y}");
        let mut sliders = scene.sliders.iter();
        assert!(sliders.all(|slider| slider.travel.abs() < 1e-4));
        assert_eq!(scene.refusal, None);
        assert_eq!(scene.margins.len(), 10);
        assert!(scene.legs.iter().all(|leg| !leg.has_spring));
    }

    #[test]
    fn the_refusal_of_a_pose_near_a_singularity_names_its_margin() {
        let scene = compute_scene(&load_paper_robot(), [75.0, 105.0, 318.59, 221.41]);
        let refusal = scene.refusal.expect("the pose is refused");
        assert!(refusal.contains("type2_head"), "{refusal}");
    }

    #[test]
    fn the_message_names_the_loop_that_does_not_close() {
        // In the neutral pose, the couplers barely reach each other.
        let gaits_start = PAPER_TOML.find("[gait.walk]");
        let gaits_start = gaits_start.expect("paper.toml has this gait");
        let short_coupler_toml = PAPER_TOML[..gaits_start]
            .replace("l2 = 50.0", "l2 = 34.0")
            .replace("l3 = 50.0", "l3 = 34.0")
            .replace("type2 = 0.3", "type2 = 0.1");
        let robot = Robot::parse(&short_coupler_toml).expect("the neutral pose is allowed");
        let mut twin = Twin::new(&robot, ServoModel::Ideal);
        twin.simulate_angles([170.0, 10.0, 318.59, 221.41]);
        let fault = Scene::compute(&twin).expect_err("the couplers cannot meet");
        assert!(fault.contains("head"), "{fault}");
    }
}
