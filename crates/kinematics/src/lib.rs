//! Closed-form kinematics of a robotic lizard: all joints from four servo angles, and servo angles from a point.
//!
//! The body is a planar mechanism. Two five-bars (RRRRR) carry the head and the tail. On each side two arms and a
//! prismatic joint form a loop (RRPRR). Each leg is a parallelogram. Four servos drive the whole mechanism. The
//! position of a five-bar follows from the intersection of two circles, that of a slider from its arm tips, so both
//! have closed forms. This crate uses geometric forms, which stay accurate where the paper's half-angle formulas divide
//! zero by zero.
//!
//! # When not to use it
//! - For mechanisms with other loops: it solves only five-bars, sliders between two arms, and
//!   parallelograms.
//! - For forces, masses or contact with the floor: it computes geometry, rates and accelerations only.
//! - On a microcontroller: it computes in f64. The firmware of this robot has its own integer
//!   arithmetic.
//! - To plan a path or to choose a working mode: it solves one pose at a time, and returns all
//!   four solutions of a five-bar's inverse kinematics.
//!
//! # Example
//!
//! ```
//! use lizard_kinematics::{End, InfeasiblePose, Leg, Lizard, Vector};
//!
//! fn main() -> Result<(), InfeasiblePose> {
//!     // The paper's robot: links l0 to l19, then the parallelogram of a leg, mm.
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
//!     // The smallest margin: 0 at a singularity, 1 as far from one as possible.
//!     let (check, margin) = solution.margins.min();
//!     assert!(margin > 0.3, "{check} has only {margin}");
//!
//!     // Inverse, in the head's own frame: the angles of A1 and A2 that put the head at this point.
//!     let [theta1, theta4] = lizard.point_angles(End::Head, lizard.to_end(End::Head, point))?;
//!     assert!((theta1 - 130.0).abs() < 1e-9 && (theta4 - 45.0).abs() < 1e-9);
//!
//!     // A point that is out of reach is an error that names the mechanism.
//!     let error = lizard.point_angles(End::Head, Vector::new(0.0, 500.0)).unwrap_err();
//!     let text = "head: the point is 500.100 mm from the left shaft, but must be between 20.000 and 80.000 mm away";
//!     assert_eq!(error.to_string(), text);
//!     Ok(())
//! }
//! ```
//!
//! # Conventions
//! - Chassis frame: origin in the middle of the chassis, x to the robot's right,
//!   y forward, angles counter-clockwise from +x seen from above.
//! - All signatures use degrees and millimetres, except where Jacobians and other derivatives
//!   are documented to be per radian.
//! - Servo order is A1, A2, A3, A4 = theta1, theta4, theta8, theta5: clockwise, seen from above,
//!   from the front left. Legs are in servo order, too: left front, right front, right hind,
//!   left hind (LF, RF, RH, LH).
//! - Each [`End`] has its own frame, in which the tail is solved like the head; each
//!   [`Side`] has a front and a rear servo. Only these two types convert between frames
//!   and orders of servos.
//! - Symbols (l0..l19, theta1..theta16, lg) are those of the paper: *Optimal Kinematic Design
//!   of a Robotic Lizard using Four-Bar and Five-Bar Mechanisms*. Where a printed equation is
//!   wrong, the documentation of its replacement states this; `lizard errata` measures the error.
//!
//! # Determinism
//! The crate uses only basic IEEE operations, including the square root, and `libm`. The results are therefore
//! bit-identical on every host, and programs, tests and the web page agree. To solve poses, the crate uses the square
//! root of the standard library. That of `libm` is an SSE instruction in inline assembly, which the compiler cannot
//! vectorise and which is a hundred times slower among AVX instructions.

#[cfg(test)]
extern crate self as lizard_kinematics;

mod angle;
mod conditions;
mod constraints;
mod derivatives;
mod end;
mod fault;
mod five_bar;
mod jacobian;
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
pub use constraints::{BlockDeterminants, PassiveJoints};
pub use derivatives::{Derivative, Derivatives, ServoMotion};
pub use end::End;
pub use fault::{Fault, InfeasiblePose, Mechanism};
pub use five_bar::{AssemblyMode, Elbow, FiveBar, FiveBarPose, InverseSolution, WorkingMode};
pub use jacobian::Jacobian;
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
