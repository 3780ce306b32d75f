//! The prismatic joint in each side of the body.
//!
//! Between the arm of a front crank and the arm of the rear crank on the same
//! side lies a slider of two halves (the RRPRR five-bar). It has no singularity
//! of its own, since its block of the passive Jacobian is just its length; but its
//! halves can be pulled apart or run into each other.

use lizard_avr::{mul, mul_unsigned};

use crate::five_bar::upper;
use crate::trig::Direction;
use crate::units::Scale;

/// The longest that a side may be, in steps: the chassis and both arms; and the
/// slider.
pub const LONGEST: f64 = 255.0 * 256.0;

/// The longest that both arms and the offset may be together, in steps: what they
/// add up to has a sign.
pub const LONGEST_ARMS: f64 = 127.0 * 256.0;

/// One side of the body, lengths in steps of `scale`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slider {
    /// How many steps are a millimetre.
    pub scale: Scale,
    /// Front shaft's x less the rear shaft's.
    pub offset: i16,
    /// Distance between the two shafts along y.
    pub base: u16,
    /// Arm at the front crank, at a right angle to it.
    pub front: i16,
    /// Arm at the rear crank, at a right angle to it.
    pub rear: i16,
    /// The slider's nominal length.
    pub nominal: u16,
    /// The shortest that its stroke allows.
    pub min: u16,
    /// The longest.
    pub max: u16,
}

impl Slider {
    /// The right side as a left one.
    pub const fn mirrored(self) -> Self {
        Self {
            offset: -self.offset,
            ..self
        }
    }

    /// The slider's squared length in steps, with the front crank and the rear
    /// one (in the tail's own frame) in these directions.
    ///
    /// Written for the left side, where the front arm leads its crank by a
    /// right angle; the right side is its mirror image.
    pub fn length_sq(&self, front: Direction, rear: Direction) -> u32 {
        let aside = upper((mul(self.rear, rear.sin) - mul(self.front, front.sin)) << 1);
        let ahead = upper((mul(self.front, front.cos) + mul(self.rear, rear.cos)) << 1);
        let x = (self.offset + aside).unsigned_abs();
        let y = (i32::from(self.base) + i32::from(ahead)).unsigned_abs() as u16;
        mul_unsigned(x, x) + mul_unsigned(y, y)
    }

    /// True where a squared length is within the stroke.
    pub const fn allows(&self, length_sq: u32) -> bool {
        let (min, max) = (self.min as u32, self.max as u32);
        min * min <= length_sq && length_sq <= max * max
    }

    /// The travel from nominal at a length, in hundredths of a millimetre.
    #[inline(always)]
    pub fn travel(&self, length: u16) -> i32 {
        self.scale
            .hundredths(i32::from(length) - i32::from(self.nominal))
    }
}
