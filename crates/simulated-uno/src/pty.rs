//! A pseudo terminal: a serial port of this machine without a cable, its other
//! end in this program.
//!
//! It differs from a serial port in three things. It has no DTR line, so this module
//! watches the file to notice that it is opened. The speed that a program sets changes
//! nothing by itself, but can be asked for. And what a program leaves unread would wait for the next program, while the
//! driver of a real port forgets it; so it is thrown away here.
//!
//! For that, this program opens the port itself for a moment. If another thread starts a
//! program at that moment, the new process has a copy of all open files until it calls
//! exec, and the port stays open as long as there is a copy. So this module waits until
//! the port is really closed.

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

/// The speed until a program sets another.
const BAUD: u32 = 115_200;
/// The longest time from the start of a program to its execution, on a busy machine.
const MOST_BEFORE_EXECUTION: Duration = Duration::from_secs(10);

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
    /// A program has closed it, and yet it is open: if another has opened it in the
    /// meantime, the system says so only at the next look.
    in_doubt: bool,
}

impl Pty {
    /// A new pseudo terminal that passes bytes on as they are.
    ///
    /// # Errors
    /// The system has none left, or no /dev/pts. Or [`ErrorKind::TimedOut`]: a program
    /// that was started meanwhile keeps it open.
    pub(crate) fn new() -> io::Result<Self> {
        let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        unlockpt(&ours)?;
        rustix::io::ioctl_fionbio(&ours, true)?;
        let name = ptsname(&ours, Vec::new())?;
        let path = PathBuf::from(name.to_string_lossy().into_owned());
        // Opened once and closed: only from then on does the system say that
        // nobody has it open. The settings outlive the closing.
        let theirs = other_end(&path, OFlags::RDWR)?;
        let mut settings = tcgetattr(&theirs)?;
        settings.make_raw();
        settings.set_speed(BAUD)?;
        tcsetattr(&theirs, OptionalActions::Now, &settings)?;
        drop(theirs);
        let ours = File::from(ours);
        // Nobody else knows its name yet.
        if !comes(|| Ok(!is_open(&ours)?))? {
            let words = "a program that was started meanwhile keeps the new port open";
            return Err(io::Error::new(ErrorKind::TimedOut, words));
        }
        let opens = inotify::init(CreateFlags::NONBLOCK | CreateFlags::CLOEXEC)?;
        let of_interest = WatchFlags::OPEN | WatchFlags::CLOSE;
        inotify::add_watch(&opens, &path, of_interest)?;
        Ok(Self {
            ours,
            opens,
            path,
            was_open: false,
            in_doubt: false,
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
        let was_open = self.was_open;
        let (mut closed, mut opened) = (!was_open || self.in_doubt, false);
        let mut closing = false;
        self.events(|event| {
            if event.contains(ReadFlags::OPEN) {
                opened |= closed;
            } else {
                closed = true;
                closing = true;
            }
        })?;
        let mut open = self.is_open()?;
        opened |= open && !was_open;
        // A program that closes it while another has it open changes nothing.
        if was_open && (opened || !open) {
            self.throw_away_unread()?;
            let now = self.is_open()?;
            opened |= now && !open;
            open = now;
        }
        self.was_open = open;
        self.in_doubt = closing && open && !opened;
        Ok(Look { open, opened })
    }

    /// Whether a program has it open at this moment.
    ///
    /// # Errors
    /// Only those of a system that is out of memory.
    pub(crate) fn is_open(&self) -> io::Result<bool> {
        is_open(&self.ours)
    }

    fn events(&self, mut tell: impl FnMut(ReadFlags)) -> io::Result<()> {
        let mut space = [MaybeUninit::uninit(); 512];
        let mut events = inotify::Reader::new(&self.opens, &mut space);
        loop {
            match events.next() {
                Ok(event) => tell(event.events()),
                Err(rustix::io::Errno::WOULDBLOCK) => return Ok(()),
                Err(error) => return Err(error.into()),
            }
        }
    }

    /// What the last program has not read is not for the next.
    fn throw_away_unread(&self) -> io::Result<()> {
        // It cannot be opened while a program has it for itself alone; then that
        // program has thrown away what it found.
        let Ok(theirs) = other_end(&self.path, OFlags::RDONLY) else {
            return self.events(|_anything| {});
        };
        tcflush(&theirs, QueueSelector::IFlush)?;
        drop(theirs);
        // How the port is closed tells a program that opens it to write from us. If it is open
        // in the end, another program has opened it.
        let mut closed = false;
        comes(|| {
            self.events(|event| closed |= event.contains(ReadFlags::CLOSE_NOWRITE))?;
            Ok(closed || !self.is_open()?)
        })?;
        self.events(|_rest| {})
    }

    /// The speed that a program has set last, in baud.
    ///
    /// # Errors
    /// Those of the system.
    pub(crate) fn baud(&self) -> io::Result<f64> {
        // Linux gives the settings of the other end. Speed 0 asks a modem to hang up.
        Ok(match tcgetattr(&self.ours)?.output_speed() {
            0 => f64::from(BAUD),
            baud => f64::from(baud),
        })
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

    /// Writes to the program that has it open; returns how many bytes found room.
    ///
    /// # Errors
    /// Those of the system.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        now(self.ours.write(bytes))
    }
}

fn is_open(ours: &File) -> io::Result<bool> {
    let mut fds = [PollFd::new(ours, PollFlags::IN)];
    poll(&mut fds, Some(&Timespec::default()))?;
    Ok(!fds[0].revents().contains(PollFlags::HUP))
}

/// Waits as long as a program may take to be executed. False if that is not enough.
fn comes(mut condition: impl FnMut() -> io::Result<bool>) -> io::Result<bool> {
    let end = Instant::now() + MOST_BEFORE_EXECUTION;
    while !condition()? {
        if Instant::now() > end {
            return Ok(false);
        }
        thread::sleep(Duration::from_micros(100));
    }
    Ok(true)
}

fn other_end(path: &Path, access: OFlags) -> rustix::io::Result<OwnedFd> {
    let flags = access | OFlags::NOCTTY | OFlags::CLOEXEC | OFlags::NONBLOCK;
    rustix::fs::open(path, flags, Mode::empty())
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
