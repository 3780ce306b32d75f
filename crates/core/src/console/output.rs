//! The place that text is written to: any writer of `ufmt` that cannot fail.

use core::convert::Infallible;

use ufmt::uWrite;

/// A serial line, or a string on a host. Writing cannot fail: a serial line waits.
pub trait Output {
    /// Writes a character, of which the robot prints ASCII only.
    fn byte(&mut self, byte: u8);
}

impl<W: uWrite<Error = Infallible>> Output for W {
    #[inline(always)]
    fn byte(&mut self, byte: u8) {
        let Ok(()) = self.write_char(char::from(byte));
    }
}
