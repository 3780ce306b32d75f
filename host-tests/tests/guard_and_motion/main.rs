//! Tests of the core's guard, gaits and motion on this machine, compared with floating point. The tests use the robot
//! under test, every robot in robots/, and random robots without symmetry.
//!
//! `truth` computes the expected values without the core. `frames` commands a robot through its console and checks
//! every frame that the robot sends.

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
