//! The height of the deck's card, which lies on top of the board.

use lizard_parts::Assembly;
use lizard_robot::Robot;

/// The height of the board's top above the floor, computed from the robot's parts, mm.
pub fn board_height(robot: &Robot) -> f64 {
    let assembly = Assembly::new(robot);
    let board = assembly.body("board").into_iter();
    let top_heights = board.flat_map(|body| &body.prisms).map(|prism| prism.z[1]);
    top_heights.fold(0.0, f64::max) - assembly.stack().floor
}
