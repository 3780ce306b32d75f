//! The calibration of a robot over its console: what each step asks of the robot, and in which order.
//!
//! A servo turns either way for a longer pulse, by more or less than its data sheet says, and its horn sits on the tooth
//! that was nearest. So a person looks at the robot while one servo alone turns, and tells what is seen; [`Guide`] has
//! the movements and the settings that follow from the answers. Nothing is stored before [`Guide::save`], and
//! [`Guide::restore`] returns to what was stored.
//!
//! The crate knows no port, no screen and no clock: a [`Console`] is a connection of this machine or of a browser. Its
//! functions are `async`, since a browser cannot wait; where a console blocks, any executor will do.
//!
//! # When not to use it
//! To send one setting: a line of the console does that. To decide what a servo needs: that is what a person sees.
#![deny(unsafe_code)]
#![warn(clippy::missing_errors_doc)]

mod console;
mod exchange;
mod guide;
mod still;

pub use console::{BadReply, Console, ConsoleError, Reply, command};
pub use exchange::{SendError, read, replace, send};
pub use guide::{Guide, SCALE_TURNS, SIGN_TURNS};
