//! The solid model of the robot: bodies built of layers, and their placement at a pose, generated from robot.toml.
//!
//! The mechanism is planar and all its joint axes are vertical, so a part is a stack of layers, each a flat shape
//! between two heights, and one table has the heights of all layers ([`Stack`]). A pose rotates and translates each
//! body in the plane; nothing moves up or down.
//!
//! # Example
//! ```
//! let robot = lizard_robot::Robot::parse(include_str!("../../../robots/paper.toml"))?;
//! let assembly = lizard_parts::Assembly::new(&robot);
//! let pose = robot.lizard().solve(&robot.neutral_pose()).expect("the linkages close at neutral");
//! for body in assembly.bodies() {
//!     let place = assembly.place(body.mount, &pose);
//!     for prism in &body.prisms {
//!         let _shapes: Vec<_> = prism.filled_shapes.iter().map(|shape| shape.placed(&place)).collect();
//!     }
//! }
//! # Ok::<(), lizard_robot::Error>(())
//! ```
//! - A [`Body`] is rigid: a printed part, a servo, a screw, a nut, a spring, the board,
//!   the battery. Its layers ([`Prism`]) are given in its own frame; z is the robot's.
//! - A [`Mount`] is the moving frame that a body is fixed to, so it decides on which servos
//!   the body's place depends: `Link`, `Crank`, `Follower`, `Foot` and `Strut` on their servo
//!   alone, `Coupler` on both servos of its end, `Sleeve` and `Rod` on both of their side,
//!   `Chassis` on none. Links, cranks and followers turn about a fixed point by the servo's
//!   angle; feet and struts do not turn. [`Assembly::place`] computes this.
//! - A [`Shape`] is convex: the hull of some points, grown by a radius. A layer is the
//!   union of its shapes minus its holes, so its shapes without the holes enclose it,
//!   which suits a collision proof: a body that is clear of the shapes is clear of the part.
//!   [`Shape::distance`] is exact.
//! - [`Assembly::may_touch`] is true for pairs that touch by design: bodies that move together,
//!   and bodies of which one names the other in [`Body::allowed_contacts`], as a screw names the parts that it
//!   passes through, the rod its sleeve, and the strut the leg's crank that its spring pulls.
//! - [`Assembly::prove`] proves how close any two bodies come at any pose that the guard
//!   accepts; [`Assembly::close_pairs`] only checks some poses.
//! - [`Assembly::alternatives`] are bodies that may replace others: struts of the kind that
//!   robot.toml does not choose.
//! - [`Layout`] is the plan of pivots and anchors from above. The pivots and anchors of the legs
//!   are in [`lizard_robot::LegPlan`], which the drawings use as well.

mod bill;
mod bodies;
mod build_problem;
mod decimals;
mod files;
mod guide;
mod hold;
mod layers;
mod model;
mod order;
mod part;
mod price;
mod proof;
mod weight;

pub use bill::{Bill, Item, buying_table, places_table};
pub use bodies::assembly::Assembly;
pub use bodies::layout::Layout;
pub use build_problem::{BuildProblem, CollidingPair};
pub use files::coupon::coupon;
pub use files::mesh::Mesh;
pub use files::sheet::{Layer, Sheet, sheets};
pub use files::solid::{Edge, Face, Solid, Surface};
pub use files::{File, part_files};
pub use guide::documents::documents;
pub use hold::SpringEffect;
pub use layers::body::{Body, Kind, Mount, Prism};
pub use layers::fitting::{BATTERY_EXAMPLES, Example, Fitting, FittingFacts};
pub use layers::outline::{Loop, Outline, Segment};
pub use layers::placement::Placement;
pub use layers::shape::Shape;
pub use layers::stack::{Span, Stack};
pub use model::{Block, Course, Floor, Pads, Pieces, Scene, StrutSpring, mjcf};
pub use order::reach::{AccessPose, BlockedScrew, ScrewOperation};
pub use order::steps::{ExtraView, Stage, Step, TurningPlace, steps};
pub use part::{Part, PrintToBody};
pub use price::Price;
pub use proof::clearance::Clearance;
pub use proof::{Answer, Clash, FAR_MM, MIN_GAP_MM, NearestPair, Proof, Questions};
