//! The bodies of the robot, and their placements at a pose.
//!
//! A robot has about two hundred bodies: printed parts, servos, screws, a board, a battery. Each module makes the
//! bodies of one area of the robot from its robot.toml; [`assembly`] collects them and computes their placements at a
//! pose.

pub(crate) mod assembly;
pub(crate) mod builder;
pub(crate) mod chassis;
pub(crate) mod decoration;
pub(crate) mod ends;
pub(crate) mod fittings;
pub(crate) mod layout;
pub(crate) mod leads;
pub(crate) mod legs;
pub(crate) mod links;
pub(crate) mod pads;
pub(crate) mod sliders;
pub(crate) mod struts;
