//! The serial connection to a board.

use std::time::Duration;

/// A connection to a board. Times are measured on the board: the clock of a simulated board may be slower or faster
/// than this machine's.
pub trait Board {
    /// Resets the chip, which starts the boot loader, and sets the baud rate.
    ///
    /// # Errors
    /// Fails if the connection is lost.
    fn reset(&mut self, baud: u32) -> impl Future<Output = Result<(), BoardError>>;

    /// Sends bytes.
    ///
    /// # Errors
    /// Fails if the bytes cannot be sent, or the connection is lost.
    fn write(&mut self, bytes: &[u8]) -> impl Future<Output = Result<(), BoardError>>;

    /// Reads until `buffer` is full or the time limit has passed; returns the number of bytes read. Takes no more bytes
    /// from the connection than fit into `buffer`, since the rest may be for another reader.
    ///
    /// # Errors
    /// Fails if the connection is lost.
    fn read(
        &mut self,
        buffer: &mut [u8],
        time_limit: Duration,
    ) -> impl Future<Output = Result<usize, BoardError>>;

    /// Discards all bytes that arrive within the next `duration`.
    ///
    /// # Errors
    /// Fails if the connection is lost.
    fn discard(&mut self, duration: Duration) -> impl Future<Output = Result<(), BoardError>>;
}

/// The reason why a connection failed.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// Bytes could not be sent in time.
    #[error("the board accepts no bytes")]
    Busy,
    /// The port has disappeared.
    #[error("the port is gone: the board was unplugged, or its cable is loose")]
    Gone,
    /// Any other error.
    #[error("{0}")]
    Other(String),
}
