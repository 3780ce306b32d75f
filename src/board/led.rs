//! The LED on D13, which shows that the board is alive.
//!
//! D13 shares PORTB with servo pins, whose interrupts may change the port
//! between any two instructions. So `sbi` and `cbi` in inline assembly set D13:
//! each is one instruction that changes only one bit.

use core::arch::asm;

/// The I/O address of PORTB, for `sbi` and `cbi`.
const PORTB: u8 = 0x05;
/// The I/O address of DDRB, for `sbi`.
const DDRB: u8 = 0x04;
/// The number of D13's bit in both registers.
const BIT: u8 = 5;

/// Makes D13 an output.
pub fn start() {
    // SAFETY: sets one bit of DDRB, D13's.
    unsafe {
        asm!("sbi {port}, {bit}", port = const DDRB, bit = const BIT, options(nostack, preserves_flags))
    }
}

/// Switches the LED on or off.
pub fn set(is_on: bool) {
    // SAFETY: either instruction changes only one bit of PORTB, D13's.
    unsafe {
        if is_on {
            asm!("sbi {port}, {bit}", port = const PORTB, bit = const BIT, options(nostack, preserves_flags))
        } else {
            asm!("cbi {port}, {bit}", port = const PORTB, bit = const BIT, options(nostack, preserves_flags))
        }
    }
}
