//! Contacts between pins and ground.

use crate::ffi;
use crate::{Pin, Uno};

impl Uno {
    /// Closes or opens a contact between a pin and ground, such as a push button. An input pin is low while its
    /// contact is closed, and high while the contact is open and the pin's pull-up is on.
    pub fn set_contact(&mut self, pin: Pin, is_closed: bool) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim keeps two bits.
        unsafe { ffi::uno_set_contact(self.raw, pin.number(), is_closed) }
    }
}
