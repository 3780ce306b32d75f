//! The supply voltage, which is VCC and AVCC of the chip in one.
//!
//! Four servos on a weak supply pull it down in mid-step. A firmware can see that
//! only through the ADC, and below the brown-out level it does not run at all.

use crate::Uno;
use crate::ffi;

impl Uno {
    /// The supply now, mV. 5000 unless set.
    #[must_use]
    pub fn supply_mv(&self) -> f64 {
        // SAFETY: `raw` is valid, see `Uno`; the shim computes a number.
        unsafe { ffi::uno_supply(self.raw) }
    }

    /// Sets the supply, mV, from this cycle on.
    ///
    /// # Panics
    /// See [`Uno::ramp_supply_mv`].
    pub fn set_supply_mv(&mut self, mv: f64) {
        self.ramp_supply_mv(mv, 0);
    }

    /// Lets the supply go in a straight line to `mv` within `cycles` from now.
    ///
    /// Below the brown-out level (less half the hysteresis of 50 mV) the chip is
    /// held in reset: pins are inputs, time passes. Above it (more the other half)
    /// the program starts, with BORF set. Below 1.8 V an EEPROM operation under way
    /// is torn; below 1.3 V the SRAM is lost, and the next start is a power-on.
    ///
    /// In [`Fidelity::Stock`](crate::Fidelity) the ADC sees the end of the line at
    /// once, and nothing is ever reset.
    ///
    /// # Panics
    /// Beyond 0 to 10 000.
    pub fn ramp_supply_mv(&mut self, mv: f64, cycles: u64) {
        assert!(
            (0.0..=10_000.0).contains(&mv),
            "a supply has 0 to 10 000 mV, not {mv}"
        );
        // SAFETY: `raw` is valid and ours alone, see `Uno`; the shim keeps numbers, and C can
        // convert such a voltage.
        unsafe { ffi::uno_ramp_supply(self.raw, mv, cycles) }
    }

    /// The brown-out level in mV, or none. 2700 mV, as the UNO's fuses have it,
    /// unless set; a given chip's may be 2500 to 2900. Without one, the chip runs
    /// down to 1.3 V and starts above 1.4 V.
    pub fn set_brown_out_mv(&mut self, level: Option<f64>) {
        // SAFETY: `raw` is valid and ours alone, see `Uno`; the shim keeps a number.
        unsafe { ffi::uno_set_brown_out(self.raw, level.unwrap_or(0.0)) }
    }

    /// Whether the supply holds the chip in reset.
    #[must_use]
    pub fn held_in_reset(&self) -> bool {
        // SAFETY: `raw` is valid, see `Uno`; the shim reads a flag.
        unsafe { ffi::uno_held_in_reset(self.raw) }
    }
}
