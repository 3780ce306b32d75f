//! A board at a serial port of this machine.

use std::io::{self, ErrorKind, Read, Write};
use std::thread::sleep;
use std::time::Duration;

use lizard_upload::{Board, BoardError};
use serialport::SerialPort;

use crate::drive::clock::Deadline;
use crate::drive::console::link::is_port_gone;
use crate::drive::console::port::{self, PortError};

/// Time for which each level of the reset lines is held; also the pause between closing and reopening a port.
const RESET_TIME: Duration = Duration::from_millis(50);

/// A board's serial port, which can be reopened.
pub struct SerialBoard {
    name: String,
    /// `None` between closing and reopening, and if reopening has failed.
    port: Option<Box<dyn SerialPort>>,
    /// True from opening the port, which also resets a board, until the first call of `reset`.
    is_just_opened: bool,
}

impl SerialBoard {
    /// Opens a port for this program alone.
    ///
    /// # Errors
    /// Fails if the port does not exist, or cannot be opened.
    pub fn open(name: &str) -> Result<Self, PortError> {
        Ok(Self {
            name: name.to_owned(),
            port: Some(port::open(name)?),
            is_just_opened: true,
        })
    }

    /// Returns the open port, or an error if the port could not be reopened.
    fn port(&mut self) -> io::Result<&mut Box<dyn SerialPort>> {
        self.port.as_mut().ok_or_else(|| ErrorKind::NotFound.into())
    }

    /// Toggles the lines that reset a board: DTR on a UNO, RTS on some clones.
    fn toggle_reset_lines(&mut self) -> io::Result<()> {
        let port = self.port()?;
        for level in [false, true] {
            port.write_data_terminal_ready(level)?;
            port.write_request_to_send(level)?;
            sleep(RESET_TIME);
        }
        Ok(())
    }

    /// Sets the port's baud rate.
    ///
    /// # Errors
    /// Fails if the port is gone.
    pub fn set_baud_rate(&mut self, baud: u32) -> io::Result<()> {
        Ok(self.port()?.set_baud_rate(baud)?)
    }

    /// Closes and reopens the port, which resets the board.
    fn reopen(&mut self) -> io::Result<()> {
        self.port = None;
        sleep(RESET_TIME);
        let reopened = port::open(&self.name).map_err(|error| match error {
            PortError::Missing { .. } => ErrorKind::NotFound.into(),
            error => io::Error::other(error.to_string()),
        });
        self.port = Some(reopened?);
        Ok(())
    }

    fn reset_and_set_baud_rate(&mut self, baud: u32) -> io::Result<()> {
        let was_just_opened = std::mem::take(&mut self.is_just_opened);
        match self.toggle_reset_lines() {
            Ok(()) => {}
            // The pseudo terminal of a simulated board has no reset lines, but opening it resets that board. A port
            // that has vanished also fails here, and again when the baud rate is set.
            Err(_) if was_just_opened => {}
            Err(_) => self.reopen()?,
        }
        self.set_baud_rate(baud)
    }

    /// Reads the bytes that are available, waiting some milliseconds for them; returns 0 if there are none.
    fn read_available(&mut self, bytes: &mut [u8]) -> Result<usize, BoardError> {
        match Read::read(self, bytes) {
            Ok(0) => Err(BoardError::Gone),
            Ok(count) => Ok(count),
            Err(error) => match error.kind() {
                ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted => Ok(0),
                _ => Err(to_board_error(error)),
            },
        }
    }
}

/// Every call blocks, so the futures are ready when they are first polled.
impl Board for SerialBoard {
    async fn reset(&mut self, baud: u32) -> Result<(), BoardError> {
        self.reset_and_set_baud_rate(baud).map_err(to_board_error)
    }

    async fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        self.write_all(bytes).map_err(to_board_error)
    }

    async fn read(&mut self, bytes: &mut [u8], time_limit: Duration) -> Result<usize, BoardError> {
        let mut deadline = Deadline::after(time_limit);
        let mut filled_count = 0;
        while filled_count < bytes.len() {
            let count = self.read_available(&mut bytes[filled_count..])?;
            filled_count += count;
            // The deadline is checked only after an empty read, so that bytes that arrived while this program was
            // suspended are still read.
            if count == 0 && deadline.has_passed() {
                break;
            }
        }
        Ok(filled_count)
    }

    async fn discard(&mut self, duration: Duration) -> Result<(), BoardError> {
        let mut deadline = Deadline::after(duration);
        let mut bytes = [0; 256];
        loop {
            self.read_available(&mut bytes)?;
            if deadline.has_passed() {
                return Ok(());
            }
        }
    }
}

fn to_board_error(error: io::Error) -> BoardError {
    match error.kind() {
        ErrorKind::TimedOut => BoardError::Busy,
        _ if is_port_gone(&error) => BoardError::Gone,
        _ => BoardError::Other(error.to_string()),
    }
}

impl Read for SerialBoard {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.port()?.read(bytes)
    }
}

impl Write for SerialBoard {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.port()?.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.port()?.flush()
    }
}
