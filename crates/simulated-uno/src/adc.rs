//! The voltages that the ADC measures: the bandgap reference and the pins A0 to A5.

use crate::ffi;
use crate::{Pin, Uno};

impl Uno {
    /// Sets the voltage of the bandgap reference, mV; 1100 by default. The data sheet allows 1000 to 1200 mV, and each
    /// chip has its own constant value. With [`Fidelity::Stock`](crate::Fidelity) the voltage is always 1100 mV.
    ///
    /// # Panics
    /// If the voltage is not between 1000 and 1200 mV.
    pub fn set_bandgap_mv(&mut self, mv: f64) {
        assert!(
            (1000.0..=1200.0).contains(&mv),
            "the bandgap reference must be between 1000 and 1200 mV, but is {mv} mV"
        );
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim only stores the voltage.
        unsafe { ffi::uno_set_bandgap(self.raw, mv) }
    }

    /// Sets the voltage at one of the pins A0 to A5, mV; 0 by default. The pin's digital level does not change.
    ///
    /// # Panics
    /// If the pin is not one of A0 to A5.
    pub fn set_analog_mv(&mut self, pin: Pin, mv: u16) {
        let channel = pin.number().checked_sub(Pin::a(0).number());
        let channel = channel.unwrap_or_else(|| panic!("{pin} is not an analogue pin"));
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim takes the channel modulo the
        // number of channels.
        unsafe { ffi::uno_set_analog(self.raw, channel, mv) }
    }
}
