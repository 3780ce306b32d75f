//! The points and margins of one pose, as the page draws them.

use lizard_kinematics::{Check, End, Pose, Side, Solution, Vector};
use lizard_robot::{LegPlace, Robot};
use lizard_twin::{Shape, Twin};
use serde::Serialize;
use tsify::Tsify;

use crate::map::{self, MapPoint};

/// A point, mm, chassis frame: x to the right, y forward.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Tsify)]
pub struct Spot(
    /// Distance to the right, mm.
    pub f64,
    /// Distance forward, mm.
    pub f64,
);

impl From<Vector> for Spot {
    fn from(point: Vector) -> Self {
        Self(point.x, point.y)
    }
}

/// A leg at a pose.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct LegScene {
    /// Pivots on the chassis, the driven crank's first.
    pub pivots: [Spot; 2],
    /// Joints of the link that carries the foot.
    pub joints: [Spot; 2],
    /// Place of the foot.
    pub foot: Spot,
    /// Anchors of the strut: on the servo's crank and on the leg's crank.
    pub strut: [Spot; 2],
    /// True if the strut has a spring; false if it is rigid.
    pub sprung: bool,
}

/// A slider between two arms.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct SliderScene {
    /// Shafts of the front and the rear servo.
    pub shafts: [Spot; 2],
    /// Tips of the front and the rear arm.
    pub tips: [Spot; 2],
    /// Front end of the slider's rear half, into which the front half slides.
    pub tube: Spot,
    /// Travel from nominal, mm.
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
    pub shafts: [Spot; 4],
    /// Tips of the cranks in servo order.
    pub tips: [Spot; 4],
    /// End points of head and tail.
    pub points: [Spot; 2],
    /// The sliders, left and right.
    #[tsify(type = "[SliderScene, SliderScene]")]
    pub sliders: Vec<SliderScene>,
    /// The legs in servo order.
    #[tsify(type = "Four<LegScene>")]
    pub legs: Vec<LegScene>,
    /// All margins.
    pub margins: Vec<Margin>,
    /// The smallest margin.
    pub smallest: Margin,
    /// The message about the limit that this pose violates; `None` if the pose is allowed.
    pub refusal: Option<String>,
    /// The pose's points on the maps of singularities of head and tail.
    pub map: [MapPoint; 2],
}

impl Scene {
    /// Computes the scene of a twin's current pose.
    ///
    /// # Errors
    /// Returns the message about the loop that does not close.
    pub fn of(twin: &Twin) -> Result<Self, String> {
        let (robot, angles) = (twin.robot(), twin.angles());
        let pose = Pose::from(angles);
        let solution = robot
            .lizard()
            .solve(&pose)
            .map_err(|fault| fault.to_string())?;
        let shape = Shape::at_solution(robot, &solution, twin.leg_sweeps());
        let sprung = twin.ground().drive.kind != lizard_robot::DriveKind::Rigid;
        let refusal = robot.limits().violations(&solution).next();
        let margin_of = |(check, value): (Check, f64)| Margin {
            name: check.name(),
            value,
        };
        Ok(Self {
            angles,
            shafts: shape.shafts.map(Spot::from),
            tips: shape.crank_tips.map(Spot::from),
            points: shape.ends.map(Spot::from),
            sliders: Side::ALL
                .map(|side| slider_scene(robot, &shape, &solution, side))
                .into(),
            legs: shape.legs.map(|leg| LegScene::of(leg, sprung)).into(),
            margins: solution.margins.iter().map(margin_of).collect(),
            smallest: margin_of(solution.margins.min()),
            refusal: refusal.map(|violation| violation.to_string()),
            map: End::ALL.map(|end| map::map_point(end, &pose)),
        })
    }
}

impl LegScene {
    fn of(leg: LegPlace, sprung: bool) -> Self {
        Self {
            pivots: leg.pivots.map(Spot::from),
            joints: leg.joints.map(Spot::from),
            foot: leg.foot.into(),
            strut: leg.strut_anchors.map(Spot::from),
            sprung,
        }
    }
}

fn slider_scene(robot: &Robot, shape: &Shape, solution: &Solution, side: Side) -> SliderScene {
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
        tips: tips.map(Spot::from),
        tube: (tips[1] + pose.span * (rear_half / pose.d)).into(),
        travel: pose.s,
    }
}

#[cfg(test)]
mod tests {
    use lizard_twin::ServoModel;

    use super::*;
    use crate::paper::{PAPER_TOML, paper_robot};

    fn scene_at(robot: &Robot, angles: [f64; 4]) -> Scene {
        let mut twin = Twin::new(robot, ServoModel::Ideal);
        twin.push_angles(angles);
        Scene::of(&twin).expect("every loop closes")
    }

    #[test]
    fn the_neutral_pose_has_the_papers_head_point_and_no_refusal() {
        let robot = paper_robot();
        let scene = scene_at(&robot, robot.neutral_pose().into());
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
        assert!(scene.legs.iter().all(|leg| !leg.sprung));
    }

    #[test]
    fn the_refusal_of_a_pose_near_a_singularity_names_its_margin() {
        let scene = scene_at(&paper_robot(), [75.0, 105.0, 318.59, 221.41]);
        let refusal = scene.refusal.expect("the pose is refused");
        assert!(refusal.contains("type2_head"), "{refusal}");
    }

    #[test]
    fn the_message_names_the_loop_that_does_not_close() {
        // Couplers that barely reach each other in the neutral pose.
        let short_toml = ["l2", "l3"]
            .iter()
            .fold(PAPER_TOML.to_string(), |text, link| {
                text.replace(&format!("{link} = 50.0"), &format!("{link} = 34.0"))
            });
        let gaits_start = short_toml
            .find("[gait.walk]")
            .expect("paper.toml has this gait");
        let loose_toml = short_toml[..gaits_start].replace("type2 = 0.3", "type2 = 0.1");
        let robot = Robot::parse(&loose_toml).expect("the neutral pose is allowed");
        let mut twin = Twin::new(&robot, ServoModel::Ideal);
        twin.push_angles([170.0, 10.0, 318.59, 221.41]);
        let fault = Scene::of(&twin).expect_err("the couplers cannot meet");
        assert!(fault.contains("head"), "{fault}");
    }
}
