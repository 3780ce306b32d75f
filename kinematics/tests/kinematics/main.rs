//! The closed forms against solvers that share nothing with them but lengths.

mod angle;
mod five_bar;
mod lizard;
mod motion;
mod reference;
mod singular;
mod workspace;
