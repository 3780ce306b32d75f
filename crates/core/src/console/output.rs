//! The destination of printed text: any `ufmt` writer that cannot fail.

use core::convert::Infallible;

use ufmt::uWrite;

/// A destination of text: a serial line, or a string on a host. Writing cannot fail: a serial line waits for room
/// in its buffer.
pub trait Output {
    /// Writes an ASCII character.
    fn byte(&mut self, byte: u8);
}

impl<W: uWrite<Error = Infallible>> Output for W {
    #[inline(always)]
    fn byte(&mut self, byte: u8) {
        let Ok(()) = self.write_char(char::from(byte));
    }
}
