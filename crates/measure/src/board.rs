//! The place of the deck's card: the top of the board.

use lizard_parts::Assembly;
use lizard_robot::Robot;

/// The height of the board's top above the floor by the robot's parts, mm.
pub fn height_of_board(robot: &Robot) -> f64 {
    let assembly = Assembly::new(robot);
    let board = assembly.body("board").into_iter();
    let tops = board.flat_map(|body| &body.prisms).map(|prism| prism.z[1]);
    tops.fold(0.0, f64::max) - assembly.stack().floor
}
