//! The units of the core, and every conversion between them.
//!
//! Floating point is slow on an 8-bit processor. Therefore each quantity is an integer whose step is finer than the
//! robot's resolution. A value that modules exchange has its own type; inside a formula it is a plain integer.
//!
//! | quantity | type | step |
//! |---|---|---|
//! | angle, chassis frame | [`Angle`], wraps after a turn | 1/65536 turn = 0.0055 deg |
//! | sweep, an angle relative to a servo's neutral angle | [`Sweep`] | 1/65536 turn |
//! | angle at the console | `i32`, `u16` | 0.01 deg |
//! | length | `i16`, `u16` | [`Scale`]: 1/256 mm for a robot of the paper's size |
//! | margin, a sine | [`Sine`], Q15 | 1/32768 |
//! | pulse width | [`PulseWidth`] | one CPU cycle, 62.5 ns |
//! | phase of a gait | `u32` | 1/2^24 cycle |
//! | fraction of a move's duration | `u16`, Q15 | 1/32768 |
//! | pace | `u16`, Q10 | 1/1024 |

use lizard_avr::{mul, mul_unsigned};

/// The number of hundredths of a degree in a turn.
pub const CENTIDEG_PER_TURN: i32 = 36_000;

/// The number of frames in a second; every servo gets one pulse in each frame.
pub const FRAMES_PER_SECOND: u16 = 50;

/// The duration of a frame, ms.
pub const FRAME_MS: u16 = 1000 / FRAMES_PER_SECOND;

/// The number of CPU cycles in a microsecond; the UNO runs at 16 MHz.
pub const CYCLES_PER_US: u16 = 16;

/// The number of steps of an [`Angle`] in a turn.
pub const STEPS_PER_TURN: i32 = 1 << 16;

/// 1.0 in Q15, one step more than the largest sine.
pub const ONE_Q15: i32 = 1 << 15;

/// 1.0 in Q14, the format of gains.
pub const ONE_Q14: i32 = 1 << 14;

/// One gait cycle in steps of a phase.
pub const CYCLE: u32 = 1 << 24;

/// One gait cycle in steps of [`phase16`], the argument of the waveforms.
pub const CYCLE16: u32 = 1 << 16;

/// An angle in the chassis frame, 1/65536 turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(transparent)]
pub struct Angle(pub u16);

lizard_avr::pod!(Angle: u16);

/// The angle by which a servo has turned from its neutral angle, counter-clockwise positive, 1/65536 turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct Sweep(pub i16);

lizard_avr::pod!(Sweep: i16);

/// A margin: the sine of the angle between two links, Q15.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[repr(transparent)]
pub struct Sine(pub i16);

lizard_avr::pod!(Sine: i16);

/// The width of a pulse in CPU cycles of 62.5 ns; 0 means no pulse.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct PulseWidth(pub u16);

impl From<PulseWidth> for u16 {
    fn from(width: PulseWidth) -> Self {
        width.0
    }
}

lizard_avr::pod!(PulseWidth: u16);

lizard_avr::pod! {
    /// The scale of a mechanism's lengths: a millimetre has 2^`bits` steps.
    ///
    /// The scale depends on the robot's size, so that the lengths of any robot fit into sixteen bits.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Scale {
        /// The binary logarithm of the number of steps in a millimetre, at most 14.
        pub bits: u16,
    }
}

impl Angle {
    /// Converts hundredths of a degree, at most one turn in either direction, to an angle, with an error of at most
    /// 0.004 deg.
    #[inline(never)]
    pub fn from_centideg(centideg: i32) -> Self {
        let magnitude = centideg.unsigned_abs() as u16;
        // A full turn counts as 0. 65536/36000 is nearly 1 + 53769/65536; the error is below a fifth of a step per
        // turn.
        let magnitude = if magnitude == CENTIDEG_PER_TURN as u16 {
            0
        } else {
            magnitude
        };
        let angle =
            magnitude.wrapping_add(((mul_unsigned(magnitude, 53_769) + 0x8000) >> 16) as u16);
        Self(if centideg < 0 {
            angle.wrapping_neg()
        } else {
            angle
        })
    }

    /// Converts the angle to hundredths of a degree, 0..36000. For an angle from [`Angle::from_centideg`] the result is
    /// exactly its argument, modulo a turn, because the step of an angle is finer than a hundredth of a degree.
    pub fn centideg(self) -> u16 {
        // The last step of a turn, 359.9945 deg, does not round to 360.
        ((mul_unsigned(self.0, CENTIDEG_PER_TURN as u16) + 0x8000) >> 16) as u16
    }

    /// Returns this angle plus a sweep.
    pub const fn offset_by(self, sweep: Sweep) -> Self {
        Self(self.0.wrapping_add(sweep.0 as u16))
    }

    /// Returns the sweep from this angle to `other`, in the direction of the shorter turn.
    pub const fn sweep_to(self, other: Self) -> Sweep {
        Sweep(other.0.wrapping_sub(self.0) as i16)
    }
}

