//! The bars of a five-bar linkage, and the factors that the guard derives from them.
//!
//! A host computes the factors in advance, so that the device needs no division.

use crate::numbers::couplers::Coupling;
use crate::numbers::units::Scale;

/// The largest length of l0 + l1 + l4, and of each coupler, in steps.
pub const MAX_STEPS: f64 = 127.0 * 256.0;

/// The shortest coupler, in steps.
pub const MIN_COUPLER: i16 = 4097;

lizard_avr::plain! {
    /// The bars of one loop, and factors that follow from them. Lengths are in steps of `scale`;
    /// margins do not depend on it.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Bars {
        pub(crate) couplers: Coupling,
        pub(crate) base: i16,
        pub(crate) left: i16,
        pub(crate) right: i16,
        /// `1 / (4 a b)`, in the scale that results from the two shifts.
        pub(crate) per_area: u16,
        /// `2^27` divided by the left coupler.
        pub(crate) per_left: i16,
        /// `2^27` divided by the right coupler.
        pub(crate) per_right: i16,
        /// The shift that reduces a squared distance of the crank tips to fifteen bits.
        pub(crate) square_shift: u16,
        /// The shift that reduces the rise times that squared distance to sixteen bits.
        pub(crate) area_shift: u16,
        pub(crate) scale: Scale,
        /// Unused: it pads the fields above to a multiple of four bytes.
        pub(crate) padding: u16,
    }
}

impl Bars {
    /// A linkage without bars, which never closes.
    pub const NONE: Self = Self {
        base: 0,
        left: 0,
        right: 0,
        couplers: Coupling::NONE,
        square_shift: 1,
        area_shift: 0,
        per_area: 0,
        per_left: 0,
        per_right: 0,
        scale: Scale { bits: 0 },
        padding: 0,
    };

    /// A loop with these bars, in steps: the distance between the shafts, the left and the right crank, whose sum is
    /// at most [`MAX_STEPS`]; and the two couplers.
    ///
    /// # Panics
    /// If a coupler is shorter than [`MIN_COUPLER`].
    pub const fn new([base, left, right]: [i16; 3], [a, b]: [i16; 2], scale: Scale) -> Self {
        assert!(a >= MIN_COUPLER && b >= MIN_COUPLER);
        let half_sum = (a as u32 + b as u32) / 2;
        let square_shift = 17 - (half_sum * half_sum).leading_zeros() as u16;
        let mut area = (a as u64 * b as u64) >> square_shift;
        let mut area_shift = 9;
        while area < 1 << 14 {
            area <<= 1;
            area_shift -= 1;
        }
        Self {
            base,
            left,
            right,
            couplers: Coupling::new(a, b),
            square_shift,
            area_shift,
            per_area: if area > 1 << 14 {
                ((1u64 << 30) / area) as u16
            } else {
                u16::MAX
            },
            per_left: ((1 << 27) / a as i32) as i16,
            per_right: ((1 << 27) / b as i32) as i16,
            scale,
            padding: 0,
        }
    }

    /// The length of one step.
    pub const fn scale(&self) -> Scale {
        self.scale
    }

    /// The couplers of the loop.
    pub const fn couplers(&self) -> Coupling {
        self.couplers
    }
}
