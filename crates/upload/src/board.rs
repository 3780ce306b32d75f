//! The serial line to a board.

use std::time::Duration;

/// A connection to a board. Times are those of the board: a simulated one may run slower or faster than this machine.
pub trait Board {
    /// Resets the chip, which starts its boot loader, and sets the baud rate of the line.
    ///
    /// # Errors
    /// Fails if the connection is gone.
    fn reset(&mut self, baud: u32) -> impl Future<Output = Result<(), BoardError>>;

    /// Sends bytes.
    ///
    /// # Errors
    /// Fails if the bytes cannot be sent, or the connection is gone.
    fn write(&mut self, bytes: &[u8]) -> impl Future<Output = Result<(), BoardError>>;

    /// Fills `bytes`, and reads no more, because further bytes may be for another reader. Returns the number of bytes
    /// that have arrived within the time limit.
    ///
    /// # Errors
    /// Fails if the connection is gone.
    fn read(
        &mut self,
        bytes: &mut [u8],
        time_limit: Duration,
    ) -> impl Future<Output = Result<usize, BoardError>>;

    /// Discards all bytes received within the next `duration`.
    ///
    /// # Errors
    /// Fails if the connection is gone.
    fn discard(&mut self, duration: Duration) -> impl Future<Output = Result<(), BoardError>>;
}

/// The reason why a connection failed.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// Bytes could not be sent in time.
    #[error("the board takes no bytes")]
    Busy,
    /// The port has vanished.
    #[error("the port is gone: the board was unplugged, or its cable is loose")]
    Gone,
    /// Any other error.
    #[error("{0}")]
    Other(String),
}
