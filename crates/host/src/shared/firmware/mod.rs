//! The selection of a firmware and its robot.
//!
//! All lizards run the same code; the robot is a section of flash after the code. This program contains the code, so a
//! user needs only a robot.toml: `lizard flash`, `image`, `sim`, `twin`, `console --sim` and all other commands put
//! the section of the selected robot after the code. The program never searches for a build. Developers of the
//! firmware name their build with `--elf` for a simulation (as `make sim` does), or with `--image` for a board. Only
//! `lizard sim bench` always needs an ELF, because it finds the timed functions by their names.
//!
//! An ELF contains a robot. If this is not the selected robot, the ELF is refused: the user has made a mistake.

pub use lizard_upload::robot_label;

#[cfg(feature = "simulator")]
pub use simulated::{Firmware, ReadError, built_in_image, read_image, read_with_robot};

#[cfg(feature = "simulator")]
pub(crate) use simulated::{code_bytes, select_firmware, without_contacts};

#[cfg(feature = "simulator")]
mod simulated;

/// The code of the firmware in Intel HEX, up to the robot's section.
///
/// `make code-image` writes the file, and a test compares it with a build of the source.
pub const CODE_HEX: &str = include_str!("../../../../../firmware/code.hex");
