//! The protocol of the boot loaders on UNO and Nano: STK500, version 1.
//!
//! After a reset by its button or by the DTR line of its USB serial converter, the chip starts in the boot loader. The
//! boot loader blinks, then listens for about a second, and starts the program in flash if no command arrives. One or a
//! few invalid bytes make it start the program at once; then only another reset starts the boot loader again. Commands
//! and responses have no checksums, so written pages must be read back.
//!
//! There are two kinds of boot loader ([`LoaderKind`]). Only the baud rate at which a board answers shows its kind.
//!
//! Sources: Atmel application note AVR061 for the commands; optiboot.c, version 4.4 (UNO), and ATmegaBOOT_168.c (Nano
//! until 2018) for the timing and for unsupported commands.

use std::time::Duration;

use crate::board::{Board, BoardError};
use crate::image::{BOOT_ADDRESS, NANO_BOOT_ADDRESS, PAGE_BYTES};

// Responses, the end of a command, and commands, with their codes in AVR061.
const OK: u8 = 0x10;
const IN_SYNC: u8 = 0x14;
const CRC_EOP: u8 = 0x20;
const GET_SYNC: u8 = 0x30;
const LEAVE: u8 = 0x51;
const LOAD_ADDRESS: u8 = 0x55;
const PROGRAM_PAGE: u8 = 0x64;
const READ_PAGE: u8 = 0x74;
const READ_SIGNATURE: u8 = 0x75;
/// The memory type in commands that read or write a page.
const FLASH: u8 = b'F';
/// Largest number of requests to synchronise after one reset.
const MAX_SYNC_REQUESTS: usize = 5;
/// Largest number of stray bytes before the response to a sync request: about as many as the line carries in
/// [`SYNC_TIME_LIMIT`].
const MAX_STRAY_BYTES: usize = 1300;

/// Time after a reset in which the loader blinks and does not listen. Bytes sent meanwhile overflow its receiver, and a
/// partial command makes it start the program.
const BLINK_TIME: Duration = Duration::from_millis(400);
/// Time limit for each byte of the response to a sync request.
const SYNC_TIME_LIMIT: Duration = Duration::from_millis(110);
/// Time after the first response in which late responses to earlier sync requests are discarded.
const DRAIN_TIME: Duration = Duration::from_millis(40);
/// Time limit for the response to any other command. Writing a page takes about 20 ms, but on a busy machine the
/// response may arrive a second later.
const RESPONSE_TIME_LIMIT: Duration = Duration::from_secs(2);

/// A kind of boot loader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LoaderKind {
    /// The boot loader of UNOs, and of Nanos since 2018.
    #[default]
    Optiboot,
    /// The boot loader of older Nanos and of many clones. It starts the program 1.5 s after the last byte, even after
    /// the command to leave.
    AtmegaBoot,
}

impl LoaderKind {
    /// The baud rate of the serial connection.
    pub fn baud(self) -> u32 {
        match self {
            Self::Optiboot => 115_200,
            Self::AtmegaBoot => 57_600,
        }
    }

    /// The address of the loader's first byte in flash.
    pub fn start_address(self) -> usize {
        match self {
            Self::Optiboot => BOOT_ADDRESS,
            Self::AtmegaBoot => NANO_BOOT_ADDRESS,
        }
    }
}

/// The error of a failed boot loader command.
#[derive(Debug, thiserror::Error)]
pub enum LoaderError {
    /// No response, or an incomplete one, within the time limit.
    #[error("the board does not answer")]
    Silent,
    /// A response in the wrong format.
    #[error("the board's answers are garbled")]
    Garbled,
    /// The connection failed.
    #[error(transparent)]
    Board(BoardError),
}

impl LoaderError {
    /// True if the command may succeed after another reset.
    pub fn is_transient(&self) -> bool {
        matches!(self, Self::Silent | Self::Garbled)
    }
}

impl From<BoardError> for LoaderError {
    fn from(error: BoardError) -> Self {
        match error {
            // A command that could not be sent gets no response.
            BoardError::Busy => Self::Silent,
            error => Self::Board(error),
        }
    }
}

/// A client of a board's boot loader.
#[derive(Debug)]
pub struct Loader<B> {
    board: B,
}

