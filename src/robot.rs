//! The robot's section, which is after the code in flash.
//!
//! The code is the same for any robot. The robot's numbers are in a separate section
//! ([`lizard_core::numbers::section`]) at a fixed address, from which the program reads them. Therefore an upload can
//! replace the robot without the program.

use lizard_core::numbers::section::REGION_BYTES;

/// The section that the build script has made from robot.toml. No code refers to this static, which the linker places
/// at [`lizard_core::numbers::section::START_ADDRESS`].
#[used]
#[unsafe(no_mangle)]
#[unsafe(link_section = ".robot")]
static ROBOT: [u8; SECTION_BYTES] = *include_bytes!(concat!(env!("OUT_DIR"), "/robot.bin"));
const SECTION_BYTES: usize = include_bytes!(concat!(env!("OUT_DIR"), "/robot.bin")).len();

const _: () = assert!(SECTION_BYTES <= REGION_BYTES as usize);
