//! The robot's numbers: everything that the build script computes from
//! `robot.toml`. Constants are folded into the code, tables stay in flash.
//!
//! The build refuses a `robot.toml` with a length that these types cannot
//! hold or a gait that breaks a margin, so nothing is checked again here.

use crate::clearance::Limits;
use crate::fivebar::FiveBar;
use crate::gait::{Channel, Gait};
use crate::pose::Servo;
use crate::slider::Slider;
use crate::slope::Slope;

include!(concat!(env!("OUT_DIR"), "/robot.rs"));
