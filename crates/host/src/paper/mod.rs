//! The paper, section by section: *Optimal Kinematic Design of a Robotic Lizard
//! using Four-Bar and Five-Bar Mechanisms*.

pub mod charts;
pub mod design;
pub mod errata;
mod inverse;
pub mod mobility;
pub mod pose;
pub mod pose_line;
pub mod poses;
pub mod singularity;
mod solve;
pub mod tidy;
mod velocity;
pub mod verdict;
