//! Waits with a time limit, for tests. Without a limit, a test that waits for another program, a port or a thread could
//! hang forever, and with it the whole test run. Here every wait has a limit, after which the test fails with a message
//! that names the missing event.
//!
//! The limit does not measure speed: a machine may be busy, and only a test that hangs should fail. All waits use the
//! same limit, [`TIME_LIMIT`]. Do not use it outside tests or to assert that something is fast.
//!
//! ```
//! use lizard_time_limit::TIME_LIMIT;
//! let (sender, receiver) = std::sync::mpsc::channel();
//! std::thread::spawn(move || sender.send(5));
//! let number = TIME_LIMIT.run("a number from the other thread", move || receiver.recv());
//! assert_eq!(number, Ok(5));
//! ```

use std::fmt;
use std::io::{self, ErrorKind, Read, Write};
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

/// The time from one check of a condition to the next.
const POLL_INTERVAL: Duration = Duration::from_millis(1);

/// The limit for all tests, much longer than any successful wait on a busy machine.
pub const TIME_LIMIT: TimeLimit = TimeLimit::new(Duration::from_secs(300));

/// The longest time that a test waits for an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TimeLimit(Duration);

impl fmt::Display for TimeLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

impl TimeLimit {
    /// Creates another limit. Only this crate's tests need one.
    pub const fn new(time: Duration) -> Self {
        Self(time)
    }

    /// Waits until a condition holds. Returns false if the condition does not hold within the limit. Use this if a test
    /// needs a longer message than that of [`TimeLimit::wait_for`].
    pub fn poll(self, mut condition: impl FnMut() -> bool) -> bool {
        let deadline = Instant::now() + self.0;
        while !condition() {
            if Instant::now() > deadline {
                return false;
            }
            thread::sleep(POLL_INTERVAL);
        }
        true
    }

    /// Waits until a condition holds.
    ///
    /// # Panics
    /// If the condition does not hold within the limit. The message is `waited 300s for`, followed by `event`.
    #[track_caller]
    pub fn wait_for(self, event: &str, condition: impl FnMut() -> bool) {
        assert!(self.poll(condition), "waited {self} for {event}");
    }

    /// Runs a task that may block, such as a read or a join, and returns its result. The task runs on a separate
    /// thread, which continues after the call if the limit is reached first.
    ///
    /// # Panics
    /// If the task panics. If the task does not return within the limit, with the message of [`TimeLimit::wait_for`].
    #[track_caller]
    pub fn run<T: Send + 'static>(
        self,
        event: &str,
        task: impl FnOnce() -> T + Send + 'static,
    ) -> T {
        let (sender, receiver) = mpsc::channel();
        let worker = thread::spawn(move || {
            // There is no receiver if the limit was reached first.
            let _ = sender.send(task());
        });
        match receiver.recv_timeout(self.0) {
            Ok(result) => result,
            Err(RecvTimeoutError::Timeout) => panic!("waited {self} for {event}"),
            Err(RecvTimeoutError::Disconnected) => match worker.join() {
                Err(panic) => std::panic::resume_unwind(panic),
                Ok(()) => unreachable!("a worker that returns has sent its result"),
            },
        }
    }

    /// Waits until a program exits and returns its status. If the program's output is piped, another thread must read
    /// the output.
    ///
    /// # Errors
    /// Returns the system's error. Returns [`ErrorKind::TimedOut`] with a message if the program does not exit
    /// within the limit; the program is then killed.
    pub fn wait_for_exit(self, child: &mut Child) -> io::Result<ExitStatus> {
        let mut wait_result = Ok(None);
        self.poll(|| {
            wait_result = child.try_wait();
            !matches!(wait_result, Ok(None))
        });
        if let Some(status) = wait_result? {
            return Ok(status);
        }
        child.kill()?;
        child.wait()?;
        let message = format!("waited {self} for the end of process {}", child.id());
        Err(io::Error::new(ErrorKind::TimedOut, message))
    }

    /// Runs a program with `input` on its standard input, and returns its output.
    ///
    /// # Errors
    /// Fails if the program cannot be started. Returns [`ErrorKind::TimedOut`] with a message if the program does not
    /// exit within the limit, or if a process that the program has started keeps the output open for that long.
    pub fn run_command(self, command: &mut Command, input: &[u8]) -> io::Result<Output> {
        let name = command.get_program().to_string_lossy().into_owned();
        let timeout_error = |process: &str| {
            let message = format!("waited {self} for the end of {process}`{name}`");
            io::Error::new(ErrorKind::TimedOut, message)
        };
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()?;
        if let Some(mut stdin) = child.stdin.take() {
            let input = input.to_vec();
            // A failed write is not an error: the program may ignore its input or reject its arguments.
            thread::spawn(move || stdin.write_all(&input));
        }
        let readers = [
            child.stdout.take().map(read_all),
            child.stderr.take().map(read_all),
        ];
        let status = self.wait_for_exit(&mut child);
        let status = status.map_err(|error| match error.kind() {
            ErrorKind::TimedOut => timeout_error(""),
            _ => error,
        })?;
        let mut outputs = Vec::new();
        for receiver in readers.into_iter().flatten() {
            let received = receiver.recv_timeout(self.0);
            outputs.push(received.map_err(|_| timeout_error("a process started by "))??);
        }
        let stderr = outputs.pop().unwrap_or_default();
        let stdout = outputs.pop().unwrap_or_default();
        Ok(Output {
            status,
            stdout,
            stderr,
        })
    }
}

/// Reads a pipe to its end on a separate thread, since a full pipe would block its program.
fn read_all(mut pipe: impl Read + Send + 'static) -> mpsc::Receiver<io::Result<Vec<u8>>> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let mut contents = Vec::new();
        sender.send(pipe.read_to_end(&mut contents).map(|_| contents))
    });
    receiver
}
