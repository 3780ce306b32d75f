//! The mark in the first page of flash, by which a host identifies the code without running it.

use lizard_core::numbers::mark::{LENGTH, Mark};

/// The mark. No code of the firmware reads it. The linker places it directly after the interrupt vectors, at
/// [`lizard_core::numbers::mark::ADDRESS`], and a test looks for it there.
#[used]
#[unsafe(no_mangle)]
#[unsafe(link_section = ".progmem.gcc.mark")]
static MARK: [u8; LENGTH] = Mark::THIS_FIRMWARE.bytes();
