//! The destination of printed text: any infallible `ufmt` writer.

use core::convert::Infallible;

use ufmt::uWrite;

/// A destination of text: a serial port, or a string on a host. Writing cannot fail, because a serial port waits until
/// its buffer has room.
pub trait Output {
    /// Writes an ASCII character.
    fn write_byte(&mut self, byte: u8);
}

impl<W: uWrite<Error = Infallible>> Output for W {
    #[inline(always)]
    fn write_byte(&mut self, byte: u8) {
        let Ok(()) = self.write_char(char::from(byte));
    }
}
