//! A board's model, and the flash that it leaves free for an image.
//!
//! An Arduino Nano has the UNO's chip and runs the UNO's firmware. However, its boot section is 2 KB long (high fuse
//! 0xDA in Arduino's boards.txt) instead of 512 bytes, and the chip starts at the first byte of the boot section. Code
//! written there would be started as a boot loader, and only a programmer wired to the pins could repair the board.
//! Boot loaders do not report the fuses. An old Nano is recognised by its baud rate; a newer Nano answers like a UNO,
//! and only its USB chip may distinguish it.

use crate::image::{BOOT_ADDRESS, Image, NANO_BOOT_ADDRESS};
use crate::loader::LoaderKind;

/// A board's model, chosen by the user.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Model {
    /// An Arduino UNO or a clone
    Uno,
    /// An Arduino Nano or a clone
    Nano,
}

/// The facts known about a board before its boot loader is contacted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Target {
    /// The model that the user has chosen.
    pub model: Option<Model>,
    /// True if the board's USB chip is used on both UNOs and Nanos.
    pub may_be_nano: bool,
}

/// The error for an image that reaches into the boot section of a Nano, or of a board that may be one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{} bytes of flash are needed, but a Nano has only {NANO_BOOT_ADDRESS} before its boot section{}. \
         Nothing was written", .end_address, if *.is_model_uncertain {
    "; the USB chip of this board is used on both UNOs and Nanos"
} else {
    ". Remove gaits from robot.toml until the image fits"
})]
pub struct ImageTooLong {
    /// The address after the image's last byte.
    end_address: usize,
    /// True if the board may also be a UNO, which has enough room.
    pub is_model_uncertain: bool,
}

impl Target {
    /// The kinds of boot loader that the board may have, in the order of the attempts.
    pub fn loader_kinds(self) -> &'static [LoaderKind] {
        match self.model {
            Some(Model::Uno) => &[LoaderKind::Optiboot],
            Some(Model::Nano) | None => &[LoaderKind::Optiboot, LoaderKind::AtmegaBoot],
        }
    }

    /// Checks that an image does not reach into the boot section of the board, given the kind of its boot loader.
    ///
    /// # Errors
    /// Fails if the board has too little room, or may have too little room.
    pub fn check_room(self, image: &Image, kind: LoaderKind) -> Result<(), ImageTooLong> {
        let is_nano = self.model == Some(Model::Nano) || kind == LoaderKind::AtmegaBoot;
        let is_model_uncertain = !is_nano && self.model.is_none() && self.may_be_nano;
        let room = if is_nano || is_model_uncertain {
            NANO_BOOT_ADDRESS
        } else {
            BOOT_ADDRESS
        };
        let end_address = image.end_address();
        if end_address > room {
            return Err(ImageTooLong {
                end_address,
                is_model_uncertain,
            });
        }
        Ok(())
    }
}
