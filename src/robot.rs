//! The robot's section, which lies after the code in flash.
//!
//! The code is the same for any lizard. The robot is a separate section
//! ([`lizard_core::numbers::section`]) at a fixed address. The program reads the robot from there,
//! so that an upload can replace the robot without the program.

use lizard_core::numbers::section::SPACE;

/// The section of robot.toml, which the build script has made. No code refers to it; the
/// linker places it at [`lizard_core::numbers::section::START`].
#[used]
#[unsafe(no_mangle)]
#[unsafe(link_section = ".robot")]
static ROBOT: [u8; LENGTH] = *include_bytes!(concat!(env!("OUT_DIR"), "/robot.bin"));
const LENGTH: usize = include_bytes!(concat!(env!("OUT_DIR"), "/robot.bin")).len();

const _: () = assert!(LENGTH <= SPACE as usize);
