//! The terminal itself: whether it is still there, and leaving it for a while.

use std::io::{self, IsTerminal};
use std::sync::Once;
use std::thread;
use std::time::Duration;

/// True if the terminal still exists. A terminal that was closed would return keys forever.
#[must_use]
pub fn is_there() -> bool {
    io::stdin().is_terminal()
}

/// Interval between checks of the terminal, and the number of checks before the program is
/// ended.
const LOOK: Duration = Duration::from_millis(200);
const PATIENCE: u32 = 10;

/// Ends the program two seconds after its terminal has gone, if it has not ended by itself:
/// a terminal that goes at the very moment when a key is waited for is waited for without
/// end. Nothing is half written then: files are written whole.
pub fn end_when_gone() {
    let look = || {
        let mut gone = 0;
        while gone < PATIENCE {
            thread::sleep(LOOK);
            gone = if is_there() { 0 } else { gone + 1 };
        }
        std::process::exit(0)
    };
    static ONCE: Once = Once::new();
    // Without this thread the program is what it was.
    ONCE.call_once(|| drop(thread::Builder::new().spawn(look)));
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
