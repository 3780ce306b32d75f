//! The supply voltage of the chip, for both VCC and AVCC.
//!
//! The voltage of a weak supply drops while servos move. Firmware can measure the drop only with the ADC, and does not
//! run below the brown-out level.

use crate::Uno;
use crate::ffi;

impl Uno {
    /// The current supply voltage, mV; 5000 by default.
    #[must_use]
    pub fn supply_mv(&self) -> f64 {
        // SAFETY: `raw` is valid (see `Uno`); the shim computes a number.
        unsafe { ffi::uno_supply_mv(self.raw) }
    }

    /// Sets the supply voltage, mV, from this cycle on.
    ///
    /// # Panics
    /// See [`Uno::ramp_supply_mv`].
    pub fn set_supply_mv(&mut self, mv: f64) {
        self.ramp_supply_mv(mv, 0);
    }

    /// Changes the supply voltage linearly to `mv` over `cycles` from now.
    ///
    /// Below the brown-out level minus half the hysteresis of 50 mV, the chip is held in reset: its pins are inputs,
    /// and time passes. Above the brown-out level plus half the hysteresis, the program starts, with BORF set. Below
    /// 1.8 V the byte that an EEPROM operation is erasing or writing is torn. Below 1.3 V the contents of SRAM are
    /// lost, and the next start is a power-on.
    ///
    /// With [`Fidelity::Stock`](crate::Fidelity) the ADC measures `mv` at once, and the supply never resets the chip.
    ///
    /// # Panics
    /// If the voltage is not between 0 and 10 000 mV.
    pub fn ramp_supply_mv(&mut self, mv: f64, cycles: u64) {
        assert!(
            (0.0..=10_000.0).contains(&mv),
            "the supply voltage must be between 0 and 10 000 mV, but is {mv} mV"
        );
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim keeps numbers, and a voltage in
        // this range can be converted in C.
        unsafe { ffi::uno_ramp_supply(self.raw, mv, cycles) }
    }

    /// Sets the brown-out level in mV; `None` or 0 disables brown-out detection. The default is 2700 mV, as set by the
    /// UNO's fuses; the level of a given chip may be 2500 to 2900 mV. Without brown-out detection, the chip runs down
    /// to 1.3 V and starts above 1.4 V.
    pub fn set_brown_out_mv(&mut self, level_mv: Option<f64>) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim keeps a number.
        unsafe { ffi::uno_set_brown_out(self.raw, level_mv.unwrap_or(0.0)) }
    }

    /// True while the supply holds the chip in reset.
    #[must_use]
    pub fn is_held_in_reset(&self) -> bool {
        // SAFETY: `raw` is valid (see `Uno`); the shim reads a flag.
        unsafe { ffi::uno_is_held_in_reset(self.raw) }
    }
}
