//! Flat layers: of what every part is made.
//!
//! A printer, a saw and a proof all need the same of a part: where there is material. The
//! mechanism is flat, so a part is a stack of layers, each a flat convex shape between two
//! heights. Here are shapes, their outlines, the heights of the whole robot, and what a
//! layer needs so that it can be printed.

pub(crate) mod body;
pub(crate) mod fitting;
pub(crate) mod mark;
pub(crate) mod outline;
pub(crate) mod placement;
pub(crate) mod roof;
pub(crate) mod shape;
pub(crate) mod stack;
