//! The firmware's portable core, run on this machine and held against floating
//! point, geometry and its own promises.
//!
//! `truth` says what is right without the core.
//! `guard*` walk its decision over every pose that matters, `motion*` follow its
//! frames. What needs no other crate is tested beside the code, in core/src.

mod frames;
mod ground;
mod guard_links;
mod guard_poses;
mod guard_printed;
mod guard_squares;
mod motion_gaits;
mod motion_guard;
mod truth;
