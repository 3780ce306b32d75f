//! The choice of a firmware and its robot.
//!
//! The firmware is one image for any lizard: its robot is a section of flash after the code. The code is inside
//! this program, so a robot.toml is all that a user needs: `lizard flash`, `image`, `sim`, `twin`, `console --sim`
//! and all other commands put the section of the selected robot after that code. A build in some folder is never
//! used implicitly. Developers of the firmware name their build: with `--elf` for a simulation, as `make sim` does,
//! or with `--image` for a board. Only `lizard sim bench` always needs an ELF, because it finds the functions that
//! it times by their names.
//!
//! An ELF contains a robot. If that is not the selected robot, one of the two is a mistake, and the ELF is refused.

pub use lizard_upload::robot_label;

#[cfg(feature = "simulator")]
pub use simulated::{Firmware, Unreadable, image_with, read, with_robot};

#[cfg(feature = "simulator")]
pub(crate) use simulated::{code_bytes, select_firmware, without_contacts};

#[cfg(feature = "simulator")]
mod simulated;

/// The code of the firmware in Intel HEX, up to the robot's section.
///
/// `make code-image` writes the file, and a test compares it with a build of the source.
pub const CODE: &str = include_str!("../../../../../firmware/code.hex");
