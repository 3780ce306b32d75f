//! Tests across modules: the complete robot, compared with independent solvers.

mod conditions;
mod finite;
mod lanes;
mod lizard;
mod reference;
mod workspace;
