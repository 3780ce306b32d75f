//! The place that text is written to.

/// A serial line, or a string on a host. Writing cannot fail: a serial line waits.
pub trait Output {
    /// Writes a character, of which the robot prints ASCII only.
    fn byte(&mut self, byte: u8);
}

#[cfg(any(test, feature = "host"))]
impl Output for std::string::String {
    fn byte(&mut self, byte: u8) {
        self.push(char::from(byte));
    }
}
