//! Whether the numbers of a section can be those of a robot.
//!
//! A section whose CRC is right was written by somebody, not by chance; but by whom? An
//! index that leads out of a table, a pin that is the serial line's, a travel beyond what
//! a servo bears: none of it may reach the pulses. Whoever makes a section from a
//! robot.toml has checked far more, every sample of every gait among it.

use core::mem::offset_of;

use lizard_avr::{Region, flash, mul_unsigned};

use crate::calibration::Calibration;
use crate::curve::Table;
use crate::five_bar::{Bars, Range};
use crate::gait::{Channel, Gait, LONGEST_NAME, Wave};
use crate::guard::Clearance;
use crate::part::Servo;
use crate::pose::Pose;
use crate::robot::Robot;
use crate::section::{self, CURVES, Damage, MapHead, NUMBERS, Numbers, PARTS, Part, Place};
use crate::units::{CYCLES_PER_US, Sweep};

/// The shortest and the longest pulse of a hobby servo, cycles, with one of rounding.
const PULSES: [u16; 2] = [500 * CYCLES_PER_US - 1, 2500 * CYCLES_PER_US + 1];

flash! {
    /// Bytes of one of each [`Part`].
    const SIZES: [u16; PARTS] = [size_of::<Gait>() as u16, size_of::<Wave>() as u16, 1, 2];
    const LOOP: [Range; Bars::RANGES.len()] = Bars::RANGES;
}

/// The place of a field of the numbers, bytes from the section's beginning.
macro_rules! place {
    ($($field:tt)*) => {
        NUMBERS + offset_of!(Numbers, $($field)*) as u16
    };
}

impl<'a> Robot<'a> {
    /// The robot whose section is at the beginning of `flash`.
    ///
    /// # Errors
    /// Why there is none.
    #[inline(never)]
    pub fn open(flash: Region<'a>) -> Result<Self, Damage> {
        let length = section::find(flash)?;
        let robot = Self::at(flash.first(length));
        match robot.is_possible(length) {
            true => Ok(robot),
            false => Err(Damage::Impossible),
        }
    }

    /// Whether a section of this length is a robot's.
    #[inline(never)]
    fn is_possible(&self, length: u16) -> bool {
        self.has_parts(length)
            && self.has_pins()
            && self.has_gaits()
            && self.has_servos()
            && self.has_loops()
            && Clearance::of(self, &Pose::NEUTRAL).hazard(self).is_none()
    }

    /// The two bytes at a place.
    #[inline(never)]
    fn word(&self, at: u16) -> u16 {
        self.section().read(at)
    }

    /// Every part is in the section, and the maps share out their rows.
    #[inline(always)]
    fn has_parts(&self, length: u16) -> bool {
        let is_inside = |at: u16, count: u16, size: u16| {
            // Too long a part has no end within sixteen bits.
            let size = mul_unsigned(count, size);
            size >> 16 == 0 && at <= length && size as u16 <= length - at
        };
        let mut part = 0;
        while part < PARTS {
            let at = place!(parts) + (part * size_of::<Place>()) as u16;
            if !is_inside(self.word(at), self.word(at + 2), SIZES.at(part).load()) {
                return false;
            }
            part += 1;
        }
        let mut curve = place!(curves);
        while curve < place!(curves) + 2 * (CURVES * size_of::<u16>()) as u16 {
            if !is_inside(self.word(curve), 1, size_of::<Table>() as u16) {
                return false;
            }
            curve += 2;
        }
        let mut rows = 0;
        let mut head = place!(maps);
        while head < place!(maps) + 4 * size_of::<MapHead>() as u16 {
            rows += self.word(head) >> 8;
            head += 2;
        }
        rows <= self.place(Part::Rows).count
    }

    /// Pins of the board that are free, each used once; the rail's measures a voltage.
    #[inline(always)]
    fn has_pins(&self) -> bool {
        let rail = self.word(place!(rail)) as u8;
        let is_analogue = |pin: u8| pin.wrapping_sub(14) < 6;
        let mut first = place!(pins);
        while first < place!(pins) + 4 {
            let pin = self.word(first) as u8;
            if pin == rail || !is_analogue(pin) && pin.wrapping_sub(2) > 10 {
                return false;
            }
            let mut second = first + 1;
            while second < place!(pins) + 4 {
                if self.word(second) as u8 == pin {
                    return false;
                }
                second += 1;
            }
            first += 1;
        }
        rail == 0 || is_analogue(rail)
    }

    /// At least one gait, the first of which stands still; each with a name and
    /// waveforms that there are.
    #[inline(always)]
    fn has_gaits(&self) -> bool {
        let names = self.place(Part::Names).count;
        let waves = self.place(Part::Waves).count;
        let Place { at, count } = self.place(Part::Gaits);
        let mut gait = 0;
        while gait < count {
            let at = at + gait * size_of::<Gait>() as u16;
            let start = self.word(at + offset_of!(Gait, name_start) as u16);
            let length = self.word(at + offset_of!(Gait, name_length) as u16);
            if length.wrapping_sub(1) >= LONGEST_NAME as u16
                || start > names
                || length > names - start
            {
                return false;
            }
            let mut channel = at + offset_of!(Gait, channels) as u16;
            let behind = channel + 4 * size_of::<Channel>() as u16;
            while channel < behind {
                let moves = self.word(channel + offset_of!(Channel, gain) as u16) != 0;
                if self.word(channel) >= waves || gait == 0 && moves {
                    return false;
                }
                channel += size_of::<Channel>() as u16;
            }
            gait += 1;
        }
        count.wrapping_sub(1) < 255
    }

    /// Servos whose pulses stay within those that servos bear, as far as the gaits need.
    #[inline(always)]
    fn has_servos(&self) -> bool {
        let mut servo = 0;
        while servo < 4 {
            let name = Servo::ALL[servo];
            let calibration: Calibration = self.servo(name);
            let [least, most] = PULSES;
            let fits = |pulse: u16| pulse.wrapping_sub(least) <= most - least;
            if !calibration.reaches(Sweep(0))
                || !fits(calibration.pulse(calibration.min))
                || !fits(calibration.pulse(calibration.max))
                || !self.reach(name).is_within(&calibration)
            {
                return false;
            }
            servo += 1;
        }
        true
    }

    /// Loops with whose numbers the guard can work.
    #[inline(always)]
    fn has_loops(&self) -> bool {
        let mut end = 0;
        while end < 2 {
            let at = place!(ends) + end * size_of::<Bars>() as u16;
            let mut field = 0;
            while field < Bars::RANGES.len() {
                let range = LOOP.at(field).load();
                let value = self.word(at + range.at).wrapping_sub(range.least);
                if value > range.most - range.least {
                    return false;
                }
                field += 1;
            }
            // Couplers of different lengths lean, and the last curve says how far.
            let [left, right] = Bars::COUPLERS.map(|coupler| self.word(at + coupler));
            let skew = place!(curves) + (end + 1) * (CURVES * size_of::<u16>()) as u16 - 2;
            if left != right && self.word(skew) == 0 {
                return false;
            }
            end += 1;
        }
        true
    }
}
