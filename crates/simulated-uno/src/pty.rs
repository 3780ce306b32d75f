//! A pseudo terminal: a serial port of this machine without a cable. Another program opens the port, and this program
//! reads and writes at the other end.
//!
//! A pseudo terminal differs from a serial port in three ways. It has no DTR line, so this module watches the port's
//! file to detect that a program opens it. The baud rate that a program sets has no effect, but can be read. Bytes that
//! a program leaves unread would wait for the next program, while the driver of a real port discards them; this module
//! therefore discards unread bytes.
//!
//! To discard unread bytes, this module opens the port itself for a moment. If another thread starts a program at
//! that moment, the new process has a copy of all open files until it calls exec, and the port stays open as long as
//! a copy exists. This module therefore waits until all copies are closed.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::mem::MaybeUninit;
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::inotify::{self, CreateFlags, ReadFlags, WatchFlags};
use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;
use rustix::pty::{OpenptFlags, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, QueueSelector, tcflush, tcgetattr, tcsetattr};

use crate::serial::MAX_BAUD;

/// The baud rate until a program sets another one.
const DEFAULT_BAUD: u32 = 115_200;
/// The longest time between fork and exec of a new process on a busy machine.
const MAX_EXEC_DELAY: Duration = Duration::from_secs(10);

/// A pseudo terminal. It exists until this value is dropped.
#[derive(Debug)]
pub(crate) struct Pty {
    /// This program's end of the pseudo terminal.
    our_end: File,
    /// The inotify instance that reports each opening and closing of the port.
    event_queue: OwnedFd,
    /// The port: the end that other programs open.
    path: PathBuf,
    /// True if a program had the port open at the last check.
    pub(crate) is_open: bool,
    /// True if a program had closed the port at the last check, but the port was open again: the system may report the
    /// new opening as late as at the next check.
    may_be_reopened: bool,
}

impl Pty {
    /// Creates a pseudo terminal that passes bytes on unchanged.
    ///
    /// # Errors
    /// Fails if the system has no pseudo terminals left, or no /dev/pts. Fails with [`ErrorKind::TimedOut`] if a
    /// program that was started meanwhile keeps the port open.
    pub(crate) fn new() -> io::Result<Self> {
        let our_end = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        unlockpt(&our_end)?;
        rustix::io::ioctl_fionbio(&our_end, true)?;
        let name = ptsname(&our_end, Vec::new())?;
        let path = PathBuf::from(name.to_string_lossy().into_owned());
        // The system reports that no program has the port open only after the port was opened and closed once. The
        // settings persist after the closing.
        let other_end = open_other_end(&path, OFlags::RDWR)?;
        let mut settings = tcgetattr(&other_end)?;
        settings.make_raw();
        settings.set_speed(DEFAULT_BAUD)?;
        tcsetattr(&other_end, OptionalActions::Now, &settings)?;
        drop(other_end);
        let our_end = File::from(our_end);
        // No other program has received the port's name yet.
        if !wait_until(|| Ok(!is_port_open(&our_end)?))? {
            let message = "a program that was started at the same time keeps the new port open";
            return Err(io::Error::new(ErrorKind::TimedOut, message));
        }
        let event_queue = inotify::init(CreateFlags::NONBLOCK | CreateFlags::CLOEXEC)?;
        let watched_events = WatchFlags::OPEN | WatchFlags::CLOSE;
        inotify::add_watch(&event_queue, &path, watched_events)?;
        Ok(Self {
            our_end,
            event_queue,
            path,
            is_open: false,
            may_be_reopened: false,
        })
    }

    /// The file that other programs open, such as /dev/pts/3.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Checks the port. Returns true if it has been opened after it was closed. Detects every opening, however short
    /// the opening or the pause before it, except one that begins and ends within a call that discards unread bytes.
    ///
    /// # Errors
    /// Fails if the system is out of memory.
    pub(crate) fn poll_opening(&mut self) -> io::Result<bool> {
        let was_open = self.is_open;
        let (mut was_closed, mut was_opened) = (!was_open || self.may_be_reopened, false);
        let mut has_close_event = false;
        self.read_events(|event| {
            if event.contains(ReadFlags::OPEN) {
                was_opened |= was_closed;
            } else {
                was_closed = true;
                has_close_event = true;
            }
        })?;
        let mut is_open = self.is_open_now()?;
        was_opened |= is_open && !was_open;
        // Unread bytes are discarded only if all programs have closed the port.
        if was_open && (was_opened || !is_open) {
            self.discard_unread()?;
            let is_open_after_discard = self.is_open_now()?;
            was_opened |= is_open_after_discard && !is_open;
            is_open = is_open_after_discard;
        }
        self.is_open = is_open;
        self.may_be_reopened = has_close_event && is_open && !was_opened;
        Ok(was_opened)
    }

