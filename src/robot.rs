//! The robot's section, which lies after the code in flash.
//!
//! The code is the same for any robot. The robot's numbers are a separate section
//! ([`lizard_core::numbers::section`]) at a fixed address. The program reads the robot from there,
//! so that an upload can replace the robot and leave the program as it is.

use lizard_core::numbers::section::SPACE_BYTES;

/// The section that the build script has made from robot.toml. No code refers to it; the
/// linker places it at [`lizard_core::numbers::section::START_ADDRESS`].
#[used]
#[unsafe(no_mangle)]
#[unsafe(link_section = ".robot")]
static ROBOT: [u8; SECTION_BYTES] = *include_bytes!(concat!(env!("OUT_DIR"), "/robot.bin"));
const SECTION_BYTES: usize = include_bytes!(concat!(env!("OUT_DIR"), "/robot.bin")).len();

const _: () = assert!(SECTION_BYTES <= SPACE_BYTES as usize);
