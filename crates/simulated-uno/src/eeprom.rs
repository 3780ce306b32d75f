//! The EEPROM, and power that fails while it is written.
//!
//! A byte takes 3.4 ms. A firmware that loses power meanwhile must find its old
//! settings or its new ones afterwards, so a test must be able to end the power
//! in any byte and choose what is left of it.

use crate::Uno;
use crate::ffi::{self, RawOperation};

/// Bytes of EEPROM of an ATmega328P.
pub const EEPROM_SIZE: usize = 1024;

/// What a programming operation does; EEPM1:0 of the data sheet's table 8-1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EepromMode {
    /// Erases the byte to 0xff, then writes it: 3.4 ms.
    EraseAndWrite,
    /// Erases the byte to 0xff: 1.8 ms.
    EraseOnly,
    /// Clears the bits that are zero in the data: 1.8 ms.
    WriteOnly,
}

/// One byte's programming operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EepromOperation {
    /// Cycle at which it started.
    pub cycle: u64,
    /// Address of the byte, 0 to 1023.
    pub address: u16,
    /// What it does.
    pub mode: EepromMode,
    /// What the byte held.
    pub old: u8,
    /// What it holds afterwards; while the operation is under way, what it will
    /// hold if the power stays.
    pub new: u8,
    /// Whether the power failed during the operation.
    pub torn: bool,
}

/// When the power fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PowerCut {
    /// At this cycle.
    AtCycle(u64),
    /// While the byte is erased (in the middle of that time), in the operation to
    /// come after this number of others: 0 is the next one that starts.
    InErase(u64),
    /// The same, while the byte is written. An operation that only erases or only
    /// writes is cut in its middle by either.
    InWrite(u64),
}

impl Uno {
    /// The contents of the EEPROM. A byte that is being programmed still has its
    /// old value.
    #[must_use]
    pub fn eeprom(&self) -> [u8; EEPROM_SIZE] {
        // SAFETY: `raw` is valid, see `Uno`. simavr's buffer has `EEPROM_SIZE` bytes as long as
        // the instance lives, and bytes need no alignment.
        unsafe { *ffi::uno_eeprom(self.raw).cast() }
    }

    /// Sets the contents, at any time. A new board's are all 0xff. They survive
    /// every reset and power cycle.
    pub fn set_eeprom(&mut self, contents: &[u8; EEPROM_SIZE]) {
        // SAFETY: as in `eeprom`, and `self` is borrowed by nobody else.
        unsafe { *ffi::uno_eeprom(self.raw).cast() = *contents }
    }

    /// The programming operations started so far. None in [`Fidelity::Stock`](crate::Fidelity).
    #[must_use]
    pub fn eeprom_operations(&self) -> Vec<EepromOperation> {
        self.list(ffi::uno_eeprom_operations, |raw: &RawOperation| {
            EepromOperation {
                cycle: raw.cycle,
                address: raw.address,
                mode: match raw.mode {
                    1 => EepromMode::EraseOnly,
                    2 => EepromMode::WriteOnly,
                    _ => EepromMode::EraseAndWrite,
                },
                old: raw.old,
                new: raw.stored,
                torn: raw.torn != 0,
            }
        })
    }

    /// Lets the power fail, once: the run ends with [`State::Off`](crate::State),
    /// every pin is low. [`Uno::power_cycle`] brings the power back.
    ///
    /// `ones` chooses what an operation leaves that is under way then. While a byte
    /// is erased, zeros of the old value become ones one after another: it holds
    /// `old | ones`. While it is written, ones become zeros: it holds `new | ones`,
    /// and in [`EepromMode::WriteOnly`] `old & (new | ones)`. So 0 is the phase's
    /// last instant while writing and its first while erasing, 0xff the other way
    /// round.
    ///
    /// In [`Fidelity::Stock`](crate::Fidelity) only [`PowerCut::AtCycle`] ever
    /// happens, and tears nothing.
    pub fn cut_power(&mut self, when: PowerCut, ones: u8) {
        self.set_torn_bits(ones);
        // SAFETY: `raw` is valid and ours alone, see `Uno`; the shim keeps a number until
        // then.
        unsafe {
            match when {
                PowerCut::AtCycle(cycle) => ffi::uno_cut_power_at(self.raw, cycle.max(1)),
                PowerCut::InErase(skip) => {
                    ffi::uno_cut_power_in_operation(self.raw, skip, false);
                }
                PowerCut::InWrite(skip) => {
                    ffi::uno_cut_power_in_operation(self.raw, skip, true);
                }
            }
        }
    }

    /// Takes back a [`Uno::cut_power`] that has not happened yet.
    pub fn keep_power(&mut self) {
        // SAFETY: `raw` is valid and ours alone, see `Uno`; the shim forgets what
        // `cut_power` has set.
        unsafe { ffi::uno_keep_power(self.raw) }
    }

    /// `ones` of [`Uno::cut_power`] for power that fails otherwise: a supply below
    /// 1.8 V, or [`Uno::power_cycle`].
    pub fn set_torn_bits(&mut self, ones: u8) {
        // SAFETY: `raw` is valid and ours alone, see `Uno`; the shim keeps a number.
        unsafe { ffi::uno_set_torn_ones(self.raw, ones) }
    }
}
