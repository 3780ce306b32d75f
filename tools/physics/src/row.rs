//! List of the gaits that are walked, each in its cases.

use lizard_parts::{Assembly, Scene};
use lizard_robot::{CheckedGait, Robot};

use crate::case::{Case, Legs};
use crate::figures::Displacement;
use crate::mujoco::scene_of;

/// A gait to be walked in a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The gait's name.
    pub gait: String,
    /// The case in which the gait is walked.
    pub case: Case,
    /// True if the contact model has an answer, since at no time two feet pull against the other two.
    pub is_decided: bool,
}

impl Row {
    /// Returns the scene for MuJoCo under a name, and the scene's legs.
    pub fn scene(&self, name: &str, assembly: &Assembly) -> (Legs, Scene) {
        let scene = scene_of(name, assembly, &self.gait, self.case);
        (self.case.legs, scene)
    }

    /// Returns the contact model's displacement; `None` if the model has no answer.
    ///
    /// # Panics
    /// If the robot has no such gait.
    pub fn model(&self, robot: &Robot) -> Option<Displacement> {
        let gait = robot.gait(&self.gait).expect("it is the robot's");
        let simulate = || gait.simulate_cycle(&self.case.ground(robot)).travel;
        self.is_decided.then(|| simulate().into())
    }
}

/// Returns every gait of a robot that moves, in every case. A gait on which the contact model cannot decide
/// has only the first case.
pub fn rows(robot: &Robot) -> Vec<Row> {
    let gaits = robot.gaits().iter().filter(|gait| gait.has_movement());
    gaits.flat_map(|gait| rows_of(robot, gait)).collect()
}

fn rows_of(robot: &Robot, gait: &CheckedGait) -> Vec<Row> {
    let [first_case, ..] = Case::ALL;
    let is_decided = gait.predict(&first_case.ground(robot)).is_decided();
    let cases = Case::ALL
        .into_iter()
        .filter(|case| is_decided || *case == first_case);
    let row_of = |case| Row {
        gait: gait.name().to_owned(),
        case,
        is_decided,
    };
    cases.map(row_of).collect()
}
