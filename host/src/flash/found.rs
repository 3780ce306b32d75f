//! What a board has in flash before it is written.
//!
//! Writing destroys it, and a user may have taken the wrong board: so it is said.

use std::fmt;

use super::image::{BLANK, Image};

/// What was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// Nothing: as a chip is sold.
    Blank,
    /// The image.
    Same,
    /// Something else.
    OtherProgram {
        /// Up to its last byte.
        bytes: usize,
    },
}

impl Found {
    /// What `flash`, from address 0 to the boot loader, holds in comparison with an image.
    #[must_use]
    pub fn in_flash(flash: &[u8], image: &Image) -> Self {
        if image
            .pages()
            .iter()
            .all(|page| flash[page.range()] == page.bytes)
        {
            return Self::Same;
        }
        match flash.iter().rposition(|&byte| byte != BLANK) {
            None => Self::Blank,
            Some(last) => Self::OtherProgram { bytes: last + 1 },
        }
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Blank => f.write_str("the board has no program"),
            Self::Same => f.write_str("the board has this firmware already"),
            Self::OtherProgram { bytes } => {
                write!(f, "the board has another program, of {bytes} bytes")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flash::image::BOOT;

    #[test]
    fn flash_is_blank_or_has_the_same_or_another_program() {
        let image = Image::new(vec![1, 2, 3]).expect("it fits");
        let found = |changes: &[(usize, u8)]| {
            let mut flash = vec![0xff; BOOT];
            for (address, byte) in changes {
                flash[*address] = *byte;
            }
            Found::in_flash(&flash, &image).to_string()
        };
        assert_eq!(found(&[]), "the board has no program");
        assert_eq!(
            found(&[(0, 1), (1, 2), (2, 3)]),
            "the board has this firmware already"
        );
        assert_eq!(
            found(&[(0, 1), (1, 2), (2, 4)]),
            "the board has another program, of 3 bytes"
        );
        assert_eq!(
            found(&[(0, 1), (0x1fff, 7)]),
            "the board has another program, of 8192 bytes"
        );
    }
}
