//! A test double: a board whose boot loader behaves byte for byte like optiboot.c, version 4.4, or
//! ATmegaBOOT_168.c, with faults that a test can inject.

use std::collections::VecDeque;
use std::time::Duration;

use crate::board::{Board, BoardError};
use crate::loader::Kind;

/// A simulated board: its flash, and the faults to inject.
pub struct BoardDouble {
    /// The 32 KiB of flash; of the boot loader they hold only the first four bytes.
    pub flash: Vec<u8>,
    /// The kind of boot loader. It receives nothing at a baud rate other than its own.
    pub kind: Kind,
    /// The chip signature that the loader reports.
    pub signature: [u8; 3],
    /// Bytes sent by a running program until the reset, which are received afterwards.
    pub garbage: Vec<u8>,
    /// The number of calls that are ignored after each reset.
    pub ignored_calls: usize,
    /// True if the loader never answers.
    pub is_mute: bool,
    /// The number of the byte to the board that is lost, counted from 0.
    pub lost_byte_to_board: Option<usize>,
    /// The number of the byte from the board that is lost, counted from 0.
    pub lost_byte_from_board: Option<usize>,
    /// An address in flash, and its bits that are stuck at 0.
    pub stuck_bits: Option<(usize, u8)>,
    /// The number of written pages after which the port vanishes.
    pub unplugged_after: Option<usize>,
    /// The addresses of written pages, in order.
    pub written: Vec<usize>,
    /// The number of resets so far.
    pub resets: usize,
    /// True if the last command started the program in flash.
    pub has_started_program: bool,
    /// The number of bytes sent to the board so far, lost ones included.
    pub received: usize,
    /// The number of bytes sent by the board so far, lost ones included.
    pub sent: usize,
    /// The number of bytes that ATmegaBOOT did not understand since the reset.
    errors: usize,
    is_listening: bool,
    calls_to_ignore: usize,
    address: usize,
    command: Vec<u8>,
    out: VecDeque<u8>,
}

impl BoardDouble {
    /// A board with a chip whose flash is blank.
    pub fn blank() -> Self {
        Self::of(Kind::Optiboot, 0x7e00, [0x11, 0x24, 0x84, 0xb7])
    }

    /// An old Nano with blank flash.
    pub fn old_nano() -> Self {
        Self::of(Kind::AtmegaBoot, 0x7800, [0x0c, 0x94, 0x34, 0x3c])
    }

    fn of(kind: Kind, start: usize, loader: [u8; 4]) -> Self {
        let mut flash = vec![0xff; 0x8000];
        flash[start..start + 4].copy_from_slice(&loader);
        Self {
            flash,
            kind,
            errors: 0,
            signature: [0x1e, 0x95, 0x0f],
            garbage: Vec::new(),
            ignored_calls: 0,
            is_mute: false,
            lost_byte_to_board: None,
            lost_byte_from_board: None,
            stuck_bits: None,
            unplugged_after: None,
            written: Vec::new(),
            resets: 0,
            has_started_program: false,
            received: 0,
            sent: 0,
            is_listening: false,
            calls_to_ignore: 0,
            address: 0,
            command: Vec::new(),
            out: VecDeque::new(),
        }
    }

    /// A blank board with these bytes from address 0.
    pub fn with(program: &[u8]) -> Self {
        let mut double = Self::blank();
        double.flash[..program.len()].copy_from_slice(program);
        double
    }

    /// Fails if the board is unplugged.
    fn check_connection(&self) -> Result<(), BoardError> {
        let page_limit = self.unplugged_after;
        match page_limit.is_some_and(|page_limit| self.written.len() >= page_limit) {
            true => Err(BoardError::Gone),
            false => Ok(()),
        }
    }

    /// Answers a command if it is complete.
    fn answer_command(&mut self) {
        let command = std::mem::take(&mut self.command);
        let length = match command[0] {
            b'0' | b'Q' | b'u' => 2,
            b'U' => 4,
            b't' => 5,
            b'd' => 5 + command.get(2).map_or(0, |&count| usize::from(count)),
            // Unknown commands have no parameters.
            _ => 2,
        };
        if command.len() < length {
            self.command = command;
            return;
        }
        if command[length - 1] != b' ' && self.kind == Kind::AtmegaBoot {
            self.errors += 1;
            // MAX_ERROR_COUNT: the program starts.
            self.is_listening = self.errors < 5;
            return;
        }
        if command[length - 1] != b' ' {
            // verifySpace(): the watchdog resets the chip, and the program starts.
            self.is_listening = false;
            return;
        }
        let mut answer = vec![0x14];
        match command[0] {
            b'U' => {
                let words = u16::from_le_bytes([command[1], command[2]]);
                self.address = 2 * usize::from(words);
            }
            b'u' => answer.extend(self.signature),
            b't' => {
                let end = self.address + usize::from(command[2]);
                answer.extend(&self.flash[self.address..end]);
                self.address = end;
            }
            b'd' => self.write_page(&command[4..length - 1]),
            b'Q' => {
                // ATmegaBOOT keeps listening until nothing arrives for a while.
                self.is_listening = self.kind == Kind::AtmegaBoot;
                self.has_started_program = true;
            }
            _ => {}
        }
        answer.push(0x10);
        for byte in answer {
            if self.lost_byte_from_board != Some(self.sent) {
                self.out.push_back(byte);
            }
            self.sent += 1;
        }
    }

    fn write_page(&mut self, bytes: &[u8]) {
        assert_eq!(bytes.len(), 128, "a page of an ATmega328P");
        assert_eq!(self.address % 128, 0, "pages begin where pages begin");
        self.flash[self.address..self.address + 128].copy_from_slice(bytes);
        if let Some((address, bits)) = self.stuck_bits {
            self.flash[address] &= !bits;
        }
        self.written.push(self.address);
    }
}

impl Board for BoardDouble {
    async fn reset(&mut self, baud: u32) -> Result<(), BoardError> {
        self.resets += 1;
        self.errors = 0;
        self.is_listening = !self.is_mute && baud == self.kind.baud();
        self.calls_to_ignore = self.ignored_calls;
        self.has_started_program = false;
        self.command.clear();
        self.out.clear();
        self.out.extend(&self.garbage);
        Ok(())
    }

    async fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        self.check_connection()?;
        for byte in bytes {
            let lost = self.lost_byte_to_board == Some(self.received);
            self.received += 1;
            if lost || !self.is_listening {
                continue;
            }
            self.command.push(*byte);
            if self.calls_to_ignore > 0 && self.command == *b"0 " {
                self.calls_to_ignore -= 1;
                self.command.clear();
            }
            if !self.command.is_empty() {
                self.answer_command();
            }
        }
        Ok(())
    }

    async fn read(&mut self, bytes: &mut [u8], _time: Duration) -> Result<usize, BoardError> {
        self.check_connection()?;
        let count = bytes.len().min(self.out.len());
        for (byte, sent) in bytes.iter_mut().zip(self.out.drain(..count)) {
            *byte = sent;
        }
        Ok(count)
    }

    async fn discard(&mut self, _time: Duration) -> Result<(), BoardError> {
        self.check_connection()?;
        self.out.clear();
        Ok(())
    }
}
