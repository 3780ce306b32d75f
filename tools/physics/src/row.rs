//! The gaits that are walked, each in its cases.

use lizard_robot::{CheckedGait, Robot};

use crate::case::Case;
use crate::figures::Way;

/// A gait that is to be walked.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its name.
    pub gait: String,
    /// Legs and feet.
    pub case: Case,
    /// Whether it depends on no ties, so that the contact model has an answer.
    pub decided: bool,
}

impl Row {
    /// What the contact model says.
    ///
    /// # Panics
    /// Where the gait is none of the robot's.
    #[must_use]
    pub fn model(&self, robot: &Robot) -> Option<Way> {
        let gait = robot.gait(&self.gait).expect("it is the robot's");
        let walked = || gait.walked(&self.case.ground(robot)).travel;
        self.decided.then(|| walked().into())
    }
}

/// Every gait of a robot that moves, in every case; what depends on ties in the first alone.
#[must_use]
pub fn rows(robot: &Robot) -> Vec<Row> {
    let gaits = robot.gaits().iter().filter(|gait| gait.moves());
    gaits.flat_map(|gait| rows_of(robot, gait)).collect()
}

fn rows_of(robot: &Robot, gait: &CheckedGait) -> Vec<Row> {
    let [first, ..] = Case::ALL;
    let decided = gait.predict(&first.ground(robot)).is_decided();
    let cases = Case::ALL
        .into_iter()
        .filter(|case| decided || *case == first);
    let row = |case| Row {
        gait: gait.name().to_owned(),
        case,
        decided,
    };
    cases.map(row).collect()
}
