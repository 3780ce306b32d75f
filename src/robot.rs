//! The robot: whatever lies behind the code in flash.
//!
//! This is the one image for any lizard. Its robot is a section of its own
//! ([`lizard_core::numbers::section`]) at a fixed address, and this program reads it from there
//! whatever it was built with: another one can be written over it.

use lizard_core::numbers::section::SPACE;

/// The section of robot.toml, which the build script has made. Nothing but the linker
/// reads it: it puts it at [`lizard_core::numbers::section::START`].
#[used]
#[unsafe(no_mangle)]
#[unsafe(link_section = ".robot")]
static ROBOT: [u8; LENGTH] = *include_bytes!(concat!(env!("OUT_DIR"), "/robot.bin"));
const LENGTH: usize = include_bytes!(concat!(env!("OUT_DIR"), "/robot.bin")).len();

const _: () = assert!(LENGTH <= SPACE as usize);
