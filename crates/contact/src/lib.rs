//! The contact model: the motion of a body whose feet are never lifted.
//!
//! Four pads, one at each foot, stand on the floor. When the legs swing, not all pads can stay in place, and friction
//! decides which of them slide. The body moves so that friction dissipates as little power as possible. Finding this
//! displacement is a small convex problem: `ground_contact.rs` has the formula, `friction.rs` the solution. The loads
//! of the feet (`stance.rs`) and the lag of each leg behind its servo (`drive.rs`) are part of the same problem. A pad
//! of any shape counts as a point: a leg moves its pad without turning it and the body does not tilt, so even a domed
//! pad always touches the floor with the same point of its surface.
//!
//! A [`GroundContact`] is one robot on one floor. [`GroundContact::predict`] predicts the displacement for a series of
//! sweeps, as far as friction determines it; a [`Walker`] follows the sweeps step by step. `lizard-robot` predicts each
//! gait of a robot.toml with this crate, and `lizard-twin` follows the pulses of a board with it. The crate itself
//! reads no file.
//!
//! # When not to use it
//! No leg lifts its foot, and no foot tilts. Everything is quasi-static, so speed has no effect, except in
//! [`Walker::run_motors`], which models motors and inertia. For a robot that lifts its feet or moves very fast, use a
//! physics engine.
//!
//! ```
//! use lizard_contact::{Body, DEFAULT_FRICTION, Drive, GroundContact, LegGeometry, Stance};
//!
//! let ground = GroundContact {
//!     legs: LegGeometry { hip_forward: 55.0, hip_side: [35.0; 2], mount_angle: 0.0, reach: 45.0 },
//!     body: Body::DEFAULT,
//!     stance: Stance::LEVEL,
//!     friction_coefficient: DEFAULT_FRICTION,
//!     friction_ratio: 1.0,
//!     drive: Drive::RIGID,
//! };
//! // All four feet swing from 20 degrees forward to 20 degrees back. The pads hold, and the body moves forward by
//! // the chord of the feet's arcs.
//! let prediction = ground.predict([[20.0; 4], [-20.0; 4]]);
//! let chord = 2.0 * 45.0 * 20f64.to_radians().sin();
//! assert!(prediction.forward.is_some_and(|forward| (forward - chord).abs() < 1e-3));
//! ```
//!
//! # Units
//! Lengths in mm, forces in N, torques in N mm, sweeps of the legs in deg (foot forward positive). Points are (forward,
//! left), from the chassis centre or on the floor. Every array of four is in servo order: front left, front right, hind
//! right, hind left (LF, RF, RH, LH).

mod body_pose;
mod drive;
mod friction;
mod ground_contact;
mod joints;
mod lag_energy;
mod leg_geometry;
mod legs;
mod linear;
mod motor;
mod motor_step;
mod prediction;
mod stance;
mod strut;
mod travel;
mod walker;

pub use body_pose::BodyPose;
pub use drive::{Drive, DriveKind};
pub use friction::Point;
pub use ground_contact::{DEFAULT_FRICTION, GroundContact};
pub use joints::JointFriction;
pub use leg_geometry::{Body, GRAVITY, LegGeometry};
pub use legs::{FORWARD_TURN_SIGN, FRONT_SIGN, LEFT_SIGN};
pub use motor::{Motor, Motors};
pub use prediction::Prediction;
pub use stance::Stance;
pub use strut::{SLOT_LENGTH, Strut};
pub use travel::Travel;
pub use walker::{Contacts, Walker};

/// Asserts that a value differs from the expected one by less than `max_error`.
#[cfg(test)]
#[track_caller]
fn assert_near(value: f64, expected: f64, max_error: f64) {
    let is_near = (value - expected).abs() < max_error;
    assert!(is_near, "expected {expected}, got {value}");
}
