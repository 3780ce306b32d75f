//! The passive slider in each side of the body.
//!
//! Between the arm of a front crank and the arm of the rear crank on the same
//! side lies a telescope (the prismatic joint of the RRPRR five-bar). It has
//! no singularity of its own, since its block of the passive Jacobian is just
//! its length; but its halves can be pulled apart or run into each other.

use lizard_avr::{mul, mul_unsigned};

use crate::fivebar::upper;
use crate::root::root;
use crate::trig::Direction;

/// One side of the body, lengths in 1/256 mm.
#[derive(Clone, Copy, Debug)]
pub struct Slider {
    /// Front shaft's x less the rear shaft's.
    pub offset: i16,
    /// Distance between the two shafts along y.
    pub base: u16,
    /// Arm at the front crank, square to it.
    pub front: i16,
    /// Arm at the rear crank, square to it.
    pub rear: i16,
    /// The telescope's nominal length.
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

    /// The telescope's squared length, 1/65536 mm^2, with the front crank and
    /// the rear one (in tail-local angles) in these directions.
    ///
    /// Written for the left side, where the front arm leads its crank by a
    /// right angle; the right side is its mirror image.
    pub fn length_sq(&self, front: Direction, rear: Direction) -> u32 {
        let aside = upper((mul(self.rear, rear.sin) - mul(self.front, front.sin)) << 1);
        let ahead = upper((mul(self.front, front.cos) + mul(self.rear, rear.cos)) << 1);
        let x = (self.offset + aside).unsigned_abs();
        let y = self.base.wrapping_add(ahead as u16);
        mul_unsigned(x, x) + mul_unsigned(y, y)
    }

    /// The travel from nominal at a squared length, 1/256 mm.
    pub fn travel(&self, length_sq: u32) -> i16 {
        root(length_sq).wrapping_sub(self.nominal) as i16
    }

    /// The ends of the stroke, as travel from nominal, 1/256 mm.
    pub const fn stroke(&self) -> [i16; 2] {
        let nominal = self.nominal;
        [
            self.min.wrapping_sub(nominal) as i16,
            self.max.wrapping_sub(nominal) as i16,
        ]
    }

    /// The ends of the stroke, as squared lengths.
    pub const fn stroke_sq(&self) -> [u32; 2] {
        let (min, max) = (self.min as u32, self.max as u32);
        [min * min, max * max]
    }
}
