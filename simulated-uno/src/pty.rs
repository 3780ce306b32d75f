//! A pseudo terminal: a serial port of this machine without a cable, its other
//! end in this program.
//!
//! It is a serial port in all but three things. It has no DTR line, so who
//! wants to know of an opening has to watch the file. The speed that a program
//! sets has no effect. And what is written while nobody has it open waits for
//! the next who opens it, where a cable would lose it.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::mem::MaybeUninit;
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::inotify::{self, CreateFlags, ReadFlags, WatchFlags};
use rustix::fs::{Mode, OFlags};
use rustix::pty::{OpenptFlags, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

/// The speed that `stty` shows until somebody sets another.
const BAUD: u32 = 115_200;

/// What programs have done with the port since the last look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Look {
    /// A program has it open now.
    pub(crate) open: bool,
    /// It was opened, having been closed.
    pub(crate) opened: bool,
}

/// A pseudo terminal. It exists until this is dropped.
#[derive(Debug)]
pub(crate) struct Pty {
    ours: File,
    opens: OwnedFd,
    path: PathBuf,
    was_open: bool,
}

impl Pty {
    /// A new pseudo terminal that passes bytes on as they are.
    ///
    /// # Errors
    /// The system has none left, or no /dev/pts.
    pub(crate) fn new() -> io::Result<Self> {
        let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        unlockpt(&ours)?;
        rustix::io::ioctl_fionbio(&ours, true)?;
        let name = ptsname(&ours, Vec::new())?;
        let path = PathBuf::from(name.to_string_lossy().into_owned());
        // Opened once and closed: only from then on does the system say that
        // nobody has it open. The settings outlive the closing.
        let theirs = rustix::fs::open(
            &path,
            OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC,
            Mode::empty(),
        )?;
        let mut settings = tcgetattr(&theirs)?;
        settings.make_raw();
        settings.set_speed(BAUD)?;
        tcsetattr(&theirs, OptionalActions::Now, &settings)?;
        drop(theirs);
        let opens = inotify::init(CreateFlags::NONBLOCK | CreateFlags::CLOEXEC)?;
        let of_interest = WatchFlags::OPEN | WatchFlags::CLOSE;
        inotify::add_watch(&opens, &path, of_interest)?;
        Ok(Self {
            ours: File::from(ours),
            opens,
            path,
            was_open: false,
        })
    }

    /// The file that other programs open, such as /dev/pts/3.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// What has happened since the last look. An opening is seen however short
    /// it was, or the pause before it.
    ///
    /// # Errors
    /// Only those of a system that is out of memory.
    pub(crate) fn look(&mut self) -> io::Result<Look> {
        let mut closed = !self.was_open;
        let mut opened = false;
        let mut space = [MaybeUninit::uninit(); 512];
        let mut events = inotify::Reader::new(&self.opens, &mut space);
        loop {
            match events.next() {
                Ok(event) if event.events().contains(ReadFlags::OPEN) => opened |= closed,
                Ok(_) => closed = true,
                Err(rustix::io::Errno::WOULDBLOCK) => break,
                Err(error) => return Err(error.into()),
            }
        }
        let mut fds = [PollFd::new(&self.ours, PollFlags::IN)];
        poll(&mut fds, Some(&Timespec::default()))?;
        let open = !fds[0].revents().contains(PollFlags::HUP);
        self.was_open = open;
        Ok(Look { open, opened })
    }

    /// Reads what programs have written, 0 bytes if there is nothing.
    ///
    /// # Errors
    /// Those of the system.
    pub(crate) fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        match self.ours.read(into) {
            // EIO: nobody has it open and nothing is left to read.
            Err(error) if error.raw_os_error() == Some(EIO) => Ok(0),
            other => now(other),
        }
    }

    /// Writes for whoever has it open; returns how many bytes found room.
    ///
    /// # Errors
    /// Those of the system.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        now(self.ours.write(bytes))
    }
}

const EIO: i32 = rustix::io::Errno::IO.raw_os_error();

/// Nothing can be done just now: 0 bytes.
fn now(done: io::Result<usize>) -> io::Result<usize> {
    match done {
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {
            Ok(0)
        }
        other => other,
    }
}
