//! The LED on D13, which shows the heartbeat or a fault.
//!
//! D13 shares PORTB with servo pins, whose interrupts may change the port between any two instructions. Therefore D13
//! is changed only with `sbi` and `cbi`, each a single instruction that changes a single bit.

use core::arch::asm;

/// The I/O address of PORTB, for `sbi` and `cbi`.
const PORTB: u8 = 0x05;
/// The I/O address of DDRB, for `sbi`.
const DDRB: u8 = 0x04;
/// The bit number of D13 in both registers.
const BIT: u8 = 5;

/// Makes D13 an output.
pub fn start() {
    // SAFETY: sets only the bit of D13 in DDRB.
    unsafe {
        asm!("sbi {port}, {bit}", port = const DDRB, bit = const BIT, options(nostack, preserves_flags))
    }
}

/// Switches the LED on or off.
pub fn set(is_on: bool) {
    // SAFETY: either instruction changes only the bit of D13 in PORTB.
    unsafe {
        if is_on {
            asm!("sbi {port}, {bit}", port = const PORTB, bit = const BIT, options(nostack, preserves_flags))
        } else {
            asm!("cbi {port}, {bit}", port = const PORTB, bit = const BIT, options(nostack, preserves_flags))
        }
    }
}
