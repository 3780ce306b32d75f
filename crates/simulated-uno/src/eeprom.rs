//! The EEPROM, and power failures while it is written.
//!
//! Programming a byte takes 3.4 ms. If firmware loses power during that time, it must find either its old or its new
//! settings at the next start. To check this, a test can cut the power while any byte is programmed, and can choose the
//! bits that are set in that byte afterwards.

use crate::Uno;
use crate::ffi;

/// The size of an ATmega328P's EEPROM, bytes.
pub const EEPROM_SIZE: usize = 1024;

/// The kind of a programming operation: EEPM1:0 in table 8-1 of the data sheet.
// `enum eeprom_mode` of the shim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum EepromMode {
    /// Erases the byte to 0xff, then writes it: 3.4 ms.
    EraseAndWrite,
    /// Erases the byte to 0xff: 1.8 ms.
    EraseOnly,
    /// Clears the bits that are zero in the data: 1.8 ms.
    WriteOnly,
}

/// The programming operation of one byte.
// `struct eeprom_operation` of the shim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct EepromOperation {
    /// The cycle at which the operation started.
    pub cycle: u64,
    /// The byte's address, 0 to 1023.
    pub address: u16,
    /// The kind of the operation.
    pub mode: EepromMode,
    /// The byte's value before the operation.
    pub old_value: u8,
    /// The byte's value after the operation or, while the operation is in progress, the value that the byte will have
    /// if the power does not fail.
    pub new_value: u8,
    /// True if the power failed during the operation.
    pub is_torn: bool,
}

/// The moment at which the power fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PowerCut {
    /// At this cycle since power-on.
    AtCycle(u64),
    /// In the middle of a later operation's erase phase, after this number of skipped operations; 0 is the next
    /// operation.
    InErase(u64),
    /// In the middle of a later operation's write phase, after this number of skipped operations; 0 is the next
    /// operation. Both `InErase` and `InWrite` cut an operation that only erases or only writes in its middle.
    InWrite(u64),
}

impl Uno {
    /// The contents of the EEPROM. A byte that is being programmed still has its old value.
    #[must_use]
    pub fn eeprom(&self) -> [u8; EEPROM_SIZE] {
        // SAFETY: `raw` is valid (see `Uno`). simavr's buffer has `EEPROM_SIZE` bytes as long as
        // the instance lives, and bytes need no alignment.
        unsafe { *ffi::uno_eeprom(self.raw).cast() }
    }

    /// Sets the contents of the EEPROM; allowed at any time. On a new board, all bytes are 0xff. The contents
    /// survive every reset and power cycle.
    pub fn set_eeprom(&mut self, contents: &[u8; EEPROM_SIZE]) {
        // SAFETY: as in `eeprom`, and `self` is borrowed nowhere else.
        unsafe { *ffi::uno_eeprom(self.raw).cast() = *contents }
    }

    /// The programming operations started so far; always empty with [`Fidelity::Stock`](crate::Fidelity).
    #[must_use]
    pub fn eeprom_operations(&self) -> Vec<EepromOperation> {
        self.copy_items(ffi::uno_eeprom_operations)
    }

    /// Makes the power fail once. The run ends with [`State::Off`](crate::State), and every pin is low.
    /// [`Uno::power_cycle`] restores the power.
    ///
    /// `ones` chooses the value that remains in the byte of an operation in progress, whose old value is `old` and
    /// whose data is `new`. During the erase phase, zeros of the old value become ones one after another: the byte is
    /// `old | ones`. During the write phase, ones become zeros: the byte is `new | ones`, or `old & (new | ones)` in
    /// [`EepromMode::WriteOnly`]. Therefore `ones` = 0 gives the value at the start of the erase phase and at the end
    /// of the write phase, and 0xff the value at the end of the erase phase and at the start of the write phase.
    ///
    /// With [`Fidelity::Stock`](crate::Fidelity), only [`PowerCut::AtCycle`] has an effect, and it never tears a
    /// byte.
    pub fn cut_power(&mut self, cut: PowerCut, ones: u8) {
        self.set_torn_bits(ones);
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim keeps numbers.
        unsafe {
            match cut {
                PowerCut::AtCycle(cycle) => ffi::uno_cut_power_at(self.raw, cycle.max(1)),
                PowerCut::InErase(skip_count) => {
                    ffi::uno_cut_power_in_operation(self.raw, skip_count, false)
                }
                PowerCut::InWrite(skip_count) => {
                    ffi::uno_cut_power_in_operation(self.raw, skip_count, true)
                }
            }
        }
    }

    /// Cancels a power failure that [`Uno::cut_power`] has scheduled and that has not happened yet.
    pub fn cancel_power_cut(&mut self) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim clears what `cut_power` has set.
        unsafe { ffi::uno_cancel_power_cut(self.raw) }
    }

    /// Sets the bits that remain set in a byte after a power failure other than [`Uno::cut_power`]: a supply below
    /// 1.8 V, or [`Uno::power_cycle`]. For the meaning of `ones`, see [`Uno::cut_power`].
    pub fn set_torn_bits(&mut self, ones: u8) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim keeps a number.
        unsafe { ffi::uno_set_torn_bits(self.raw, ones) }
    }
}
