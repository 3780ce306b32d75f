//! The robot of the paper, for tests.

use lizard_robot::Robot;
use lizard_twin::{ServoModel, Twin};

/// Its robot.toml.
pub const TEXT: &str = include_str!("../../../robots/paper.toml");

/// The robot.
pub fn paper() -> Robot {
    Robot::parse(TEXT).expect("right")
}

/// The same, and where its pulses take it with servos that follow them at once.
pub fn with_twin() -> (Robot, Twin) {
    let robot = paper();
    let twin = Twin::new(&robot, ServoModel::IDEAL);
    (robot, twin)
}
