//! Resets: their causes, and the memory that survives them.

use crate::ffi;
use crate::{State, Uno};

/// The cause of a reset: a bit of MCUSR (data sheet 11.9.1).
// `enum reset_cause` of the shim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum ResetCause {
    /// The power was switched on.
    PowerOn = 1 << 0,
    /// The RESET pin was low, as when the serial port is opened.
    External = 1 << 1,
    /// The supply was below the brown-out level.
    BrownOut = 1 << 2,
    /// The watchdog expired.
    Watchdog = 1 << 3,
}

/// A reset that happened.
// `struct reset_event` of the shim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct ResetEvent {
    /// The cycle at which the program restarted.
    pub cycle: u64,
    /// The cause of the reset.
    pub cause: ResetCause,
}

impl Uno {
    /// Pulls the RESET pin low for an instant, as opening the serial port does. SRAM, EEPROM and r0 to r31 keep their
    /// contents, and an EEPROM operation continues. The I/O registers take their reset values, and every pin becomes
    /// an input and is recorded as low. Halted or crashed firmware restarts. Has no effect without power, or while the
    /// supply is too low.
    ///
    /// The chip's start-up delay (65 ms on a UNO) is not simulated.
    pub fn reset(&mut self) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim may reset the chip at any moment
        // between two runs, as here.
        unsafe { ffi::uno_reset(self.raw) }
        if self.state != State::Off {
            self.state = State::Alive;
        }
    }

    /// Switches the power off and on again at once, at the supply's current voltage. Only the EEPROM survives, and the
    /// byte of an operation in progress is torn (see [`Uno::set_torn_bits`]). SRAM and r0 to r31 contain noise.
    pub fn power_cycle(&mut self) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); as in `reset`.
        unsafe { ffi::uno_power_cycle(self.raw) }
        self.state = State::Alive;
    }

    /// Switches the simulated effects of a boot loader on or off; off by default. A boot loader such as the UNO's
    /// runs before the firmware at each start. It clears MCUSR, so the firmware cannot read the cause of the reset, and
    /// it switches the watchdog off. The simulated boot loader takes no time; a real one waits a second after an
    /// external reset. If no cycle has passed yet, the setting also applies to the current start. With
    /// [`Fidelity::Stock`](crate::Fidelity) the watchdog stays on.
    pub fn set_boot_loader(&mut self, is_present: bool) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim keeps a flag, and restarts a
        // chip that has not started.
        unsafe { ffi::uno_set_boot_loader(self.raw, is_present) }
    }

    /// Sets the seed of the noise that the next [`Uno::power_cycle`] leaves in SRAM and in r0 to r31. Each further
    /// power-on continues the sequence.
    pub fn set_noise_seed(&mut self, seed: u64) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim stores a number.
        unsafe { ffi::uno_set_noise_seed(self.raw, seed) }
    }

    /// All starts of the program so far, including the first power-on.
    #[must_use]
    pub fn reset_events(&self) -> Vec<ResetEvent> {
        self.copy_items(ffi::uno_reset_events)
    }
}
