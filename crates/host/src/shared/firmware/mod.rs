//! Selection of the firmware and its robot.
//!
//! All robots run the same code. A section of flash after the code describes the robot. This program contains the
//! code, so a user needs only a robot.toml: `lizard flash`, `sim`, `twin`, `console --sim` and all other commands
//! append the selected robot's section to the code. They never search for compiled firmware. Firmware developers select
//! their build with `--elf` for a simulation (as `make sim` does), or with `--image` for a board. Only
//! `lizard sim bench` always needs an ELF, because it finds the functions to measure by their symbols.
//!
//! An ELF already contains a robot. If this is not the selected robot, the ELF is refused, because the user probably
//! chose the wrong file.

pub use lizard_upload::format_robot_label;

#[cfg(feature = "simulator")]
pub use simulated::{Firmware, built_in_image, read_image, read_with_robot};

#[cfg(feature = "simulator")]
pub(crate) use simulated::{
    check_robot, count_code_bytes, describe_load_error, remove_contacts, select_firmware,
};

#[cfg(feature = "simulator")]
mod simulated;

/// The firmware's code in Intel HEX, up to the robot's section.
///
/// `make code-image` writes the file, and a test compares the file with a build from source.
pub const CODE_HEX: &str = include_str!("../../../../../firmware/code.hex");
