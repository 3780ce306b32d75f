//! The paper, section by section: *Optimal Kinematic Design of a Robotic Lizard
//! using Four-Bar and Five-Bar Mechanisms*.

pub mod charts;
pub mod design;
pub mod errata;
mod inverse;
mod mobility;
pub mod pose;
mod pose_output;
mod poses;
mod singularity;
mod solve;
mod velocity;
