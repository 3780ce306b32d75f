//! The paper, section by section: *Optimal Kinematic Design of a Robotic Lizard
//! using Four-Bar and Five-Bar Mechanisms*.

pub mod charts;
pub mod design;
pub mod errata;
pub mod inverse;
pub mod mobility;
pub mod pose_line;
pub mod poses;
pub mod singularity;
pub mod solve;
pub mod speed;
pub mod tidy;
pub mod velocity;
pub mod verdict;
