//! Closed-form kinematics of a robotic lizard: every joint from four servo angles, and back.
//!
//! The body is a planar mechanism. Two five-bars (RRRRR) carry the head and the tail. On
//! each side two arms and a prismatic joint form a loop (RRPRR). Four parallelograms are
//! the legs. Four servos drive all of it. Each loop is solved by intersecting two
//! circles, so each has a closed form. This crate uses the geometric forms, which stay
//! accurate where the paper's half-angle formulas divide zero by zero.
//!
//! # When not to use it
//! - For a mechanism with other loops: this is not a general solver. It knows five-bars,
//!   sliders between two arms, and parallelograms.
//! - For forces, masses or contact with the floor: it knows geometry and rates only.
//! - On a small chip: it computes in f64. The firmware of this robot has integer forms.
//! - For a path or a choice among working modes: it solves one pose at a time and returns
//!   all four solutions of a five-bar's inverse.
//!
//! # Example
//!
//! ```
//! use lizard_kinematics::{End, Infeasible, Leg, Lizard, Vector};
//!
//! fn main() -> Result<(), Infeasible> {
//!     // The paper's robot: l0 to l19 in mm, then the parallelogram of a leg.
//!     let (crank, coupler, arm, body) = (30.0, 50.0, 45.0, 135.0);
//!     let head = [20.0, crank, coupler, coupler, crank];
//!     let side = [body, crank, arm, arm, crank];
//!     let links: [f64; 20] = [head, head, side, side].concat().try_into().unwrap();
//!     let leg = Leg { ground: 50.0, crank: 45.0, coupler: 50.0, follower: 45.0 };
//!     let lizard = Lizard { links: links.into(), leg };
//!
//!     // Forward: four servo angles, degrees, A1 to A4.
//!     let solution = lizard.solve(&[130.0, 45.0, 320.0, 222.0].into())?;
//!     let point = solution.head_point();
//!     println!("head at {:.2}, {:.2} mm; left slider at {:.2} mm", point.x, point.y, solution.left.s);
//!
//!     // The least distance from a singularity: 1 is the farthest, 0 is a singularity.
//!     let (check, margin) = solution.margins.min();
//!     assert!(margin > 0.3, "{check} has only {margin}");
//!
//!     // Back, in the head's own frame: the two servo angles that put its point there.
//!     let [theta1, theta4] = lizard.point_angles(End::Head, lizard.to_end(End::Head, point))?;
//!     assert!((theta1 - 130.0).abs() < 1e-9 && (theta4 - 45.0).abs() < 1e-9);
//!
//!     // A point that is out of reach is an error that names the mechanism.
//!     let error = lizard.point_angles(End::Head, Vector::new(0.0, 500.0)).unwrap_err();
//!     let message = "head: the point is 500.100 mm from the left shaft, which reaches 20.000 to 80.000 mm";
//!     assert_eq!(error.to_string(), message);
//!     Ok(())
//! }
//! ```
//!
//! # Conventions
//! - Chassis frame: origin in the middle of the chassis, x to the robot's right,
//!   y forward, angles counter-clockwise from +x seen from above.
//! - Degrees and millimetres in every signature. Radians never leave this crate,
//!   except in rates and Jacobians, which say so.
//! - Servo order A1, A2, A3, A4 = theta1, theta4, theta8, theta5: clockwise from
//!   the front left.
//! - Each [`End`] has its own frame, in which the tail is solved like the head; each
//!   [`Side`] has a front and a rear servo. Only these two types convert between frames
//!   and orders of servos.
//! - Legs in servo order: LF, RF, RH, LH.
//! - Symbols (l0..l19, theta1..theta16, lg) are the paper's: *Optimal Kinematic Design of
//!   a Robotic Lizard using Four-Bar and Five-Bar Mechanisms*. If a printed equation does
//!   not hold, the item that replaces it says so; `lizard errata` measures its error.
//!
//! # Determinism
//! The crate uses only IEEE basic operations, including the square root, and `libm`. So
//! the same input gives the same bits on every host, and a program, a test and a web page
//! agree. The square root is that of the standard library: `libm`'s is one SSE
//! instruction in inline assembly, which no compiler turns into a vector instruction and
//! which takes a hundred times as long among AVX instructions.

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

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}

pub use angle::{atan2, sin_cos, sin_cos_all, wrap};
pub use conditioning::Jacobian;
pub use constraints::{BlockDeterminants, PassiveJoints};
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
