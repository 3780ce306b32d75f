//! List of the walks that both the contact model and MuJoCo simulate: every gait in its cases.

use lizard_parts::{Assembly, Scene};
use lizard_robot::Robot;

use crate::case::Case;
use crate::mujoco::make_two_cycle_scene;
use crate::results::Displacement;

/// The walk of a gait in a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Walk {
    /// The gait's name.
    pub gait: String,
    /// The case of the legs and feet.
    pub case: Case,
    /// True if the contact model has a result: at no time do two feet pull against the other two.
    pub is_determined: bool,
}

impl Walk {
    /// Returns MuJoCo's scene with this name.
    pub fn make_scene(&self, name: &str, assembly: &Assembly) -> Scene {
        make_two_cycle_scene(name, assembly, &self.gait, self.case)
    }

    /// Simulates a cycle in the contact model; returns `None` if the model has no result.
    ///
    /// # Panics
    /// If the robot has no such gait.
    pub fn simulate_contact_model(&self, robot: &Robot) -> Option<Displacement> {
        let gait = robot.gait(&self.gait).expect("the robot has this gait");
        let simulate = || gait.simulate_cycle(&self.case.ground(robot)).travel;
        self.is_determined.then(|| simulate().into())
    }
}

/// Returns the walks of a robot: every moving gait in every case. A gait without a result in the contact model walks
/// only in the first case.
pub fn list_walks(robot: &Robot) -> Vec<Walk> {
    let [first_case, ..] = Case::ALL;
    let mut walks = Vec::new();
    for gait in robot.gaits().iter().filter(|gait| gait.has_movement()) {
        let is_determined = gait.predict(&first_case.ground(robot)).is_determined();
        let cases = Case::ALL.into_iter();
        let cases = cases.filter(|case| is_determined || *case == first_case);
        walks.extend(cases.map(|case| Walk {
            gait: gait.name().to_owned(),
            case,
            is_determined,
        }));
    }
    walks
}
