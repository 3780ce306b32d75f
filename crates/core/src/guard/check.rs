//! The checks of a section beyond its CRC: no number in it may harm a servo or the board.
//!
//! A section whose CRC is right was sealed by a host, and that host has checked every number and every sample
//! of every gait. So the device trusts the numbers, except those that reach the hardware: a pin that is the
//! serial line's or the LED's, a pulse that a servo does not tolerate, a neutral pose in which the linkage
//! would jam as soon as the servos wake. Any other number can make the robot walk badly, but cannot do more
//! harm: every address of flash can be read, every index is checked where it is used, and each pulse stays
//! within its servo's travel.

use core::mem::offset_of;

use lizard_avr::Region;

use crate::guard::clearance::Clearance;
use crate::numbers::calibration::Calibration;
use crate::numbers::gaits::{Input, Step};
use crate::numbers::part::Servo;
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;
use crate::numbers::section::{self, Damage, NUMBERS, Numbers};
use crate::numbers::units::{CYCLES_PER_US, Sweep};

/// The shortest and the longest pulse of a hobby servo, CPU cycles, with a cycle of tolerance for rounding.
const PULSE_LIMITS: [u16; 2] = [500 * CYCLES_PER_US - 1, 2500 * CYCLES_PER_US + 1];

/// True for a pin other than those of the serial line and the LED: D2 to D12 and A0 to A5.
const fn is_free(pin: u8) -> bool {
    pin.wrapping_sub(2) < 18 && pin != 13
}

/// The offset of a field of the numbers, bytes from the section's beginning.
macro_rules! offset {
    ($($field:tt)*) => {
        NUMBERS + offset_of!(Numbers, $($field)*) as u16
    };
}

impl<'a> Robot<'a> {
    /// The robot whose section is at the beginning of `flash`.
    ///
    /// # Errors
    /// Returns the reason why the section is not a usable robot.
    #[inline(never)]
    pub fn open(flash: Region<'a>) -> Result<Self, Damage> {
        let length = section::check(flash)?;
        let robot = Self::at(flash.first(length));
        match robot.is_harmless() {
            true => Ok(robot),
            false => Err(Damage::Impossible),
        }
    }

    /// True if pins and pulses suit servos and the neutral pose is safe.
    fn is_harmless(&self) -> bool {
        self.has_valid_pins() && self.has_valid_servos() && {
            let neutral = Pose::NEUTRAL;
            Clearance::of(self, &neutral).first_hazard(self).is_none()
        }
    }

    /// Reads the two bytes at an offset.
    #[inline(never)]
    fn read_word(&self, offset: u16) -> u16 {
        self.section().read(offset)
    }

    /// True if each servo has a free pin of the board to itself, and the rail's pin, if any, is an analogue input.
    #[inline(always)]
    fn has_valid_pins(&self) -> bool {
        let rail = self.read_word(offset!(rail)) as u8;
        let mut pin_offset = offset!(pins);
        while pin_offset < offset!(pins) + 4 {
            let pin = self.read_word(pin_offset) as u8;
            if !is_free(pin) || self.count_users(pin) != 1 {
                return false;
            }
            pin_offset += 1;
        }
        rail == 0 || rail.wrapping_sub(14) < 6
    }

    /// The number of uses of a pin, by servos and the rail.
    #[inline(never)]
    fn count_users(&self, pin: u8) -> u8 {
        let mut users = u8::from(self.read_word(offset!(rail)) as u8 == pin);
        let mut pin_offset = offset!(pins);
        while pin_offset < offset!(pins) + 4 {
            users += u8::from(self.read_word(pin_offset) as u8 == pin);
            pin_offset += 1;
        }
        users
    }

    /// The input of a record of the kind [`Step::UNTIL`]; [`Input::NONE`] if its pin is not free, or is
    /// used by a servo or the rail, since the pull-up would act on it.
    pub(crate) fn input(&self, step: &Step) -> Input {
        let input = Input::of_step(step);
        match is_free(input.pin()) && self.count_users(input.pin()) == 0 {
            true => input,
            false => Input::NONE,
        }
    }

    /// True if every servo's travel contains the neutral angle and all sweeps that the gaits need, and has
    /// only pulses that a servo tolerates.
    #[inline(always)]
    fn has_valid_servos(&self) -> bool {
        let mut index = 0;
        while index < 4 {
            let servo = Servo::at(index);
            let calibration: Calibration = self.calibration_of(servo);
            let [min, max] = PULSE_LIMITS;
            let is_in_pulse_range = |pulse: u16| pulse.wrapping_sub(min) <= max - min;
            if !calibration.reaches(Sweep(0))
                || !is_in_pulse_range(calibration.pulse(calibration.min))
                || !is_in_pulse_range(calibration.pulse(calibration.max))
                || !self.reach(servo).is_within(&calibration)
            {
                return false;
            }
            index += 1;
        }
        true
    }
}

#[cfg(test)]
mod tests;
