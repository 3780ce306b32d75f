//! A board as it is sold, with a boot loader in the last bytes of flash. The chip starts the boot loader after a
//! reset, and the boot loader receives the program over the serial line.

use crate::ffi;
use crate::{FLASH_SIZE, Fidelity, Image, Uno};

impl Uno {
    /// Returns a board with only a boot loader in its flash, at the moment of power-on. Every reset starts the chip at
    /// the boot loader's first byte, as if the fuse BOOTRST were programmed.
    #[must_use]
    pub fn with_boot_loader(loader: Image, fidelity: Fidelity) -> Self {
        let start = loader.code_start();
        let uno = Self::with_image(loader, fidelity);
        // SAFETY: `raw` is valid, and `uno` owns it exclusively (see `Uno`); `Image` has checked that its code is
        // inside flash.
        unsafe { ffi::uno_set_boot_address(uno.raw, start) }
        uno
    }

    /// The contents of all of flash, including the boot loader. A byte that was never written is 0xff.
    #[must_use]
    pub fn flash(&self) -> &[u8] {
        // SAFETY: `raw` is valid (see `Uno`). The chip has `FLASH_SIZE` bytes of flash, which
        // live as long as `self` and do not change while it is borrowed.
        unsafe { std::slice::from_raw_parts(ffi::uno_flash(self.raw), FLASH_SIZE as usize) }
    }

    /// Overwrites bytes in flash from outside the program, for example to imitate worn-out memory cells.
    ///
    /// # Panics
    /// If the bytes do not fit into flash.
    pub fn write_flash(&mut self, address: u16, bytes: &[u8]) {
        let start = usize::from(address);
        // SAFETY: as in `flash`, and `self` is borrowed nowhere else.
        let flash = unsafe {
            std::slice::from_raw_parts_mut(ffi::uno_flash(self.raw), FLASH_SIZE as usize)
        };
        flash[start..start + bytes.len()].copy_from_slice(bytes);
    }
}
