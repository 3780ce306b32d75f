//! The solid model of the robot, generated from robot.toml: bodies built of layers, and their placements at a pose.
//!
//! The mechanism is planar and all its joint axes are vertical, so a part is a stack of layers, each a flat shape
//! between two heights. [`Stack`] is the one table of all these heights. A pose rotates and translates each body in the
//! plane; no body moves up or down.
//!
//! # Example
//! ```
//! let robot = lizard_robot::Robot::parse(include_str!("../../../robots/paper.toml"))?;
//! let assembly = lizard_parts::Assembly::new(&robot);
//! let pose = robot.lizard().solve(&robot.neutral_pose()).expect("the linkages close at neutral");
//! for body in assembly.bodies() {
//!     let placement = assembly.placement(body.mount, &pose);
//!     for prism in &body.prisms {
//!         let _shapes: Vec<_> = prism.filled_shapes.iter().map(|shape| shape.placed(&placement)).collect();
//!     }
//! }
//! # Ok::<(), lizard_robot::Error>(())
//! ```
//!
//! # Concepts
//! - A [`Body`] is rigid: a printed part, a servo, a screw, a nut, a spring, the board, the battery. Its layers
//!   ([`Prism`]) are in the frame of its mount, with z in the chassis frame.
//! - A [`Mount`] is a body's moving frame. The placements of `Link`, `Crank`, `Follower`, `Foot` and `Strut` depend
//!   on one servo, `Coupler` on both servos of its end, `Sleeve` and `Rod` on both servos of their side, `Chassis` on
//!   none. Links, cranks and followers turn about a fixed point by the servo's angle; feet do not turn, and
//!   struts turn only if a leg lags behind its servo. [`Assembly::placement`] computes the placements.
//! - A [`Shape`] is convex: the hull of some points, grown by a radius. A layer is the union of its shapes minus its
//!   holes, so the shapes enclose the layer: a body that is clear of the shapes is clear of the part.
//!   [`Shape::distance`] is exact.
//! - [`Assembly::may_touch`] is true for bodies that move together, and for bodies that touch by design. One of two
//!   bodies that touch by design names the other in [`Body::allowed_contacts`]: a screw names the parts that it passes
//!   through, a sleeve its rod, a strut the crank that its spring pulls.
//! - [`Assembly::prove`] proves how close any two bodies come at any pose that the guard accepts;
//!   [`Assembly::find_close_pairs`] checks only the given poses.
//! - [`Assembly::alternatives`] are bodies that may replace others: the struts of the kind that robot.toml does not
//!   select.
//! - [`Layout`] is the plan of pivots and anchors from above; [`lizard_robot::LegPlan`] has those of the legs.

mod bill;
mod bodies;
mod build_error;
mod decimals;
mod files;
mod guide;
mod layers;
mod mass;
mod model;
mod order;
mod part;
mod price;
mod proof;
mod spring_effect;

pub use bill::{Bill, Item, format_buying_table, format_mounting_table};
pub use bodies::assembly::Assembly;
pub use bodies::layout::Layout;
pub use build_error::{BuildError, CollidingPair};
pub use files::coupon::build_coupon;
pub use files::mesh::Mesh;
pub use files::sheet::{Sheet, SheetLayer, draw_sheets};
pub use files::solid::{Edge, Face, Solid, Surface};
pub use files::{OutputFile, make_part_files};
pub use guide::make_documents;
pub use layers::body::{Body, Kind, Mount, Prism};
pub use layers::fitting::{BATTERY_EXAMPLES, Example, Fitting, FittingSpec};
pub use layers::outline::{Loop, Outline, Segment};
pub use layers::placement::Placement;
pub use layers::shape::Shape;
pub use layers::stack::{Span, Stack};
pub use model::{Block, Floor, Pads, Pieces, Scene, StrutSpring, Trajectory};
pub use order::reach::{AccessPose, BlockedScrew, ScrewOperation};
pub use order::steps::{ExtraView, Stage, Step, TurningPlace, build_steps};
pub use part::{Part, PrintTransform};
pub use price::PriceClass;
pub use proof::clearance::Clearance;
pub use proof::{Clash, FAR_MM, MIN_GAP_MM, NearestPair, Proof, ProofTasks, TaskResult};
pub use spring_effect::SpringEffect;
