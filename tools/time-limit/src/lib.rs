//! Waits with a time limit. A test that waits for another program, a port or a thread
//! would never end if that never comes, and the whole run with it. Here every wait
//! has a limit, after which the test fails and says what it has waited for.
//!
//! The limit does not measure speed: a machine may be busy, and only a test that hangs
//! should fail. All waits use one limit, [`LIMIT`].
//!
//! ```
//! use lizard_time_limit::LIMIT;
//! let (send, receive) = std::sync::mpsc::channel();
//! std::thread::spawn(move || send.send(5));
//! let five = LIMIT.within("a number of the other thread", move || receive.recv());
//! assert_eq!(five, Ok(5));
//! ```

use std::fmt;
use std::io::{self, ErrorKind, Read, Write};
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

/// The period at which a condition is checked.
const LOOK: Duration = Duration::from_millis(1);

/// The limit of all tests: much longer than anything takes on a busy machine.
pub const LIMIT: TimeLimit = TimeLimit::new(Duration::from_secs(300));

/// The longest time that a test waits for one thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TimeLimit(Duration);

impl fmt::Display for TimeLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

impl TimeLimit {
    /// A limit of its own, for a test of waits.
    #[must_use]
    pub const fn new(time: Duration) -> Self {
        Self(time)
    }

    /// Asks until the answer is yes, or until the limit: then false. For a test that
    /// has more to say than [`TimeLimit::until`].
    pub fn comes(self, mut condition: impl FnMut() -> bool) -> bool {
        let end = Instant::now() + self.0;
        loop {
            if condition() {
                return true;
            }
            if Instant::now() > end {
                return false;
            }
            thread::sleep(LOOK);
        }
    }

    /// Waits until the condition holds.
    ///
    /// # Panics
    /// It does not within the limit; `what` completes `waited 300s for`.
    #[track_caller]
    pub fn until(self, what: &str, condition: impl FnMut() -> bool) {
        assert!(self.comes(condition), "waited {self} for {what}");
    }

    /// Returns the result of `work`, which may block: a read, a join. It runs on a thread of its
    /// own, which continues until the test program ends if the limit comes first.
    ///
    /// # Panics
    /// It does not return within the limit, see [`TimeLimit::until`]; or it panics.
    #[track_caller]
    pub fn within<T: Send + 'static>(
        self,
        what: &str,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> T {
        let (done, result) = mpsc::channel();
        let worker = thread::spawn(move || {
            // Nobody listens any more if the limit has come first.
            let _ = done.send(work());
        });
        match result.recv_timeout(self.0) {
            Ok(result) => result,
            Err(RecvTimeoutError::Timeout) => panic!("waited {self} for {what}"),
            Err(RecvTimeoutError::Disconnected) => match worker.join() {
                Err(panic) => std::panic::resume_unwind(panic),
                Ok(()) => unreachable!("a worker that returns has sent"),
            },
        }
    }

    /// Waits for the end of a program. Its output, if it is piped, must be read elsewhere.
    ///
    /// # Errors
    /// Those of the system; [`ErrorKind::TimedOut`] with a sentence if it does not end
    /// within the limit. Then it has been killed.
    pub fn end_of(self, child: &mut Child) -> io::Result<ExitStatus> {
        let mut ended = Ok(None);
        self.comes(|| {
            ended = child.try_wait();
            !matches!(ended, Ok(None))
        });
        if let Some(status) = ended? {
            return Ok(status);
        }
        child.kill()?;
        child.wait()?;
        let sentence = format!("waited {self} for the end of process {}", child.id());
        Err(io::Error::new(ErrorKind::TimedOut, sentence))
    }

    /// Runs a program with this on its standard input, and returns what it prints.
    ///
    /// # Errors
    /// It cannot be started; [`ErrorKind::TimedOut`] with a sentence if it, or one that
    /// it has started and that may print, runs beyond the limit.
    pub fn output(self, command: &mut Command, input: &[u8]) -> io::Result<Output> {
        let name = command.get_program().to_string_lossy().into_owned();
        let too_long = |what: &str| {
            let sentence = format!("waited {self} for the end of {what}`{name}`");
            io::Error::new(ErrorKind::TimedOut, sentence)
        };
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()?;
        if let Some(mut stdin) = child.stdin.take() {
            let input = input.to_vec();
            // A program that needs no input, or refuses its arguments, closes its end.
            thread::spawn(move || stdin.write_all(&input));
        }
        let printed = [
            child.stdout.take().map(all_of),
            child.stderr.take().map(all_of),
        ];
        let status = self
            .end_of(&mut child)
            .map_err(|error| match error.kind() {
                ErrorKind::TimedOut => too_long(""),
                _ => error,
            })?;
        let mut read = Vec::new();
        for bytes in printed.into_iter().flatten() {
            let left = bytes.recv_timeout(self.0);
            read.push(left.map_err(|_| too_long("what was started by "))??);
        }
        let stderr = read.pop().unwrap_or_default();
        let stdout = read.pop().unwrap_or_default();
        Ok(Output {
            status,
            stdout,
            stderr,
        })
    }
}

/// Reads a pipe to its end, on a thread of its own: a full pipe would hold its program.
fn all_of(mut pipe: impl Read + Send + 'static) -> mpsc::Receiver<io::Result<Vec<u8>>> {
    let (done, bytes) = mpsc::channel();
    thread::spawn(move || {
        let mut all = Vec::new();
        let result = pipe.read_to_end(&mut all);
        done.send(result.map(|_| all))
    });
    bytes
}
