//! A pseudo terminal: a serial port of this machine without a cable. Another program opens the port, and this program
//! reads and writes at the other side.
//!
//! A pseudo terminal differs from a serial port in three ways. It has no DTR line, so this module watches the port's
//! file to notice that a program opens it. The baud rate that a program sets has no effect, but can be read. And
//! bytes that a program leaves unread would wait for the next program, while the driver of a real port discards
//! them; so this module discards unread bytes.
//!
//! To discard unread bytes, this module opens the port itself for a moment. If another thread starts a program at
//! that moment, the new process has a copy of all open files until it calls exec, and the port stays open as long as
//! a copy exists. So this module waits until the port is really closed.

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
use rustix::pty::{OpenptFlags, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, QueueSelector, tcflush, tcgetattr, tcsetattr};

/// The baud rate until a program sets another one.
const DEFAULT_BAUD: u32 = 115_200;
/// The longest time from the fork to the exec of a new process, on a busy machine.
const MAX_START_TIME: Duration = Duration::from_secs(10);

/// The port's state, and its changes since the last check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Look {
    /// True while a program has the port open.
    pub(crate) is_open: bool,
    /// True if the port has been opened after it was closed.
    pub(crate) was_opened: bool,
}

/// A pseudo terminal. It exists until this value is dropped.
#[derive(Debug)]
pub(crate) struct Pty {
    ours: File,
    open_events: OwnedFd,
    path: PathBuf,
    /// True if the port was open at the last check.
    was_open: bool,
    /// True if a program has closed the port but the port is still open. The system may report a new opening only
    /// at the next check.
    may_be_reopened: bool,
}

impl Pty {
    /// Makes a new pseudo terminal that passes bytes on unchanged.
    ///
    /// # Errors
    /// Fails if the system has no pseudo terminals left, or no /dev/pts. Fails with [`ErrorKind::TimedOut`] if a
    /// program that was started meanwhile keeps the port open.
    pub(crate) fn new() -> io::Result<Self> {
        let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        unlockpt(&ours)?;
        rustix::io::ioctl_fionbio(&ours, true)?;
        let name = ptsname(&ours, Vec::new())?;
        let path = PathBuf::from(name.to_string_lossy().into_owned());
        // The system reports that no program has the port open only after it was opened and closed once. The
        // settings persist after the closing.
        let theirs = open_other_end(&path, OFlags::RDWR)?;
        let mut settings = tcgetattr(&theirs)?;
        settings.make_raw();
        settings.set_speed(DEFAULT_BAUD)?;
        tcsetattr(&theirs, OptionalActions::Now, &settings)?;
        drop(theirs);
        let ours = File::from(ours);
        // No other program knows the port's name yet.
        if !wait_until(|| Ok(!is_open(&ours)?))? {
            let message = "a program that was started meanwhile keeps the new port open";
            return Err(io::Error::new(ErrorKind::TimedOut, message));
        }
        let open_events = inotify::init(CreateFlags::NONBLOCK | CreateFlags::CLOEXEC)?;
        let watched_events = WatchFlags::OPEN | WatchFlags::CLOSE;
        inotify::add_watch(&open_events, &path, watched_events)?;
        Ok(Self {
            ours,
            open_events,
            path,
            was_open: false,
            may_be_reopened: false,
        })
    }

    /// The file that other programs open, such as /dev/pts/3.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Checks the port. Notices every opening, however short, and however short the pause before it.
    ///
    /// # Errors
    /// Fails if the system is out of memory.
    pub(crate) fn poll_state(&mut self) -> io::Result<Look> {
        let was_open = self.was_open;
        let (mut was_closed, mut was_opened) = (!was_open || self.may_be_reopened, false);
        let mut has_close_event = false;
        self.events(|event| {
            if event.contains(ReadFlags::OPEN) {
                was_opened |= was_closed;
            } else {
                was_closed = true;
                has_close_event = true;
            }
        })?;
        let mut is_port_open = self.is_open()?;
        was_opened |= is_port_open && !was_open;
        // Unread bytes are discarded only if all programs have closed the port, not if another still has it open.
        if was_open && (was_opened || !is_port_open) {
            self.drop_unread()?;
            let is_port_still_open = self.is_open()?;
            was_opened |= is_port_still_open && !is_port_open;
            is_port_open = is_port_still_open;
        }
        self.was_open = is_port_open;
        self.may_be_reopened = has_close_event && is_port_open && !was_opened;
        Ok(Look {
            is_open: is_port_open,
            was_opened,
        })
    }

