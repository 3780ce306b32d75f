//! The checks of a robot's section beyond its CRC: no number may damage a servo or the board.
//!
//! A section with a correct CRC was made by a host that has checked every number and every sample of every gait. The
//! chip therefore checks only the numbers that could damage hardware: a pin of the serial port or the LED, a pulse
//! that a servo does not tolerate, and a neutral pose in which the linkage would jam as soon as the servos wake. Any
//! other wrong number can only make the robot walk badly: every address of flash is readable, every index is checked
//! where it is used, and each pulse stays within its servo's travel.

use core::mem::offset_of;

use lizard_avr::Region;

use crate::guard::clearance::Clearance;
use crate::numbers::calibration::Calibration;
use crate::numbers::gaits::{Input, Step};
use crate::numbers::part::Servo;
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;
use crate::numbers::section::{self, NUMBERS_OFFSET, Numbers, SectionError};
use crate::numbers::units::{CYCLES_PER_US, Sweep};

/// The shortest and the longest pulse that a hobby servo tolerates, CPU cycles, with an allowance of one cycle for
/// rounding.
const PULSE_LIMITS_CYCLES: [u16; 2] = [500 * CYCLES_PER_US - 1, 2500 * CYCLES_PER_US + 1];

/// True for D2 to D12 and A0 to A5, the pins that neither the serial port nor the LED uses.
const fn is_usable_pin(pin: u8) -> bool {
    pin.wrapping_sub(2) < 18 && pin != 13
}

/// The offset of a field of the numbers from the section's beginning, bytes.
macro_rules! offset {
    ($($field:tt)*) => {
        NUMBERS_OFFSET + offset_of!(Numbers, $($field)*) as u16
    };
}

impl<'a> Robot<'a> {
    /// Checks the section at the beginning of `flash` and returns its robot.
    ///
    /// # Errors
    /// Fails if there is no section of a valid robot.
    #[inline(never)]
    pub fn open(flash: Region<'a>) -> Result<Self, SectionError> {
        let length = section::check(flash)?;
        let robot = Self::at(flash.prefix(length));
        match robot.is_harmless() {
            true => Ok(robot),
            false => Err(SectionError::Harmful),
        }
    }

    /// True if the pins and pulses cannot damage the board or a servo, and the neutral pose is safe.
    fn is_harmless(&self) -> bool {
        self.has_valid_pins() && self.has_valid_servos() && {
            let neutral = Pose::NEUTRAL;
            Clearance::measure(self, &neutral)
                .first_hazard(self)
                .is_none()
        }
    }

    /// Reads the 16-bit number at an offset from the section's beginning, in bytes.
    #[inline(never)]
    fn read_word(&self, offset: u16) -> u16 {
        self.section().read(offset)
    }

    /// True if each servo has a usable pin of its own, and the pin that measures the rail, if any, is an analogue
    /// input.
    #[inline(always)]
    fn has_valid_pins(&self) -> bool {
        let rail_pin = self.read_word(offset!(rail_pin)) as u8;
        let mut pin_offset = offset!(pins);
        while pin_offset < offset!(pins) + 4 {
            let pin = self.read_word(pin_offset) as u8;
            if !is_usable_pin(pin) || self.count_users(pin) != 1 {
                return false;
            }
            pin_offset += 1;
        }
        rail_pin == 0 || rail_pin.wrapping_sub(14) < 6
    }

    /// Counts the users of a pin: the servos at the pin, and the rail if it is measured there.
    #[inline(never)]
    fn count_users(&self, pin: u8) -> u8 {
        let mut user_count = u8::from(self.read_word(offset!(rail_pin)) as u8 == pin);
        let mut pin_offset = offset!(pins);
        while pin_offset < offset!(pins) + 4 {
            user_count += u8::from(self.read_word(pin_offset) as u8 == pin);
            pin_offset += 1;
        }
        user_count
    }

    /// Returns the input of a step of the kind [`Step::UNTIL`]. Returns [`Input::NONE`] if its pin is not usable, or
    /// is used by a servo or the rail, which the input's pull-up would disturb.
    pub(crate) fn input(&self, step: &Step) -> Input {
        let input = Input::from_step(step);
        match is_usable_pin(input.pin()) && self.count_users(input.pin()) == 0 {
            true => input,
            false => Input::NONE,
        }
    }

    /// True if every servo's travel covers the neutral angle and the range that the gaits need, and the servo tolerates
    /// all pulses of its travel.
    #[inline(always)]
    fn has_valid_servos(&self) -> bool {
        let mut index = 0;
        while index < 4 {
            let servo = Servo::at(index);
            let calibration: Calibration = self.servo_calibration(servo);
            let [min, max] = PULSE_LIMITS_CYCLES;
            let is_in_pulse_range = |pulse: u16| pulse.wrapping_sub(min) <= max - min;
            if !calibration.reaches(Sweep(0))
                || !is_in_pulse_range(calibration.clamped_width(calibration.travel_min))
                || !is_in_pulse_range(calibration.clamped_width(calibration.travel_max))
                || !self.needed_travel(servo).is_within(&calibration)
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
