//! Flat layers, of which every part is made.
//!
//! Printing, cutting and the proof of fit all need to know where a part has material. The mechanism is flat, so a part
//! is a stack of layers, each a union of flat convex shapes between two heights. This module has the shapes, their
//! outlines and placements, the heights of the robot's layers, the marks, the fittings that are bought, and the changes
//! that make a layer printable.

pub(crate) mod body;
pub(crate) mod fitting;
pub(crate) mod mark;
pub(crate) mod outline;
pub(crate) mod placement;
pub(crate) mod roof;
pub(crate) mod shape;
pub(crate) mod stack;
