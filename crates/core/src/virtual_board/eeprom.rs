//! The EEPROM: 1024 bytes that are slow to write, wear out, and may be damaged by a power cut during a write.

use core::cell::Cell;
use core::hash::{Hash, Hasher};
use std::sync::Arc;
use std::vec::Vec;

use crate::memory::record::{ERASED, MEMORY_BYTES, Memory};

/// An EEPROM. Clones share their bytes until one of the clones is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Eeprom {
    bytes: Arc<[u8; MEMORY_BYTES]>,
    /// The time from a write until the EEPROM is ready again: milliseconds if `is_timed` is true, otherwise polls.
    pub write_delay: u16,
    /// True if the EEPROM becomes ready after some time, as on the chip; false if it becomes ready after some polls.
    pub is_timed: bool,
    /// True if the EEPROM is worn out, so that writes change nothing.
    pub is_worn: bool,
    /// All writes so far: address, old value and new value.
    pub log: Vec<(u16, u8, u8)>,
    /// The remaining part of `write_delay`.
    remaining_delay: Cell<u16>,
    /// True if the EEPROM was busy at the last poll; set only if `is_timed` is true.
    was_polled_busy: Cell<bool>,
    /// The address of the byte that is being written, if any.
    address_in_write: Cell<Option<u16>>,
}

impl Default for Eeprom {
    fn default() -> Self {
        Self::blank()
    }
}

impl Hash for Eeprom {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.bytes.hash(state);
        self.is_worn.hash(state);
        self.log.hash(state);
        self.remaining_delay.get().hash(state);
        self.address_in_write.get().hash(state);
    }
}

impl Eeprom {
    /// Creates an erased EEPROM, as delivered by the factory.
    pub fn blank() -> Self {
        Self::with_bytes([ERASED; MEMORY_BYTES])
    }

    /// Creates an EEPROM with these bytes.
    pub fn with_bytes(bytes: [u8; MEMORY_BYTES]) -> Self {
        Self {
            bytes: Arc::new(bytes),
            write_delay: 0,
            is_timed: false,
            is_worn: false,
            log: Vec::new(),
            remaining_delay: Cell::new(0),
            was_polled_busy: Cell::new(false),
            address_in_write: Cell::new(None),
        }
    }

    /// All bytes of the EEPROM.
    pub fn bytes(&self) -> &[u8; MEMORY_BYTES] {
        &self.bytes
    }

    /// All bytes of the EEPROM, mutable for tests.
    pub fn bytes_mut(&mut self) -> &mut [u8; MEMORY_BYTES] {
        Arc::make_mut(&mut self.bytes)
    }

    /// The address of the byte that is being written, if any.
    pub fn address_in_write(&self) -> Option<u16> {
        self.address_in_write.get()
    }

    /// Takes the flag that is true if the EEPROM was busy at the last poll and becomes ready only after some time.
    pub fn take_polled_busy(&self) -> bool {
        self.was_polled_busy.take()
    }

    /// Lets a millisecond pass.
    pub(super) fn pass_one_ms(&mut self) {
        let delay = self.remaining_delay.get_mut();
        *delay = delay.saturating_sub(u16::from(self.is_timed));
        if *delay == 0 {
            self.address_in_write.set(None);
        }
    }

    /// Completes a write immediately.
    pub(super) fn complete_write(&mut self) {
        self.remaining_delay.set(0);
        self.address_in_write.set(None);
    }

    /// Cuts the power: a byte that is being written gets the value `byte`.
    pub(super) fn cut_power(&mut self, byte: u8) {
        if let Some(address) = self.address_in_write.take() {
            self.bytes_mut()[usize::from(address)] = byte;
        }
        self.remaining_delay.set(0);
    }
}

impl Memory for Eeprom {
    fn is_ready(&self) -> bool {
        let delay = self.remaining_delay.get();
        if self.is_timed {
            self.was_polled_busy.set(delay > 0);
        } else {
            self.remaining_delay.set(delay.saturating_sub(1));
        }
        if delay == 0 {
            self.address_in_write.set(None);
        }
        delay == 0
    }

    fn read(&self, address: u16) -> u8 {
        let delay = self.remaining_delay.get();
        assert_eq!(delay, 0, "a byte must not be read during a write");
        self.bytes[usize::from(address)]
    }

    fn write(&mut self, address: u16, byte: u8) {
        let delay = self.remaining_delay.get();
        assert_eq!(delay, 0, "a byte must not be written during another write");
        let old_byte = self.bytes[usize::from(address)];
        assert_ne!(old_byte, byte, "a write must change its byte");
        self.log.push((address, old_byte, byte));
        if !self.is_worn {
            self.bytes_mut()[usize::from(address)] = byte;
        }
        self.remaining_delay.set(self.write_delay);
        self.address_in_write.set(Some(address));
    }
}
