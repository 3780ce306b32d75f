//! Tests across modules: the complete robot, compared with solvers that share only the link lengths
//! with it.

mod conditions;
mod finite;
mod lanes;
mod lizard;
mod reference;
mod workspace;
