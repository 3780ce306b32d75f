//! The model of a board, and the part of flash that is free for an image.
//!
//! An Arduino Nano has the UNO's chip and runs the UNO's firmware. But its boot section has 2 KB (Arduino's
//! boards.txt: high fuse 0xDA), while that of a UNO has 512 bytes, and the chip starts at the first byte of that
//! section. Code written into it would be started as if it were a boot loader, and only a programmer wired to the
//! pins could repair that. Boot loaders do not report the fuses. An old Nano is recognised by its baud rate; a newer
//! one answers like a UNO, and only its USB chip, if anything, distinguishes it.

use crate::image::{BOOT_ADDRESS, Image, NANO_BOOT_ADDRESS};
use crate::loader::LoaderKind;

/// A board's model, as named by the user.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Model {
    /// An Arduino UNO, or a copy of it
    Uno,
    /// An Arduino Nano, or a copy of it
    Nano,
}

/// The facts known about a board before its boot loader is contacted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Target {
    /// The model that the user has named.
    pub model: Option<Model>,
    /// True if the board has a USB chip that both UNOs and Nanos have.
    pub may_be_nano: bool,
}

/// The error for an image that reaches into the boot section of a Nano, or of a board that may be one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{} bytes of flash are needed, and a Nano has {NANO_BOOT_ADDRESS} before its boot section{}. \
         Nothing was written", .end_address, if *.is_in_doubt {
    "; this board may be one, because of its USB chip"
} else {
    ". Gaits can be left out of robot.toml until it fits"
})]
pub struct ImageTooLong {
    /// The address after the image's last byte.
    end_address: usize,
    /// True if the board may also be a UNO.
    is_in_doubt: bool,
}

impl ImageTooLong {
    /// True if the board may also be a UNO, which has room.
    pub fn is_in_doubt(self) -> bool {
        self.is_in_doubt
    }
}

impl Target {
    /// The boot loaders that the board may have, in the order in which they are tried.
    pub fn loaders(self) -> &'static [LoaderKind] {
        match self.model {
            Some(Model::Uno) => &[LoaderKind::Optiboot],
            Some(Model::Nano) | None => &[LoaderKind::Optiboot, LoaderKind::AtmegaBoot],
        }
    }

    /// Checks that an image does not reach into the boot section of a board whose loader of this kind has answered.
    ///
    /// # Errors
    /// Fails if the board has too little room, or may have too little.
    pub fn check_room(self, image: &Image, loader: LoaderKind) -> Result<(), ImageTooLong> {
        let is_nano = self.model == Some(Model::Nano) || loader == LoaderKind::AtmegaBoot;
        let is_in_doubt = !is_nano && self.model.is_none() && self.may_be_nano;
        let room = if is_nano || is_in_doubt {
            NANO_BOOT_ADDRESS
        } else {
            BOOT_ADDRESS
        };
        let end = image.end();
        if end > room {
            return Err(ImageTooLong {
                end_address: end,
                is_in_doubt,
            });
        }
        Ok(())
    }
}
