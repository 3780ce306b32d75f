//! The EEPROM: 1024 bytes that take their time, wear out, and may lose power.

use core::cell::Cell;
use core::hash::{Hash, Hasher};
use std::sync::Arc;
use std::vec::Vec;

use crate::memory::record::{ERASED, Memory, SIZE};

/// An EEPROM. Clones share their bytes until one of them is written to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Eeprom {
    bytes: Arc<[u8; SIZE]>,
    /// How many times it is asked after a write before it is ready again; or, where
    /// it is `timed`, milliseconds.
    pub slowness: u16,
    /// Whether time alone makes it ready, as on the chip.
    pub timed: bool,
    /// Whether bytes stay as they are.
    pub worn: bool,
    /// Every byte written: address, what was there, what was meant to be.
    pub log: Vec<(u16, u8, u8)>,
    busy: Cell<u16>,
    /// Whether it has been asked and was not ready.
    in_vain: Cell<bool>,
    /// The byte that is being written.
    under_way: Cell<Option<u16>>,
}

impl Default for Eeprom {
    fn default() -> Self {
        Self::blank()
    }
}

impl Hash for Eeprom {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.bytes.hash(state);
        self.worn.hash(state);
        self.log.hash(state);
        self.busy.get().hash(state);
        self.under_way.get().hash(state);
    }
}

impl Eeprom {
    /// As it comes from the factory.
    #[must_use]
    pub fn blank() -> Self {
        Self::with([ERASED; SIZE])
    }

    /// With these bytes.
    #[must_use]
    pub fn with(bytes: [u8; SIZE]) -> Self {
        Self {
            bytes: Arc::new(bytes),
            slowness: 0,
            timed: false,
            worn: false,
            log: Vec::new(),
            busy: Cell::new(0),
            in_vain: Cell::new(false),
            under_way: Cell::new(None),
        }
    }

    /// All its bytes.
    #[must_use]
    pub fn bytes(&self) -> &[u8; SIZE] {
        &self.bytes
    }

    /// The same, to be changed by another hand than the program's.
    pub fn bytes_mut(&mut self) -> &mut [u8; SIZE] {
        Arc::make_mut(&mut self.bytes)
    }

    /// The address of the byte that is being written.
    #[must_use]
    pub fn under_way(&self) -> Option<u16> {
        self.under_way.get()
    }

    /// Whether it has been asked since the last call and only time makes it ready.
    #[must_use]
    pub fn is_asked_in_vain(&self) -> bool {
        self.in_vain.take()
    }

    /// A millisecond passes.
    pub(super) fn pass(&mut self) {
        let busy = self.busy.get().saturating_sub(u16::from(self.timed));
        self.busy.set(busy);
        if busy == 0 {
            self.under_way.set(None);
        }
    }

    /// Time enough passes for the byte that was being written.
    pub(super) fn settle(&mut self) {
        self.busy.set(0);
        self.under_way.set(None);
    }

    /// Power is lost: the byte that was being written holds something else.
    pub(super) fn tear(&mut self, byte: u8) {
        if let Some(address) = self.under_way.take() {
            self.bytes_mut()[usize::from(address)] = byte;
        }
        self.busy.set(0);
    }
}

impl Memory for Eeprom {
    fn is_ready(&self) -> bool {
        let busy = self.busy.get();
        if self.timed {
            self.in_vain.set(busy > 0);
        } else {
            self.busy.set(busy.saturating_sub(1));
        }
        if busy == 0 {
            self.under_way.set(None);
        }
        busy == 0
    }

    fn read(&self, address: u16) -> u8 {
        assert_eq!(self.busy.get(), 0, "read while it is being written");
        self.bytes[usize::from(address)]
    }

    fn write(&mut self, address: u16, byte: u8) {
        assert_eq!(self.busy.get(), 0, "written while it is being written");
        let before = self.bytes[usize::from(address)];
        assert_ne!(before, byte, "written for nothing");
        self.log.push((address, before, byte));
        if !self.worn {
            self.bytes_mut()[usize::from(address)] = byte;
        }
        self.busy.set(self.slowness);
        self.under_way.set(Some(address));
    }
}
