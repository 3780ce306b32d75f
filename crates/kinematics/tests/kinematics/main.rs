//! Tests across modules: the whole robot against solvers that share nothing
//! with it but lengths.

mod conditions;
mod finite;
mod lanes;
mod lizard;
mod reference;
mod workspace;
