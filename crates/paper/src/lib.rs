//! The paper *Optimal Kinematic Design of a Robotic Lizard using Four-Bar and Five-Bar Mechanisms*, computed.
//!
//! Many of its equations are wrong as printed, and it claims a conditioning that its dimensions do not have.
//! [`errata`] evaluates every printed equation, and its correction, at random poses against the geometric solution.
//! [`design`] repeats the dimensional synthesis, and searches better proportions. [`mobility`] counts the degrees of
//! freedom of the body and of the legs, and measures them by the rank of the constraints.
//!
//! The crate reads, stores and prints nothing; [`errata`] and [`design`] use all cores.
//!
//! # When not to use it
//! To solve poses, take `lizard-kinematics`: this crate only judges what the paper prints about them. The equations
//! are those of this paper; nothing here reads other ones.
//!
//! # Units
//! mm and degrees, in the chassis frame: +x to the right, +y to the head, angles counter-clockwise from +x.

pub mod design;
pub mod errata;
pub mod mobility;
