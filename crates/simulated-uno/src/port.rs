//! A serial port with a simulated UNO, which other programs can use in real time like a board on USB.
//!
//! avrdude, a terminal program or a host tool expects a chip that runs in real time. Here the chip's time follows
//! real time, and bytes go through a pseudo terminal such as /dev/pts/3. Opening the pseudo terminal resets the chip,
//! as the DTR line of a USB cable does on a UNO.
//!
//! The line has the baud rate that a program sets at the port, or 115200 until then. If this rate differs from the
//! chip's baud rate, each side reads bytes that the other side has not sent.
//!
//! As with a cable on Linux, a second opening resets the chip only if all programs had closed the port. Unlike
//! with a cable, toggling DTR while the port is open has no effect: programs that try it get `Inappropriate ioctl for
//! device`.
//!
//! ```no_run
//! use std::time::Duration;
//! use simulated_uno::{Fidelity, Port, Uno};
//! let mut uno = Uno::load("firmware.elf", Fidelity::DataSheet)?;
//! let mut port = Port::new()?;
//! println!("a UNO is at {}", port.path().display());
//! port.serve(&mut uno, Duration::from_secs(60))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`Port::in_background`] serves the port on a thread of its own.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::pty::Pty;
use crate::{FREQUENCY, Radio, State, Uno, ffi};

/// The time between two updates of the port and the chip, the same as in the UNO's USB chip.
const UPDATE_PERIOD: Duration = Duration::from_millis(1);
/// The most simulated time by which the chip catches up after a delay of this program. With more, the chip's watchdog
/// could expire before the program at the port has run.
const MAX_CATCH_UP: Duration = Duration::from_millis(20);
/// The largest number of bytes on their way to the chip. Further bytes wait in the pseudo terminal, as in the driver of
/// a USB port.
const MAX_UNSENT_BYTES: usize = 128;
/// The largest number of bytes that are kept for a program that does not read. Later bytes are lost.
const MAX_UNREAD_BYTES: usize = 1 << 16;

/// A serial port of this machine with a simulated UNO behind it. The port exists until this value is dropped.
#[derive(Debug)]
pub struct Port {
    pty: Pty,
    /// The chip's bytes that wait for room in the pseudo terminal.
    unread_bytes: Vec<u8>,
    /// The radio module between the port and the chip; `None` for a cable.
    radio: Option<Radio>,
    /// An instant of the wall clock and the chip's cycle at that instant, from which the chip's time is computed;
    /// `None` until the chip runs.
    anchor: Option<(Instant, u64)>,
}

impl Port {
    /// Creates a port that no program has open.
    ///
    /// # Errors
    /// Fails if the system has no pseudo terminals left. Fails with [`io::ErrorKind::TimedOut`] if a program that was
    /// started at the same time keeps the port open.
    pub fn new() -> io::Result<Self> {
        Ok(Self {
            pty: Pty::new()?,
            unread_bytes: Vec::new(),
            radio: None,
            anchor: None,
        })
    }

    /// Puts a radio module between the port and the chip. Opening the port then does not reset the chip, and the module
    /// sets the baud rate.
    #[must_use]
    pub fn with_radio(mut self, radio: Radio) -> Self {
        self.radio = Some(radio);
        self
    }

