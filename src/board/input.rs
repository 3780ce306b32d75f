//! The contacts for which routines wait, each between a pin and ground.
//!
//! A contact's pin shares its port with servo pins, whose interrupts may change the port between any two instructions.
//! Therefore a single store to the PIN register switches the pull-up on: each 1 in the stored byte toggles this bit of
//! PORT (data sheet, 14.2.2).

use servo_pulses::Pin;

/// The distance from a port's PORT register down to its PIN register (data sheet, 14.4).
const PIN_BELOW_PORT: u8 = 2;

/// Switches a pin's pull-up on, and reads the contact at the pin: true while the contact is closed. `number` is the
/// Arduino number of the pin.
pub fn read_contact(number: u8) -> bool {
    let Some(pin) = Pin::arduino(number) else {
        return false;
    };
    let port_register = usize::from(pin.port()) as *const u8;
    let pin_register = usize::from(pin.port() - PIN_BELOW_PORT) as *mut u8;
    // SAFETY: both are registers of the chip. No other code drives this pin
    // ([`lizard_core::control::Controller::awaited_input`]), and no other bit of the port changes.
    unsafe {
        if port_register.read_volatile() & pin.mask() == 0 {
            pin_register.write_volatile(pin.mask());
        }
        pin_register.read_volatile() & pin.mask() == 0
    }
}
