//! Films whose true values are known, for the tests of what measures films: the robot on the sheet ([`walk`]), a
//! servo's horn ([`servo`]) and a sliding board ([`board`]), seen by a camera with noise, blur, distortion and uneven
//! light ([`render`]).

pub mod board;
pub mod render;
pub mod servo;
pub mod walk;
