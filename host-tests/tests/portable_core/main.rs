//! The firmware's portable core, run on this machine and held against floating
//! point, geometry and its own promises.
//!
//! `truth` says what is right without the core; `sweep` and `person` drive it.
//! `guard*` walk its decision over every pose that matters, `motion*` follow
//! its frames, `console*` talk to it.

mod console;
mod console_angles;
mod console_refusals;
mod frames;
mod ground;
mod guard_links;
mod guard_poses;
mod guard_printed;
mod guard_squares;
mod motion;
mod motion_gaits;
mod motion_guard;
mod motion_stop;
mod person;
mod stroke;
mod trig;
mod truth;
mod units;
