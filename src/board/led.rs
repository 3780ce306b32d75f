//! The LED on D13, which shows that the board is alive.
//!
//! D13 shares PORTB with servo pins, whose interrupts may change the port
//! between any two instructions. So `sbi` and `cbi` in inline assembly set D13:
//! each is one instruction that changes only one bit.

use core::arch::asm;

/// I/O addresses of PORTB and DDRB for `sbi`, and the bit of D13.
const PORTB: u8 = 0x05;
const DDRB: u8 = 0x04;
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
    // SAFETY: either changes one bit of PORTB, D13's, in one instruction.
    unsafe {
        if is_on {
            asm!("sbi {port}, {bit}", port = const PORTB, bit = const BIT, options(nostack, preserves_flags))
        } else {
            asm!("cbi {port}, {bit}", port = const PORTB, bit = const BIT, options(nostack, preserves_flags))
        }
    }
}
