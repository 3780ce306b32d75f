//! The file for MuJoCo: the robot on its floor, the motors, and the angles that they follow.
//!
//! MuJoCo wants a tree, so a constraint closes each loop again.

mod document;
mod drives;
mod footing;
mod sensors;
mod tree;
