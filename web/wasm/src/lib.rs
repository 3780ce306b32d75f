//! The robot for the page: all that the browser has to know of a lizard, and no formula
//! of its own.
//!
//! The page gives the text of a robot.toml and then, fifty times a second, four pulse
//! widths, as the pins of an UNO have them. It gets back where every joint is, how far
//! each singularity, whether the guard would have sent this pose, and where the body is on
//! the floor. [`Page`] holds all of that; `abi` is the door to JavaScript, and the
//! one place with `unsafe` attributes.

mod abi;
mod core_run;
mod description;
mod drawn;
mod edit;
#[cfg(feature = "tune")]
mod faster;
mod floor;
mod map;
mod page;
#[cfg(test)]
mod paper;
mod place;
mod refused;
mod room;
mod scene;
mod trial;

pub use core_run::{CoreRun, Said};
pub use description::{
    Description, GaitEntry, LinkEntry, MarginEntry, ModelEntry, Outlook, ServoEntry, Way,
};
pub use drawn::Drawn;
pub use edit::{NoSuchLength, with_number};
#[cfg(feature = "tune")]
pub use faster::{Begun, Faster, Found, Progress, Wish};
pub use floor::{Floor, Legs};
pub use map::{Curve, Map, MapPoint};
pub use page::{Edited, Frame, Page};
pub use place::Place;
pub use refused::Refused;
pub use room::Room;
pub use scene::{LegScene, Margin, Scene, SliderScene, Spot};
pub use trial::{Bars, Instead, NoTrial, Trial};
