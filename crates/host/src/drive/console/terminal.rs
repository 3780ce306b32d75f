//! The terminal: detecting that it was closed, and suspending the program.

use std::io::{self, IsTerminal};
use std::sync::Once;
use std::thread;
use std::time::Duration;

/// True if the terminal still exists. Reading a closed terminal would return keys forever.
pub fn is_open() -> bool {
    io::stdin().is_terminal()
}

/// Interval between checks of the terminal.
const CHECK_INTERVAL: Duration = Duration::from_millis(200);
/// Number of consecutive checks without a terminal after which the program is ended.
const CHECKS: u32 = 10;

/// Ends the program two seconds after its terminal was closed, if it has not ended by itself: a wait for a key
/// never returns if the terminal is closed in the middle of it. A recorded session may lose its last poses then;
/// other files exist only once they are complete.
pub fn end_when_gone() {
    let check = || {
        let mut checks_gone = 0;
        while checks_gone < CHECKS {
            thread::sleep(CHECK_INTERVAL);
            checks_gone = if is_open() { 0 } else { checks_gone + 1 };
        }
        std::process::exit(0)
    };
    static ONCE: Once = Once::new();
    // The program also works without this thread.
    ONCE.call_once(|| drop(thread::Builder::new().spawn(check)));
}

/// Suspends this program until the shell resumes it, as Ctrl-Z does. The terminal must
/// have been restored before.
///
/// # Errors
/// Fails if the system refuses.
#[cfg(unix)]
pub fn stop() -> io::Result<()> {
    signal_hook::low_level::emulate_default_handler(signal_hook::consts::SIGTSTP)
}

/// Does nothing: only Unix can suspend a program.
///
/// # Errors
/// Never fails.
#[cfg(not(unix))]
pub fn stop() -> io::Result<()> {
    Ok(())
}
