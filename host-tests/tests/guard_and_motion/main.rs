//! Tests of the core's guard, gaits and motion on this machine, compared with floating point. The tests use the robot
//! under test, every robot in robots/, and random robots without symmetry.
//!
//! `reference` computes the expected values without the core. `checked_robot` commands a robot through its console and
//! checks every frame that the robot sends.

mod checked_robot;
mod displacement;
mod gaits;
mod guard_poses;
mod motion;
mod motion_guard;
mod paper_conditions;
mod reference;
mod running_gaits;