impl Sine {
    /// Converts the sine to thousandths, rounded to nearest.
    pub fn thousandths(self) -> i16 {
        ((mul(self.0, 1000) + (1 << 14)) >> 15) as i16
    }
}

impl Scale {
    /// The finest scale, with steps of 1/16384 mm.
    pub const FINEST: Self = Self { bits: 14 };

    /// Converts a length in steps to hundredths of a millimetre, rounded to nearest. The magnitude of `length` must fit
    /// into 16 bits.
    #[inline(always)]
    pub fn hundredths(self, length: i32) -> i32 {
        let magnitude = mul_unsigned(length.unsigned_abs() as u16, 100) as i32;
        let signed_product = if length < 0 { -magnitude } else { magnitude };
        let bits = self.bits.into();
        (signed_product + (1i32.wrapping_shl(bits) >> 1)).wrapping_shr(bits)
    }
}

/// Returns the highest sixteen of a phase's 24 bits, the argument of the waveforms, 1/65536 cycle.
pub const fn phase16(phase: u32) -> u16 {
    (phase >> 8) as u16
}

/// Converts a phase to thousandths of a cycle, 0..=999.
pub fn thousandths_from_phase(phase: u32) -> u16 {
    (mul_unsigned(phase16(phase), 1000) >> 16) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::to_degrees;

    /// Computes the smaller angle between two directions, deg.
    fn angle_between(a: f64, b: f64) -> f64 {
        let difference = (a - b).rem_euclid(360.0);
        difference.min(360.0 - difference)
    }

    #[test]
    fn an_angle_from_hundredths_of_a_degree_has_an_error_of_at_most_0_004_degrees() {
        for centideg in -36_000..=36_000 {
            let angle = Angle::from_centideg(centideg);
            let error = angle_between(to_degrees(angle), f64::from(centideg) / 100.0);
            // Half a step is 0.0027 deg; the rest comes from the rounding of the factor.
            assert!(error <= 0.004, "{centideg}: {error} deg");
        }
    }

    #[test]
    fn every_hundredth_of_a_degree_survives_conversion_to_an_angle_and_back() {
        for centideg in 0..36_000u16 {
            assert_eq!(Angle::from_centideg(centideg.into()).centideg(), centideg);
        }
    }

    #[test]
    fn every_angle_converts_to_the_nearest_hundredth_of_a_degree() {
        for angle in (0..=u16::MAX).map(Angle) {
            let centideg = angle.centideg();
            assert!(centideg < 36_000);
            let error = angle_between(f64::from(centideg) / 100.0, to_degrees(angle));
            assert!(error <= 0.005 + 1e-9, "{angle:?}: {error}");
        }
    }

    #[test]
    fn a_sweep_is_the_counter_clockwise_difference_of_two_angles() {
        for start in (0..=u16::MAX).step_by(771).map(Angle) {
            for sweep in (i16::MIN..=i16::MAX).map(Sweep) {
                assert_eq!(start.sweep_to(start.offset_by(sweep)), sweep);
            }
        }
        assert_eq!(Angle(0xffff).offset_by(Sweep(2)), Angle(1));
        assert_eq!(Angle(1).sweep_to(Angle(0xffff)), Sweep(-2));
    }

    #[test]
    fn every_margin_converts_to_the_nearest_thousandth() {
        for raw in i16::MIN..=i16::MAX {
            let exact = f64::from(raw) * 1000.0 / 32768.0;
            let thousandths = f64::from(Sine(raw).thousandths());
            assert!((thousandths - exact).abs() <= 0.5, "{raw}: {thousandths}");
        }
    }

    #[test]
    fn lengths_convert_to_the_nearest_hundredth_of_a_millimetre() {
        for bits in 0..=14 {
            let scale = Scale { bits };
            let lengths = (-65_535..=65_535).step_by(7);
            for length in lengths.chain([-65_535, -1, 0, 1, 65_535]) {
                let exact = f64::from(length) * 100.0 / f64::from(1 << bits);
                let hundredths = f64::from(scale.hundredths(length));
                let error = hundredths - exact;
                assert!(error.abs() <= 0.5, "{length} at {bits}: {hundredths}");
            }
        }
    }

    #[test]
    fn a_phase_converts_to_thousandths_rounded_down_and_always_below_a_whole_cycle() {
        for phase in (0..CYCLE).step_by(97).chain([CYCLE - 1]) {
            let exact = f64::from(phase) * 1000.0 / f64::from(CYCLE);
            let thousandths = thousandths_from_phase(phase);
            // Waveforms and the console use only the highest sixteen of the 24 bits.
            let rounding_loss = exact - f64::from(thousandths);
            let allowed_loss = 0.0..1.0 + 1000.0 / 65536.0;
            assert!(allowed_loss.contains(&rounding_loss), "{phase}");
            assert!(thousandths < 1000);
            assert_eq!(u32::from(phase16(phase)), phase / 256);
        }
    }
}
