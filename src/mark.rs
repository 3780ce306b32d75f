//! The mark in the first page of flash, with which a host identifies the firmware without running it.

use lizard_core::numbers::mark::{LENGTH, Mark};

/// The mark, which no code of the firmware reads. The linker places it directly after the interrupt vectors, at
/// [`lizard_core::numbers::mark::ADDRESS`]; a test checks this.
#[used]
#[unsafe(no_mangle)]
#[unsafe(link_section = ".progmem.gcc.mark")]
static MARK: [u8; LENGTH] = Mark::THIS_FIRMWARE.bytes();
