//! The paper's robot, for tests.

use lizard_robot::Robot;
use lizard_twin::{ServoModel, Twin};

/// The text of robots/paper.toml.
pub const TEXT: &str = include_str!("../../../robots/paper.toml");

/// Reads the paper's robot.
pub fn paper() -> Robot {
    Robot::parse(TEXT).expect("right")
}

/// Reads the paper's robot, and makes a twin of it with ideal servos.
pub fn with_twin() -> (Robot, Twin) {
    let robot = paper();
    let twin = Twin::new(&robot, ServoModel::Ideal);
    (robot, twin)
}
