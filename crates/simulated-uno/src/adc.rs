//! The voltages that the ADC measures.

use crate::ffi;
use crate::{Pin, Uno};

impl Uno {
    /// Sets the bandgap reference, mV; 1100 unless set. The data sheet allows 1000 to
    /// 1200, and each chip has a constant value of its own. [`Fidelity::Stock`](crate::Fidelity)
    /// always has 1100.
    ///
    /// # Panics
    /// Beyond 1000 to 1200.
    pub fn set_bandgap_mv(&mut self, mv: f64) {
        assert!(
            (1000.0..=1200.0).contains(&mv),
            "a bandgap reference has 1000 to 1200 mV, not {mv}"
        );
        // SAFETY: `raw` is valid and ours alone, see `Uno`; the shim keeps a number.
        unsafe { ffi::uno_set_bandgap(self.raw, mv) }
    }

    /// Sets the voltage at one of A0 to A5 from now on, mV; 0 unless set. It does not change
    /// the pin's digital level.
    ///
    /// # Panics
    /// If the pin is not one of A0 to A5.
    pub fn set_analog_mv(&mut self, pin: Pin, mv: u16) {
        let channel = pin.number().checked_sub(Pin::a(0).number());
        let channel = channel.unwrap_or_else(|| panic!("{pin} is not an analogue pin"));
        // SAFETY: `raw` is valid and ours alone, see `Uno`; the shim takes the channel
        // modulo the eight that there are.
        unsafe { ffi::uno_set_analog(self.raw, channel, mv) }
    }
}