    /// The file that other programs open, such as /dev/pts/3.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.pty.path()
    }

    /// True if a program had the port open at the last check.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.pty.is_open
    }

    /// Runs `uno` in real time for `duration` of the wall clock, and passes bytes between `uno` and the program that
    /// has the port open. A chip that has halted or crashed does nothing until the next opening of the port resets it.
    ///
    /// The caller should regularly take the edges ([`Uno::take_edges`]): four servos produce 6400 bytes of edges per
    /// second. The bytes of the serial line are not kept.
    ///
    /// # Errors
    /// Returns the system's error if the pseudo terminal fails.
    pub fn serve(&mut self, uno: &mut Uno, duration: Duration) -> io::Result<()> {
        let end = Instant::now() + duration;
        while Instant::now() < end {
            self.update(uno)?;
            thread::sleep(UPDATE_PERIOD);
        }
        Ok(())
    }

    /// Serves the port on its own thread until [`BackgroundPort::stop`]. Calls `watch` with the UNO every millisecond;
    /// `watch` should take the UNO's edges, and must not block.
    ///
    /// # Errors
    /// Fails if the system cannot start a thread.
    pub fn in_background(
        mut self,
        mut uno: Uno,
        mut watch: impl FnMut(&mut Uno) + Send + 'static,
    ) -> io::Result<BackgroundPort> {
        let path = self.path().to_owned();
        let stop_requested = Arc::new(AtomicBool::new(false));
        let thread_stop_requested = Arc::clone(&stop_requested);
        let serve = move || {
            while !thread_stop_requested.load(Ordering::Relaxed) {
                self.update(&mut uno)?;
                watch(&mut uno);
                thread::sleep(UPDATE_PERIOD);
            }
            Ok(uno)
        };
        let name = "simulated UNO".to_owned();
        let thread = thread::Builder::new().name(name).spawn(serve)?;
        Ok(BackgroundPort {
            path,
            stop_requested,
            thread,
        })
    }

    /// Passes bytes in both directions and lets the chip catch up with the wall clock. Must be called every
    /// [`UPDATE_PERIOD`].
    fn update(&mut self, uno: &mut Uno) -> io::Result<()> {
        if self.pty.poll_opening()? {
            self.unread_bytes.clear();
            if self.radio.is_none() {
                uno.take_transmitted();
                uno.reset();
            }
        }
        let baud = match &self.radio {
            Some(radio) => radio.baud(),
            None => self.pty.baud()?,
        };
        uno.set_baud(baud);
        let room = MAX_UNSENT_BYTES.saturating_sub(uno.unsent_byte_count());
        let mut bytes = [0; MAX_UNSENT_BYTES];
        let read_count = self.pty.read(&mut bytes[..room])?;
        match &mut self.radio {
            Some(radio) => radio.write(&bytes[..read_count], uno.cycle()),
            None => uno.send(&bytes[..read_count]),
        }
        if *uno.state() == State::Alive {
            uno.run_until_cycle(self.update_target_cycle(uno.cycle()));
        }
        // This record would grow as long as the UNO runs.
        uno.clear_items(ffi::uno_received);
        let arrived_bytes = match &mut self.radio {
            Some(radio) => radio.exchange(uno),
            None => uno.take_bytes_at(baud),
        };
        // The program may have closed the port meanwhile, so check again.
        if self.pty.is_open && self.pty.is_open_now()? {
            self.unread_bytes.extend(arrived_bytes);
            self.unread_bytes.truncate(MAX_UNREAD_BYTES);
            let written_count = self.pty.write(&self.unread_bytes)?;
            self.unread_bytes.drain(..written_count);
        }
        Ok(())
    }

    /// Returns the cycle that the chip should have reached by now, at most [`MAX_CATCH_UP`] ahead. Skips the rest of a
    /// longer delay.
    fn update_target_cycle(&mut self, cycle: u64) -> u64 {
        let now = Instant::now();
        let (anchor_time, anchor_cycle) = *self.anchor.get_or_insert((now, cycle));
        let target_cycle = anchor_cycle + to_cycles(now - anchor_time);
        let max_cycle = cycle + to_cycles(MAX_CATCH_UP);
        if target_cycle > max_cycle {
            self.anchor = Some((now, max_cycle));
        }
        target_cycle.min(max_cycle)
    }
}

/// Converts a duration to the chip's cycles.
fn to_cycles(time: Duration) -> u64 {
    (time.as_nanos() * u128::from(FREQUENCY) / 1_000_000_000) as u64
}

/// A port and its UNO, served by a separate thread. If this value is dropped without [`BackgroundPort::stop`], the
/// thread continues until the program ends.
#[derive(Debug)]
pub struct BackgroundPort {
    path: PathBuf,
    stop_requested: Arc<AtomicBool>,
    thread: JoinHandle<io::Result<Uno>>,
}

impl BackgroundPort {
    /// The file that other programs open, such as /dev/pts/3.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Ends the thread and closes the port. Returns the UNO in its current state.
    ///
    /// # Errors
    /// Returns the error that ended the thread: see [`Port::serve`].
    ///
    /// # Panics
    /// If `watch` panicked.
    pub fn stop(self) -> io::Result<Uno> {
        self.stop_requested.store(true, Ordering::Relaxed);
        match self.thread.join() {
            Ok(result) => result,
            Err(panic) => std::panic::resume_unwind(panic),
        }
    }
}