    /// True if a program has the port open at this moment.
    ///
    /// # Errors
    /// Fails if the system is out of memory.
    pub(crate) fn is_open(&self) -> io::Result<bool> {
        is_open(&self.ours)
    }

    fn events(&self, mut on_event: impl FnMut(ReadFlags)) -> io::Result<()> {
        let mut buffer = [MaybeUninit::uninit(); 512];
        let mut events = inotify::Reader::new(&self.open_events, &mut buffer);
        loop {
            match events.next() {
                Ok(event) => on_event(event.events()),
                Err(rustix::io::Errno::WOULDBLOCK) => return Ok(()),
                Err(error) => return Err(error.into()),
            }
        }
    }

    /// Discards the bytes that the last program has not read, so that the next program does not get them.
    fn drop_unread(&self) -> io::Result<()> {
        // The port cannot be opened while a program has exclusive use of it. Such a program has itself discarded
        // the bytes that it found.
        let Ok(theirs) = open_other_end(&self.path, OFlags::RDONLY) else {
            return self.events(|_anything| {});
        };
        tcflush(&theirs, QueueSelector::IFlush)?;
        drop(theirs);
        // A port that was opened only for reading closes without CLOSE_WRITE, which distinguishes this opening from
        // a program's. If the port is open at the end, a program has opened it.
        let mut was_closed = false;
        wait_until(|| {
            self.events(|event| was_closed |= event.contains(ReadFlags::CLOSE_NOWRITE))?;
            Ok(was_closed || !self.is_open()?)
        })?;
        self.events(|_rest| {})
    }

    /// The baud rate that a program has set last.
    ///
    /// # Errors
    /// Returns the system's error if the pseudo terminal fails.
    pub(crate) fn baud(&self) -> io::Result<f64> {
        // Linux returns the settings that programs have made at the port. Speed 0 means "hang up".
        Ok(match tcgetattr(&self.ours)?.output_speed() {
            0 => f64::from(DEFAULT_BAUD),
            baud => f64::from(baud),
        })
    }

    /// Reads bytes that programs have written. Returns their number, 0 if there are none.
    ///
    /// # Errors
    /// Returns the system's error if the pseudo terminal fails.
    pub(crate) fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self.ours.read(buffer) {
            // EIO: no program has the port open, and nothing is left to read.
            Err(error) if error.raw_os_error() == Some(EIO) => Ok(0),
            result => bytes_or_zero(result),
        }
    }

    /// Writes to the program that has the port open. Returns the number of bytes accepted.
    ///
    /// # Errors
    /// Returns the system's error if the pseudo terminal fails.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        bytes_or_zero(self.ours.write(bytes))
    }
}

fn is_open(ours: &File) -> io::Result<bool> {
    let mut fds = [PollFd::new(ours, PollFlags::IN)];
    poll(&mut fds, Some(&Timespec::default()))?;
    Ok(!fds[0].revents().contains(PollFlags::HUP))
}

/// Waits until a condition holds, at most [`MAX_START_TIME`]. Returns false if the condition does not hold by then.
fn wait_until(mut condition: impl FnMut() -> io::Result<bool>) -> io::Result<bool> {
    let end = Instant::now() + MAX_START_TIME;
    while !condition()? {
        if Instant::now() > end {
            return Ok(false);
        }
        thread::sleep(Duration::from_micros(100));
    }
    Ok(true)
}

fn open_other_end(path: &Path, access: OFlags) -> rustix::io::Result<OwnedFd> {
    let flags = access | OFlags::NOCTTY | OFlags::CLOEXEC | OFlags::NONBLOCK;
    rustix::fs::open(path, flags, Mode::empty())
}

const EIO: i32 = rustix::io::Errno::IO.raw_os_error();

/// Converts the result of a transfer to a number of bytes, which is 0 if no transfer is possible at the moment.
fn bytes_or_zero(transfer: io::Result<usize>) -> io::Result<usize> {
    match transfer {
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {
            Ok(0)
        }
        result => result,
    }
}
