//! Detects a closed terminal and the signal SIGTERM, and suspends the program.

use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, Once};
use std::thread;
use std::time::Duration;

/// True once SIGTERM has arrived. Without a handler, the signal would leave the terminal in raw mode.
static IS_TERMINATED: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| {
    let flag = Arc::new(AtomicBool::new(false));
    // If the handler cannot be registered, SIGTERM still ends the program.
    #[cfg(unix)]
    let _ = signal_hook::flag::register(signal_hook::consts::SIGTERM, Arc::clone(&flag));
    flag
});

/// True if the terminal still exists, and no SIGTERM has arrived. A closed terminal would return keys forever.
pub fn is_open() -> bool {
    io::stdin().is_terminal() && !IS_TERMINATED.load(Ordering::Relaxed)
}

/// Interval between checks of the terminal.
const CHECK_INTERVAL: Duration = Duration::from_millis(200);
/// Number of consecutive checks without a terminal after which the program exits.
const MAX_CLOSED_CHECKS: u32 = 10;

/// Starts a thread that ends the program two seconds after its terminal was closed or SIGTERM arrived, because a wait
/// for a key never returns if the terminal is closed during the wait. A recorded session may then lose its last poses;
/// other files exist only once they are complete.
pub fn exit_when_closed() {
    LazyLock::force(&IS_TERMINATED);
    let watch_terminal = || {
        let mut closed_check_count = 0;
        while closed_check_count < MAX_CLOSED_CHECKS {
            thread::sleep(CHECK_INTERVAL);
            closed_check_count = if is_open() { 0 } else { closed_check_count + 1 };
        }
        let _ = crossterm::terminal::disable_raw_mode();
        std::process::exit(0)
    };
    static ONCE: Once = Once::new();
    // The program also works without this thread.
    ONCE.call_once(|| drop(thread::Builder::new().spawn(watch_terminal)));
}

/// Suspends this program until the shell resumes it, as Ctrl-Z does. The terminal must be restored first.
///
/// # Errors
/// Fails if the operating system refuses.
#[cfg(unix)]
pub fn suspend_program() -> io::Result<()> {
    signal_hook::low_level::emulate_default_handler(signal_hook::consts::SIGTSTP)
}

/// Does nothing: only Unix can suspend a program.
///
/// # Errors
/// Never fails.
#[cfg(not(unix))]
pub fn suspend_program() -> io::Result<()> {
    Ok(())
}
