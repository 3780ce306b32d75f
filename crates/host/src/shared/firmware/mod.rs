//! Selection of the firmware and its robot.
//!
//! All lizards run the same code; the robot is a section of flash after the code. This program contains the code, so a
//! user needs only a robot.toml: `lizard flash`, `sim`, `twin`, `console --sim` and all other commands put the selected
//! robot's section after the code. The program never searches for a build. Firmware developers select their build with
//! `--elf` for a simulation (as `make sim` does), or with `--image` for a board. Only `lizard sim bench` always needs
//! an ELF, because it finds the timed functions by their names.
//!
//! An ELF contains a robot. An ELF with another robot than the selected one is refused as a user's mistake.

pub use lizard_upload::format_robot_label;

#[cfg(feature = "simulator")]
pub use simulated::{Firmware, ReadError, built_in_image, read_image, read_with_robot};

#[cfg(feature = "simulator")]
pub(crate) use simulated::{count_code_bytes, select_firmware, without_contacts};

#[cfg(feature = "simulator")]
mod simulated;

/// The firmware's code in Intel HEX, up to the robot's section.
///
/// `make code-image` writes the file, and a test compares the file with a build from source.
pub const CODE_HEX: &str = include_str!("../../../../../firmware/code.hex");
