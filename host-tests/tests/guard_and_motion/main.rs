//! The core's guard, gaits and motion with any robot, run on this machine and compared with
//! floating point: the robot under test, every file of robots/ and random robots without symmetry.
//!
//! `truth` computes the expected values without the core; `frames` drives a robot through its
//! console and checks every frame that it sends.

mod calibration;
mod frames;
mod gaits;
mod ground;
mod guard_limits;
mod guard_poses;
mod motion;
mod motion_guard;
mod paper_conditions;
mod truth;
mod under_way;
