//! The mark of the code in the first page of flash, by which it is known before it runs.

use lizard_core::numbers::mark::{LENGTH, Mark};

/// Nothing but the linker reads it: this section comes first after the interrupt vectors,
/// at [`lizard_core::numbers::mark::AT`], and a test looks for it there.
#[used]
#[unsafe(no_mangle)]
#[unsafe(link_section = ".progmem.gcc.mark")]
static MARK: [u8; LENGTH] = Mark::HERE.bytes();
