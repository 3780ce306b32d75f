//! The robot as parts: from robot.toml to bodies with layers and places.
//!
//! The mechanism is flat and all its joints are upright, so a part is a stack of layers,
//! each a flat shape between two heights, and one table has the heights of the whole
//! robot ([`Stack`]). A pose turns and shifts each body in the plane; nothing moves up or
//! down.
//!
//! # How it is meant
//! ```
//! let robot = lizard_robot::Robot::parse(include_str!("../../robots/paper.toml"))?;
//! let assembly = lizard_parts::Assembly::new(&robot);
//! let pose = robot.lizard().solve(&robot.neutral()).expect("it closes");
//! for body in assembly.bodies() {
//!     let place = assembly.place(body.mount, &pose);
//!     for prism in &body.prisms {
//!         let _shapes: Vec<_> = prism.add.iter().map(|shape| shape.placed(&place)).collect();
//!     }
//! }
//! # Ok::<(), lizard_robot::Error>(())
//! ```
//! - A [`Body`] is rigid: a printed part, a servo, a screw, a nut, a spring, the board,
//!   the battery. Its layers ([`Prism`]) are given in its own frame; z is the robot's.
//! - A [`Mount`] says what a body moves with, hence on which servos its place depends:
//!   `Link`, `Crank`, `Follower`, `Foot` and `Strut` on their servo alone, `Coupler` on
//!   both servos of its end, `Sleeve` and `Rod` on both of their side, `Chassis` on none.
//!   Links, cranks and followers turn about a fixed point by the servo's angle; feet and
//!   struts do not turn. [`Assembly::place`] has this rule.
//! - A [`Shape`] is convex: the hull of some points, grown by a radius. A layer is the
//!   union of its shapes less its holes, so the shapes without the holes are a safe hull
//!   for collision proofs: what is clear of the hull is clear of the part.
//!   [`Shape::distance`] is exact.
//! - [`Assembly::meet`] says which pairs touch by design: bodies that move together, and
//!   bodies that name the other in [`Body::meets`], as a screw names what it passes
//!   through, the rod its sleeve, and the strut the leg's crank that its spring pulls.
//! - [`Assembly::prove`] proves how close any two bodies come at any pose that the guard
//!   accepts; [`Assembly::nearest`] only checks some poses.
//! - [`Assembly::instead`] has bodies that may replace others: the kind of strut that
//!   robot.toml does not choose.
//! - [`Layout`] has pivots and anchors seen from above. Those of the legs are
//!   [`lizard_robot::LegPlan`], which the drawings use as well.

mod assembly;
mod bill;
mod body;
mod builder;
mod chassis;
mod clearance;
mod corner;
mod coupon;
mod dxf;
mod ends;
mod files;
mod fitting;
mod fittings;
mod guide;
mod html;
mod joints;
mod layout;
mod leads;
mod legend;
mod legs;
mod links;
mod looks;
mod mark;
mod mesh;
mod mjcf;
mod names;
mod outline;
mod papers;
mod part;
mod picture;
mod placement;
mod placements;
mod proof;
mod reach;
mod roof;
mod shape;
mod sheet;
mod sliders;
mod solid;
mod stack;
mod step;
mod steps;
mod stl;
mod struts;
mod svg;
mod unfit;
mod weight;

pub use assembly::Assembly;
pub use bill::{Bill, Hold, Item, STALL};
pub use body::{Body, Kind, Mount, Prism};
pub use clearance::Clearance;
pub use coupon::coupon;
pub use dxf::dxf;
pub use files::{File, part_files};
pub use fitting::Fitting;
pub use guide::{CORNER, guide};
pub use layout::Layout;
pub use mesh::Mesh;
pub use mjcf::{Course, Motor, Pieces, Pull, Scene, mjcf};
pub use outline::{Loop, Outline, Side};
pub use papers::papers;
pub use part::{Lies, Part};
pub use picture::{Drawn, Label, View, labelled, picture, whole};
pub use placement::Placement;
pub use placements::placements;
pub use proof::{Answer, Clash, ENOUGH, LEAST, Near, Proof, Questions};
pub use reach::{Act, Aside, Blocked, KEY, SOCKET};
pub use shape::Shape;
pub use sheet::{Layer, Sheet, extent, sheets};
pub use sliders::SliderLengths;
pub use solid::{Edge, Face, Solid, Surface};
pub use stack::{Span, Stack};
pub use step::step;
pub use steps::Near as NearView;
pub use steps::{Stage, Step, Where, steps};
pub use stl::stl;
pub use svg::sheet_svg;
pub use unfit::Unfit;
