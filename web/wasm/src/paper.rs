//! The paper's robot, for tests.

use lizard_robot::Robot;
use lizard_twin::{ServoModel, Twin};

/// The text of robots/paper.toml.
pub const PAPER_TOML: &str = include_str!("../../../robots/paper.toml");

/// Loads the paper's robot.
pub fn load_paper_robot() -> Robot {
    Robot::parse(PAPER_TOML).expect("paper.toml is valid")
}

/// Loads the paper's robot, and makes its twin with ideal servos.
pub fn load_paper_robot_and_twin() -> (Robot, Twin) {
    let robot = load_paper_robot();
    let twin = Twin::new(&robot, ServoModel::Ideal);
    (robot, twin)
}
