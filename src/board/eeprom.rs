//! The EEPROM: 1024 bytes that survive a loss of power.
//!
//! The chip erases and writes a byte in 3.4 ms while the program continues. A write must begin within four cycles after
//! it is enabled (data sheet, section 8.6.3), so interrupts are off for about ten cycles.

use core::arch::asm;

use avr_device::atmega328p::EEPROM;
use avr_device::interrupt;
use lizard_core::memory::record::Memory;

/// The I/O address of EECR, for `sbi`.
const EECR: u8 = 0x1f;
/// The number of the EECR bit that enables a write within four cycles.
const EEMPE: u8 = 2;
/// The number of the EECR bit that starts a write.
const EEPE: u8 = 1;

/// The chip's EEPROM.
pub struct Eeprom {
    registers: EEPROM,
}

impl Eeprom {
    /// Creates the EEPROM from its registers. First waits, at most 3.4 ms, for the end of a write that was in progress
    /// at a reset, because the EEPROM cannot be read during a write.
    pub fn new(registers: EEPROM) -> Self {
        while registers.eecr.read().eepe().bit_is_set() {}
        // Selects erasing and writing in one operation, and no interrupt. The boot loader may have left another mode.
        registers.eecr.reset();
        Self { registers }
    }
}

impl Memory for Eeprom {
    fn is_ready(&self) -> bool {
        self.registers.eecr.read().eepe().bit_is_clear()
    }

    fn read(&self, address: u16) -> u8 {
        self.registers.eear.write(|w| w.bits(address));
        self.registers.eecr.write(|w| w.eere().set_bit());
        self.registers.eedr.read().bits()
    }

    fn write(&mut self, address: u16, byte: u8) {
        self.registers.eear.write(|w| w.bits(address));
        self.registers.eedr.write(|w| w.bits(byte));
        interrupt::free(|_| {
            // SAFETY: sets two bits of EECR, which no other code uses, the second bit two cycles after the first.
            unsafe {
                asm!(
                    "sbi {eecr}, {eempe}",
                    "sbi {eecr}, {eepe}",
                    eecr = const EECR,
                    eempe = const EEMPE,
                    eepe = const EEPE,
                    options(nostack, preserves_flags),
                );
            }
        });
    }
}
