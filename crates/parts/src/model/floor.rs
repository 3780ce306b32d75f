//! The floor: level or sloping, with blocks, and with a friction coefficient for each pad.

use lizard_robot::Robot;

/// The floor of a simulation: its slope, its blocks and its friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Floor {
    /// Blocks on the floor.
    pub blocks: Vec<Block>,
    /// Slope in the robot's forward direction, deg; positive if the floor rises.
    pub slope: f64,
    /// Friction coefficient under each pad, in servo order.
    pub friction_coefficients: [f64; 4],
}

/// A block on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Position of the centre relative to the robot's start, mm: to the right, forward.
    pub centre: [f64; 2],
    /// Size before the rotation, mm: to the right, forward, up.
    pub size: [f64; 3],
    /// Rotation about the centre, deg, counter-clockwise.
    pub rotation: f64,
}

impl Floor {
    /// Creates a level floor without blocks, with the friction coefficients of robot.toml.
    pub fn for_robot(robot: &Robot) -> Self {
        Self {
            blocks: Vec::new(),
            slope: 0.0,
            friction_coefficients: [robot.ground().friction_coefficient; 4],
        }
    }
}
