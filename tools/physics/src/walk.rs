//! List of the walks that both the contact model and MuJoCo simulate: every gait in its cases.

use lizard_parts::{Assembly, Scene};
use lizard_robot::{CheckedGait, Robot};

use crate::case::{Case, Legs};
use crate::figures::Displacement;
use crate::mujoco::scene_of;

/// The walk of a gait in a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Walk {
    /// The gait's name.
    pub gait: String,
    /// The case in which the gait is walked.
    pub case: Case,
    /// True if the contact model has a result: no two feet pull against the other two at any time.
    pub is_decided: bool,
}

impl Walk {
    /// Returns the legs, and the scene for MuJoCo under this name.
    pub fn scene(&self, name: &str, assembly: &Assembly) -> (Legs, Scene) {
        let scene = scene_of(name, assembly, &self.gait, self.case);
        (self.case.legs, scene)
    }

    /// Returns the contact model's displacement; `None` if the model has no result.
    ///
    /// # Panics
    /// If the robot has no such gait.
    pub fn model_displacement(&self, robot: &Robot) -> Option<Displacement> {
        let gait = robot.gait(&self.gait).expect("the robot has this gait");
        let simulate = || gait.simulate_cycle(&self.case.ground(robot)).travel;
        self.is_decided.then(|| simulate().into())
    }
}

/// Returns the walks of a robot: every gait that moves, in every case. A gait for which the contact model has no result
/// is walked only in the first case.
pub fn walks_of(robot: &Robot) -> Vec<Walk> {
    let gaits = robot.gaits().iter().filter(|gait| gait.has_movement());
    gaits.flat_map(|gait| walks_of_gait(robot, gait)).collect()
}

fn walks_of_gait(robot: &Robot, gait: &CheckedGait) -> Vec<Walk> {
    let [first_case, ..] = Case::ALL;
    let is_decided = gait.predict(&first_case.ground(robot)).is_decided();
    let cases = Case::ALL
        .into_iter()
        .filter(|case| is_decided || *case == first_case);
    let walk_in = |case| Walk {
        gait: gait.name().to_owned(),
        case,
        is_decided,
    };
    cases.map(walk_in).collect()
}
