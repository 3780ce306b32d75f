//! Computations on the paper *Optimal Kinematic Design of a Robotic Lizard using Four-Bar and Five-Bar Mechanisms*.
//!
//! Many of the paper's equations are wrong as printed, and its design does not have the conditioning that the paper
//! claims. [`errata`] evaluates every printed equation and its correction at random poses, and compares both with the
//! geometric solution. [`design`] repeats the dimensional synthesis, and searches for better proportions. [`mobility`]
//! computes the degrees of freedom of the body and of the legs, by Gruebler's count and by the rank of the constraints.
//!
//! The crate reads no files, stores nothing and prints nothing. [`errata`] and [`design`] use all cores.
//!
//! # When not to use it
//! To solve poses, use `lizard-kinematics`. This crate only checks the equations of this paper.
//!
//! # Units
//! mm and degrees, in the chassis frame: +x to the right, +y to the head, angles counter-clockwise from +x.

mod bisection;
pub mod design;
pub mod errata;
pub mod mobility;
