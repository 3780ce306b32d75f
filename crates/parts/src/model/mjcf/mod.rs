//! The file for MuJoCo: the robot on its floor, the motors, and their target angles.
//!
//! MuJoCo requires a tree of bodies, so each closed loop is cut, and a constraint closes it again.

mod document;
mod floor_and_pads;
mod loops_and_motors;
mod sensors;
mod tree;
