//! Bytes that main and the interrupt handlers share.
//!
//! The processor loads or stores a byte with one instruction, which no interrupt can split, so a byte with a single
//! writer requires no lock. (The compiler's atomics would be equivalent, but on this target they disable interrupts
//! around each access.) Accesses are volatile, so the compiler neither omits nor reorders them; a single core without a
//! cache does not reorder them, either.

use core::cell::UnsafeCell;

use crate::pin::Pin;

/// A byte that main and interrupt handlers may read and write.
///
/// Single accesses are atomic; a read followed by a write is not. A value that depends on the old one must have a
/// single writer.
pub struct SharedByte(UnsafeCell<u8>);

// SAFETY: there is one core, and every access is a single load or store of one byte. No function returns a reference to
// the value.
unsafe impl Sync for SharedByte {}

impl SharedByte {
    /// Creates a byte with an initial value.
    #[must_use]
    pub const fn new(value: u8) -> Self {
        Self(UnsafeCell::new(value))
    }

    /// Reads the value.
    #[inline(always)]
    pub fn get(&self) -> u8 {
        // SAFETY: the pointer is that of the cell; for concurrent accesses see `Sync`.
        unsafe { self.0.get().read_volatile() }
    }

    /// Sets the value.
    #[inline(always)]
    pub fn set(&self, value: u8) {
        // SAFETY: as in `get`.
        unsafe { self.0.get().write_volatile(value) }
    }
}

/// A word of two bytes. An interrupt may occur between the accesses to the two bytes, so the program must ensure that
/// reader and writer do not access the word at the same time.
pub struct SharedWord {
    low: SharedByte,
    high: SharedByte,
}

impl SharedWord {
    /// Creates a word with an initial value.
    #[must_use]
    pub const fn new(value: u16) -> Self {
        let [low, high] = value.to_le_bytes();
        Self {
            low: SharedByte::new(low),
            high: SharedByte::new(high),
        }
    }

    /// Reads the low byte, then the high byte.
    #[inline(always)]
    pub fn bytes(&self) -> [u8; 2] {
        [self.low.get(), self.high.get()]
    }

    /// Reads the value, the low byte first.
    #[inline(always)]
    pub fn get(&self) -> u16 {
        u16::from_le_bytes(self.bytes())
    }

    /// Sets the value, the low byte first.
    #[inline(always)]
    pub fn set(&self, value: u16) {
        let [low, high] = value.to_le_bytes();
        self.low.set(low);
        self.high.set(high);
    }
}

/// A counter of faults that interrupt handlers increment and main reads. It saturates at 65535.
pub struct SharedCounter(SharedWord);

impl Default for SharedCounter {
    fn default() -> Self {
        Self::new()
    }
}

impl SharedCounter {
    /// Creates a counter at zero.
    #[must_use]
    pub const fn new() -> Self {
        Self(SharedWord::new(0))
    }

    /// Counts a fault. Call this function only in interrupt handlers, which cannot interrupt each other.
    #[inline(always)]
    pub fn count(&self) {
        // Incremented byte by byte, because the usual path then takes only four instructions.
        match self.0.low.get() {
            u8::MAX => match self.0.high.get() {
                u8::MAX => {}
                high => {
                    self.0.high.set(high + 1);
                    self.0.low.set(0);
                }
            },
            low => self.0.low.set(low + 1),
        }
    }

    /// Reads the count. Disables interrupts for about 10 cycles.
    #[cfg(any(doc, target_arch = "avr"))]
    pub fn read(&self) -> u16 {
        let sreg: u8;
        // SAFETY: reads SREG, then clears the interrupt flag.
        unsafe { core::arch::asm!("in {}, 0x3f", "cli", out(reg) sreg, options(nostack)) };
        let count = self.0.get();
        // SAFETY: restores the interrupt flag.
        unsafe { core::arch::asm!("out 0x3f, {}", in(reg) sreg, options(nostack)) };
        count
    }
}

/// Returns the address of the PORT register and the mask of each pin, followed by zeros up to `SIZE` entries.
#[must_use]
pub const fn pin_table<const SERVO_COUNT: usize, const SIZE: usize>(
    pins: [Pin; SERVO_COUNT],
) -> [[SharedByte; 2]; SIZE] {
    let mut table = [const { [const { SharedByte::new(0) }; 2] }; SIZE];
    let mut slot = 0;
    while slot < SERVO_COUNT {
        let Pin { port, mask } = pins[slot];
        table[slot] = [SharedByte::new(port), SharedByte::new(mask)];
        slot += 1;
    }
    table
}