    /// True if a program has the port open at this moment.
    ///
    /// # Errors
    /// Fails if the system is out of memory.
    pub(crate) fn is_open_now(&self) -> io::Result<bool> {
        is_port_open(&self.our_end)
    }

    /// Calls `on_event` with each opening and closing of the port since the last call.
    fn read_events(&self, mut on_event: impl FnMut(ReadFlags)) -> io::Result<()> {
        let mut buffer = [MaybeUninit::uninit(); 512];
        let mut events = inotify::Reader::new(&self.event_queue, &mut buffer);
        loop {
            match events.next() {
                Ok(event) => on_event(event.events()),
                Err(Errno::WOULDBLOCK) => return Ok(()),
                Err(error) => return Err(error.into()),
            }
        }
    }

    /// Discards the bytes that the last program has not read, so that the next program does not get them.
    fn discard_unread(&self) -> io::Result<()> {
        // While a program has exclusive use of the port, the port cannot be opened. Such a program has itself discarded
        // the bytes that it found.
        let Ok(other_end) = open_other_end(&self.path, OFlags::RDONLY) else {
            return self.read_events(|_anything| {});
        };
        tcflush(&other_end, QueueSelector::IFlush)?;
        drop(other_end);
        // A port that was opened only for reading closes with CLOSE_NOWRITE, unlike the port of a program that also
        // writes. If the port is open at the end, a program has opened it.
        let mut was_closed = false;
        wait_until(|| {
            self.read_events(|event| was_closed |= event.contains(ReadFlags::CLOSE_NOWRITE))?;
            Ok(was_closed || !self.is_open_now()?)
        })?;
        self.read_events(|_rest| {})
    }

    /// Returns the baud rate that the last program has set, at most [`MAX_BAUD`].
    ///
    /// # Errors
    /// Returns the system's error if the pseudo terminal fails.
    pub(crate) fn baud(&self) -> io::Result<f64> {
        // Linux returns the settings that programs have made at the port. Speed 0 means "hang up".
        Ok(match tcgetattr(&self.our_end)?.output_speed() {
            0 => f64::from(DEFAULT_BAUD),
            // A program may set a higher rate.
            baud => f64::from(baud).min(MAX_BAUD),
        })
    }

    /// Reads bytes that programs have written. Returns their number, 0 if there are none.
    ///
    /// # Errors
    /// Returns the system's error if the pseudo terminal fails.
    pub(crate) fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self.our_end.read(buffer) {
            // EIO: no program has the port open, and nothing is left to read.
            Err(error) if error.raw_os_error() == Some(Errno::IO.raw_os_error()) => Ok(0),
            result => bytes_or_zero(result),
        }
    }

    /// Writes to the program that has the port open. Returns the number of bytes accepted.
    ///
    /// # Errors
    /// Returns the system's error if the pseudo terminal fails.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        bytes_or_zero(self.our_end.write(bytes))
    }
}

/// True if a program has the port open at this moment.
fn is_port_open(our_end: &File) -> io::Result<bool> {
    let mut fds = [PollFd::new(our_end, PollFlags::IN)];
    poll(&mut fds, Some(&Timespec::default()))?;
    Ok(!fds[0].revents().contains(PollFlags::HUP))
}

/// Waits until a condition holds, at most [`MAX_EXEC_DELAY`]. Returns false if the condition does not hold by then.
fn wait_until(mut condition: impl FnMut() -> io::Result<bool>) -> io::Result<bool> {
    let end = Instant::now() + MAX_EXEC_DELAY;
    while !condition()? {
        if Instant::now() > end {
            return Ok(false);
        }
        thread::sleep(Duration::from_micros(100));
    }
    Ok(true)
}

/// Opens the port as another program does.
fn open_other_end(path: &Path, access: OFlags) -> rustix::io::Result<OwnedFd> {
    let flags = access | OFlags::NOCTTY | OFlags::CLOEXEC | OFlags::NONBLOCK;
    rustix::fs::open(path, flags, Mode::empty())
}

/// Converts the result of a transfer to a number of bytes; 0 if no transfer is possible at the moment.
fn bytes_or_zero(transfer: io::Result<usize>) -> io::Result<usize> {
    match transfer {
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {
            Ok(0)
        }
        result => result,
    }
}
