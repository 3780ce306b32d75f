//! The paper, section by section: *Optimal Kinematic Design of a Robotic Lizard
//! using Four-Bar and Five-Bar Mechanisms*.

pub mod poses;
pub mod record;
pub mod solve;
