//! The paper's robot, for tests.

use lizard_robot::Robot;
use lizard_twin::{ServoModel, Twin};

/// The text of robots/paper.toml.
pub const PAPER_TOML: &str = include_str!("../../../robots/paper.toml");

/// Reads the paper's robot.
pub fn paper_robot() -> Robot {
    Robot::parse(PAPER_TOML).expect("paper.toml is valid")
}

/// Reads the paper's robot, and makes a twin of it with ideal servos.
pub fn paper_robot_and_twin() -> (Robot, Twin) {
    let robot = paper_robot();
    let twin = Twin::new(&robot, ServoModel::Ideal);
    (robot, twin)
}
