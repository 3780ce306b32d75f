//! The terminal itself: whether it is still there, and leaving it for a while.

use std::io::{self, IsTerminal};

/// Whether the terminal is still there. One that was closed is none, and its keys
/// would be read for ever.
#[must_use]
pub fn is_there() -> bool {
    io::stdin().is_terminal()
}

/// Stops this program until the shell lets it go on, as Ctrl-Z does. The terminal has to
/// be as it was found.
///
/// # Errors
/// The system refuses.
#[cfg(unix)]
pub fn stop() -> io::Result<()> {
    signal_hook::low_level::emulate_default_handler(signal_hook::consts::SIGTSTP)
}

/// Nothing: this system has no such thing.
///
/// # Errors
/// None.
#[cfg(not(unix))]
pub fn stop() -> io::Result<()> {
    Ok(())
}
