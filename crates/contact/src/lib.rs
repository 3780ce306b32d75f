//! The contact model: the movement of a body whose feet are never lifted.
//!
//! Four pads stand on the floor and every one of them drags. When the legs swing, not all pads can hold, and
//! friction decides which of them slide. The body makes the movement that loses the least power to friction,
//! which is a small convex problem: the formula is in `ground.rs`, its solution in `friction.rs`. The shares of
//! the weight (`stance.rs`) and the lag of a leg behind its servo (`drive.rs`) are part of the same problem. A
//! pad is a point, whatever its shape: a leg moves its pad without turning it and the body does not tilt, so
//! even a domed pad always touches the floor at one and the same point.
//!
//! [`Ground`] is one robot on one floor. [`Ground::predict`] predicts the movement for a series of
//! sweeps, as far as it can be known; a [`Walker`] follows the sweeps step by step.
//! `lizard-robot` predicts each gait of a robot.toml with it, and `lizard-twin` follows the pulses
//! of a board. The crate reads no file and knows no gait.
//!
//! # When not to use it
//! Feet neither lift nor tilt, and only [`Walker::drive`] has motors and inertia: everywhere else speed changes
//! nothing. For a robot that lifts its feet, or moves so fast that its mass decides where it goes, use a
//! physics engine.
//!
//! ```
//! use lizard_contact::{Body, DEFAULT_FRICTION, Drive, Feet, Ground, Stance};
//!
//! let ground = Ground {
//!     feet: Feet { hip_forward: 55.0, hip_side: [35.0; 2], mount: 0.0, reach: 45.0 },
//!     body: Body::DEFAULT,
//!     stance: Stance::LEVEL,
//!     friction: DEFAULT_FRICTION,
//!     ratio: 1.0,
//!     drive: Drive::RIGID,
//! };
//! // All four feet swing back from 20 degrees ahead to 20 degrees behind: they hold, and
//! // the body goes ahead by their chord.
//! let prediction = ground.predict([[20.0; 4], [-20.0; 4]]);
//! let chord = 2.0 * 45.0 * 20f64.to_radians().sin();
//! assert!(prediction.forward.is_some_and(|forward| (forward - chord).abs() < 1e-3));
//! ```
//!
//! # Units
//! mm, N, deg of a leg's sweep (foot forward positive), N mm of torque. Points are
//! (forward, left), from the chassis centre or on the floor. Every array is in servo
//! order: the legs LF, RF, RH, LH.

mod drive;
mod feet;
mod friction;
mod ground;
mod joints;
mod lag_energy;
mod legs;
mod linear;
mod motor;
mod motor_step;
mod place;
mod prediction;
mod stance;
mod strut;
mod travel;
mod walker;

pub use drive::{Drive, DriveKind};
pub use feet::{Body, Feet, GRAVITY};
pub use friction::Point;
pub use ground::{DEFAULT_FRICTION, Ground};
pub use joints::Joints;
pub use legs::{FORWARD, FRONT, LEFT};
pub use motor::{Motor, Motors};
pub use place::Place;
pub use stance::Stance;
pub use strut::{SLOT, Strut};
pub use travel::{Prediction, Travel};
pub use walker::{Slip, Walker};
