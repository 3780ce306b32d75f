//! A memory for tests: 1024 bytes that take their time, and may lose power.

use std::vec::Vec;

use crate::memory::{ERASED, Memory};

/// An EEPROM.
#[derive(Clone, Debug)]
pub struct Chip {
    pub bytes: Vec<u8>,
    /// How many times it is asked before it is ready again.
    pub slowness: usize,
    busy: core::cell::Cell<usize>,
    /// Every byte written: address, what was there, what was meant to be.
    pub log: Vec<(u16, u8, u8)>,
    /// Whether bytes stay as they are.
    pub worn: bool,
}

impl Chip {
    /// As it comes from the factory.
    pub fn blank() -> Self {
        Self::with(std::vec![ERASED; 1024])
    }

    pub fn with(bytes: Vec<u8>) -> Self {
        assert_eq!(bytes.len(), 1024);
        Self {
            bytes,
            slowness: 0,
            busy: core::cell::Cell::new(0),
            log: Vec::new(),
            worn: false,
        }
    }
}

impl Memory for Chip {
    fn is_ready(&self) -> bool {
        let busy = self.busy.get();
        self.busy.set(busy.saturating_sub(1));
        busy == 0
    }

    fn read(&self, address: u16) -> u8 {
        assert_eq!(self.busy.get(), 0, "read while it is being written");
        self.bytes[usize::from(address)]
    }

    fn write(&mut self, address: u16, byte: u8) {
        assert_eq!(self.busy.get(), 0, "written while it is being written");
        let place = &mut self.bytes[usize::from(address)];
        assert_ne!(*place, byte, "written for nothing");
        self.log.push((address, *place, byte));
        if !self.worn {
            *place = byte;
        }
        self.busy.set(self.slowness);
    }
}