impl<B: Board> Loader<B> {
    /// Creates a client; sends nothing before [`Loader::reset_and_sync`].
    pub fn new(board: B) -> Self {
        Self { board }
    }

    /// Returns the connection, with all bytes that were not read.
    pub fn into_board(self) -> B {
        self.board
    }

    /// Resets the board and sends sync requests to its boot loader until it answers.
    ///
    /// # Errors
    /// Returns [`LoaderError::Silent`] if no loader answers, and another [`LoaderError`] if the connection fails.
    pub async fn reset_and_sync(&mut self, kind: LoaderKind) -> Result<(), LoaderError> {
        self.board.reset(kind.baud()).await?;
        // The last output of the old program also arrives in this time.
        self.board.discard(BLINK_TIME).await?;
        for _ in 0..MAX_SYNC_REQUESTS {
            self.board.write(&[GET_SYNC, CRC_EOP]).await?;
            if self.wait_for_sync().await? {
                return Ok(self.board.discard(DRAIN_TIME).await?);
            }
        }
        Err(LoaderError::Silent)
    }

    /// Reads the three bytes that identify the chip.
    ///
    /// # Errors
    /// See [`LoaderError`].
    pub async fn read_signature(&mut self) -> Result<[u8; 3], LoaderError> {
        let mut signature = [0; 3];
        self.send_command(&[READ_SIGNATURE], &mut signature).await?;
        Ok(signature)
    }

    /// Reads a page of flash that starts at `address`.
    ///
    /// # Errors
    /// See [`LoaderError`].
    pub async fn read_page(&mut self, address: usize) -> Result<[u8; PAGE_BYTES], LoaderError> {
        self.set_address(address).await?;
        let mut page = [0; PAGE_BYTES];
        let command = [READ_PAGE, 0, PAGE_BYTES as u8, FLASH];
        self.send_command(&command, &mut page).await?;
        Ok(page)
    }

    /// Erases and writes a page of flash that starts at `address`.
    ///
    /// # Errors
    /// See [`LoaderError`].
    pub async fn write_page(
        &mut self,
        address: usize,
        page: &[u8; PAGE_BYTES],
    ) -> Result<(), LoaderError> {
        self.set_address(address).await?;
        let header = [PROGRAM_PAGE, 0, PAGE_BYTES as u8, FLASH];
        let command = [header.as_slice(), page].concat();
        self.send_command(&command, &mut []).await
    }

    /// Makes the boot loader start the program in flash.
    ///
    /// # Errors
    /// See [`LoaderError`].
    pub async fn leave(&mut self) -> Result<(), LoaderError> {
        self.send_command(&[LEAVE], &mut []).await
    }

    /// Sets the address of the next page. The protocol counts addresses in words of two bytes.
    async fn set_address(&mut self, address: usize) -> Result<(), LoaderError> {
        let [low, high] = ((address / 2) as u16).to_le_bytes();
        self.send_command(&[LOAD_ADDRESS, low, high], &mut []).await
    }

    /// Sends a command, and fills `response` with the bytes between [`IN_SYNC`] and [`OK`].
    async fn send_command(&mut self, bytes: &[u8], response: &mut [u8]) -> Result<(), LoaderError> {
        self.board.write(&[bytes, &[CRC_EOP]].concat()).await?;
        let mut received = vec![0; response.len() + 2];
        let count = self.board.read(&mut received, RESPONSE_TIME_LIMIT).await?;
        match received.as_slice() {
            _ if count < received.len() => Err(LoaderError::Silent),
            [IN_SYNC, content @ .., OK] => {
                response.copy_from_slice(content);
                Ok(())
            }
            _ => Err(LoaderError::Garbled),
        }
    }

    /// Waits for [`IN_SYNC`] followed by [`OK`], after any stray bytes. Returns false if no byte arrives in time, or if
    /// too many stray bytes arrive.
    async fn wait_for_sync(&mut self) -> Result<bool, LoaderError> {
        let mut previous_byte = 0;
        for _ in 0..MAX_STRAY_BYTES {
            let mut byte = [0];
            if self.board.read(&mut byte, SYNC_TIME_LIMIT).await? == 0 {
                return Ok(false);
            }
            if [previous_byte, byte[0]] == [IN_SYNC, OK] {
                return Ok(true);
            }
            previous_byte = byte[0];
        }
        Ok(false)
    }
}
