//! The floor: level or sloping, with blocks on it, and with a friction coefficient for each pad.

use lizard_robot::Robot;

/// The floor of a simulation: its slope, its blocks and its friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Floor {
    /// The blocks that lie on the floor.
    pub blocks: Vec<Block>,
    /// Angle by which the floor rises in the robot's forward direction, deg.
    pub slope: f64,
    /// The friction coefficient under each pad, in servo order.
    pub friction_coefficients: [f64; 4],
}

/// A block on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// The block's middle, mm to the right of the robot's start position and ahead of it.
    pub centre: [f64; 2],
    /// The block's size to the right, forward and up, mm, before the block is turned.
    pub size: [f64; 3],
    /// The angle by which the block is turned about its middle, deg counter-clockwise.
    pub rotation: f64,
}

impl Floor {
    /// The empty, level floor of a robot.toml.
    #[must_use]
    pub fn of(robot: &Robot) -> Self {
        Self {
            blocks: Vec::new(),
            slope: 0.0,
            friction_coefficients: [robot.ground().friction_coefficient; 4],
        }
    }
}
