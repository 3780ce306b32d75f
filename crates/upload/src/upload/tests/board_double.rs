//! A test double of a board. Its boot loader behaves byte for byte like optiboot.c, version 4.4, or ATmegaBOOT_168.c,
//! and tests can inject faults.

use std::collections::VecDeque;
use std::time::Duration;

use crate::board::{Board, BoardError};
use crate::loader::LoaderKind;

/// A simulated board: its flash, and the faults to inject.
#[derive(Default)]
pub struct BoardDouble {
    /// The 32 KiB of flash; of the boot loader, only the first four bytes.
    pub flash: Vec<u8>,
    /// The kind of boot loader, which receives bytes only at its own baud rate.
    pub kind: LoaderKind,
    /// The chip signature that the loader reports.
    pub signature: [u8; 3],
    /// The bytes that the running program sends before each reset, and that arrive after the reset.
    pub old_program_output: Vec<u8>,
    /// The number of sync requests that are ignored after each reset.
    pub ignored_syncs_per_reset: usize,
    /// True if the loader never answers.
    pub is_mute: bool,
    /// True if the board sends `x` without end, and nothing else.
    pub sends_endlessly: bool,
    /// The index of the lost byte among the bytes sent to the board.
    pub lost_byte_to_board: Option<usize>,
    /// The index of the lost byte among the bytes sent by the board.
    pub lost_byte_from_board: Option<usize>,
    /// A flash address, and its bits that are stuck at 0.
    pub stuck_bits: Option<(usize, u8)>,
    /// The number of written pages after which the port disappears.
    pub unplugged_after_pages: Option<usize>,
    /// The addresses of written pages, in order.
    pub written_addresses: Vec<usize>,
    /// The number of resets so far.
    pub reset_count: usize,
    /// True if the last command started the program in flash.
    pub has_started_program: bool,
    /// The number of bytes sent to the board so far, lost ones included.
    pub received_count: usize,
    /// The number of bytes sent by the board so far, lost ones included.
    pub sent_count: usize,
    /// The number of invalid bytes that the boot loader has received since the reset.
    error_count: usize,
    /// True while the boot loader runs and receives bytes.
    is_listening: bool,
    /// The number of remaining sync requests to ignore.
    syncs_to_ignore: usize,
    /// The flash address of the next page command.
    address: usize,
    /// The bytes of the incomplete command.
    command: Vec<u8>,
    /// The bytes that the board has sent and nobody has read.
    output: VecDeque<u8>,
}

impl BoardDouble {
    /// Creates a UNO with blank flash.
    pub fn blank() -> Self {
        Self::with_loader(LoaderKind::Optiboot, 0x7e00, [0x11, 0x24, 0x84, 0xb7])
    }

    /// Creates an old Nano with blank flash.
    pub fn old_nano() -> Self {
        Self::with_loader(LoaderKind::AtmegaBoot, 0x7800, [0x0c, 0x94, 0x34, 0x3c])
    }

    /// Creates a board whose flash holds the boot loader's first bytes and is blank otherwise.
    fn with_loader(kind: LoaderKind, loader_address: usize, loader_bytes: [u8; 4]) -> Self {
        let mut flash = vec![0xff; 0x8000];
        flash[loader_address..loader_address + 4].copy_from_slice(&loader_bytes);
        Self {
            flash,
            kind,
            signature: [0x1e, 0x95, 0x0f],
            ..Self::default()
        }
    }

    /// Creates a UNO with a program at address 0.
    pub fn with_program(program: &[u8]) -> Self {
        let mut double = Self::blank();
        double.flash[..program.len()].copy_from_slice(program);
        double
    }

    /// Fails if the board is unplugged.
    fn check_connection(&self) -> Result<(), BoardError> {
        match self.unplugged_after_pages {
            Some(count) if self.written_addresses.len() >= count => Err(BoardError::Gone),
            _ => Ok(()),
        }
    }

    /// Responds to the command if it is complete.
    fn respond_to_command(&mut self) {
        let command = std::mem::take(&mut self.command);
        let length = match command[0] {
            b'U' => 4,
            b't' => 5,
            b'd' => 5 + command.get(2).map_or(0, |&count| usize::from(count)),
            // All other commands, known and unknown, have no parameters.
            _ => 2,
        };
        if command.len() < length {
            self.command = command;
            return;
        }
        if command[length - 1] != b' ' {
            self.error_count += 1;
            // ATmegaBOOT starts the program after MAX_ERROR_COUNT errors. Optiboot starts the program at once: in
            // verifySpace(), the watchdog resets the chip.
            self.is_listening = self.kind == LoaderKind::AtmegaBoot && self.error_count < 5;
            return;
        }
        let mut response = vec![0x14];
        match command[0] {
            b'U' => {
                let word_address = u16::from_le_bytes([command[1], command[2]]);
                self.address = 2 * usize::from(word_address);
            }
            b'u' => response.extend(self.signature),
            b't' => {
                let end = self.address + usize::from(command[2]);
                response.extend(&self.flash[self.address..end]);
                self.address = end;
            }
            b'd' => self.write_page(&command[4..length - 1]),
            b'Q' => {
                // ATmegaBOOT listens until nothing arrives for a while.
                self.is_listening = self.kind == LoaderKind::AtmegaBoot;
                self.has_started_program = true;
            }
            _ => {}
        }
        response.push(0x10);
        for byte in response {
            if self.lost_byte_from_board != Some(self.sent_count) {
                self.output.push_back(byte);
            }
            self.sent_count += 1;
        }
    }

    /// Writes the page at the current address.
    fn write_page(&mut self, bytes: &[u8]) {
        assert_eq!(bytes.len(), 128, "a page of an ATmega328P has 128 bytes");
        assert_eq!(self.address % 128, 0, "the address is the first of a page");
        self.flash[self.address..self.address + 128].copy_from_slice(bytes);
        if let Some((address, bits)) = self.stuck_bits {
            self.flash[address] &= !bits;
        }
        self.written_addresses.push(self.address);
    }
}

impl Board for BoardDouble {
    async fn reset(&mut self, baud: u32) -> Result<(), BoardError> {
        self.reset_count += 1;
        self.error_count = 0;
        self.is_listening = !self.is_mute && baud == self.kind.baud();
        self.syncs_to_ignore = self.ignored_syncs_per_reset;
        self.has_started_program = false;
        self.command.clear();
        self.output.clear();
        self.output.extend(&self.old_program_output);
        Ok(())
    }

    async fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        self.check_connection()?;
        for byte in bytes {
            let is_lost = self.lost_byte_to_board == Some(self.received_count);
            self.received_count += 1;
            if is_lost || !self.is_listening {
                continue;
            }
            self.command.push(*byte);
            if self.syncs_to_ignore > 0 && self.command == *b"0 " {
                self.syncs_to_ignore -= 1;
                self.command.clear();
            }
            if !self.command.is_empty() {
                self.respond_to_command();
            }
        }
        Ok(())
    }

    async fn read(&mut self, bytes: &mut [u8], _time_limit: Duration) -> Result<usize, BoardError> {
        self.check_connection()?;
        if self.sends_endlessly {
            bytes.fill(b'x');
            return Ok(bytes.len());
        }
        let count = bytes.len().min(self.output.len());
        for (byte, sent) in bytes.iter_mut().zip(self.output.drain(..count)) {
            *byte = sent;
        }
        Ok(count)
    }

    async fn discard(&mut self, _duration: Duration) -> Result<(), BoardError> {
        self.check_connection()?;
        self.output.clear();
        Ok(())
    }
}
