//! A board as it is sold: a boot loader in the last part of flash, which the chip starts after
//! a reset, and a program that the boot loader received over the serial line.

use crate::ffi;
use crate::{FLASH_SIZE, Fidelity, Image, Uno};

impl Uno {
    /// A board with nothing in its flash but a boot loader, at the moment of
    /// power-on. The boot reset vector (fuse BOOTRST) is the loader's first
    /// byte.
    #[must_use]
    pub fn with_boot_loader(loader: Image, fidelity: Fidelity) -> Self {
        let start = loader.code_start();
        let uno = Self::with_image(loader, fidelity);
        // SAFETY: `raw` is valid and ours alone, see `Uno`; `Image` has checked that its code,
        // and so its start, is inside flash.
        unsafe { ffi::uno_boot_at(uno.raw, start) }
        uno
    }

    /// The contents of all of flash, the boot loader included. A byte never written is 0xff.
    #[must_use]
    pub fn flash(&self) -> &[u8] {
        // SAFETY: `raw` is valid, see `Uno`. The chip has `FLASH_SIZE` bytes of flash, which
        // live as long as `self` and do not change while it is borrowed.
        unsafe { std::slice::from_raw_parts(ffi::uno_flash(self.raw), FLASH_SIZE as usize) }
    }

    /// Changes bytes of flash without the program's doing, as worn-out cells do.
    ///
    /// # Panics
    /// If they do not fit into flash.
    pub fn set_flash(&mut self, address: u16, bytes: &[u8]) {
        let start = usize::from(address);
        // SAFETY: as in `flash`, and `self` is borrowed nowhere else.
        let flash = unsafe {
            std::slice::from_raw_parts_mut(ffi::uno_flash(self.raw), FLASH_SIZE as usize)
        };
        flash[start..start + bytes.len()].copy_from_slice(bytes);
    }

    /// Clears the record of received bytes, [`Uno::received_by_uno`], which
    /// would grow for as long as the UNO runs.
    pub(crate) fn forget_received(&mut self) {
        self.clear(ffi::uno_received);
    }
}
