//! Where every joint of the robotic lizard is, given its four servo angles.
//!
//! The body is a planar mechanism. Two five-bars (RRRRR) carry the head and the
//! tail. On each side two arms and a prismatic joint form a loop (RRPRR). Four
//! parallelograms are the legs. Four servos drive it all. Each loop is solved by
//! the meeting of two circles, so each has a closed form; this crate states those
//! forms geometrically, which keeps their accuracy in the places where the
//! paper's half-angle formulas divide zero by zero.
//!
//! # Conventions
//! - Chassis frame: origin in the middle of the chassis, x to the robot's right,
//!   y forward, angles counter-clockwise from +x seen from above.
//! - Degrees and millimetres in every signature. Radians never leave this crate,
//!   except in rates and Jacobians, which say so.
//! - Servo order A1, A2, A3, A4 = theta1, theta4, theta8, theta5: clockwise from
//!   the front left.
//! - Each [`End`] has a frame of its own, in which the tail is solved as the head
//!   is; each [`Side`] has a front and a rear servo. They own every change of
//!   frame and every order of servos.
//! - Legs in servo order: LF, RF, RH, LH.
//! - Symbols (l0..l19, theta1..theta16, lg) are the paper's: *Optimal Kinematic
//!   Design of a Robotic Lizard using Four-Bar and Five-Bar Mechanisms*. Where
//!   a printed equation does not hold, the item that replaces it says so;
//!   `lizard errata` measures by how much.
//!
//! # Determinism
//! Only IEEE basic operations, the square root among them, and `libm` are used,
//! so the same input gives the same bits on every host, and a build script, a
//! test and a web page agree. Square roots are the standard library's: `libm`'s
//! is one SSE instruction in inline assembly, which no compiler turns into a
//! vector instruction and which costs a hundred times its time among AVX ones.
#![forbid(unsafe_code)]
#![deny(missing_docs)]
#![warn(clippy::missing_errors_doc)]

#[cfg(test)]
extern crate self as lizard_kinematics;

mod angle;
mod conditioning;
mod conditions;
mod constraints;
mod derivatives;
mod end;
mod fault;
mod five_bar;
mod leg;
mod limits;
mod links;
mod lizard;
mod margins;
mod real;
mod side;
mod singular;
mod slider;
mod vector;
mod workspace;

#[cfg(test)]
#[path = "../tests/kinematics/reference.rs"]
mod reference;

pub use angle::{atan2, atan2_all, sin_cos, sin_cos_all, wrap};
pub use conditioning::Jacobian;
pub use constraints::{Blocks, Passive};
pub use derivatives::{Derivative, Derivatives, Drive};
pub use end::End;
pub use fault::{Fault, Infeasible, Part};
pub use five_bar::{AssemblyMode, Elbow, FiveBar, FiveBarPose, InverseSolution, WorkingMode};
pub use leg::{Leg, LegPose};
pub use limits::{Limits, Violation};
pub use links::Links;
pub use lizard::{Lizard, Pose, Solution};
pub use margins::{Check, Margins};
pub use real::{Lanes, Real};
pub use side::Side;
pub use singular::{SingularPose, Singularity};
pub use slider::{Slider, SliderPose};
pub use vector::Vector;
pub use workspace::{Circle, Workspace};
