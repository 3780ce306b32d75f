//! The height of the robot's deck: the top of its board, on which the card with the robot's tag lies.

use lizard_parts::Assembly;
use lizard_robot::Robot;

/// Computes the deck's height above the floor from the robot's parts, mm.
pub fn compute_deck_height(robot: &Robot) -> f64 {
    let assembly = Assembly::new(robot);
    let board = assembly.body("board").into_iter();
    let top_heights = board.flat_map(|body| &body.prisms).map(|prism| prism.z[1]);
    top_heights.fold(0.0, f64::max) - assembly.stack().floor
}
