//! The bars of a five-bar linkage, and the factors that the guard uses.
//!
//! A host derives the factors from the bars, so that the device requires no division.

use crate::numbers::couplers::CouplerLengths;
use crate::numbers::units::Scale;

/// The upper limit, in steps, of the sum of base and cranks (l0 + l1 + l4 in the paper) and of each coupler.
pub const MAX_LENGTH_STEPS: f64 = 127.0 * 256.0;

/// The length of the shortest coupler, in steps.
pub const MIN_COUPLER_STEPS: i16 = 4097;

lizard_avr::pod! {
    /// The bars of a five-bar, and the factors derived from them. Lengths are in steps of `scale`; the margins do not
    /// depend on the scale.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Bars {
        pub(crate) couplers: CouplerLengths,
        /// The distance between the shafts.
        pub(crate) base: i16,
        pub(crate) left_crank: i16,
        pub(crate) right_crank: i16,
        /// `1 / (4 a b)` for the couplers `a` and `b`, scaled according to the two shifts.
        pub(crate) area_reciprocal: u16,
        /// 2^27 divided by the left coupler.
        pub(crate) left_reciprocal: i16,
        /// 2^27 divided by the right coupler.
        pub(crate) right_reciprocal: i16,
        /// The shift that reduces the squared distance between the crank tips to fifteen bits.
        pub(crate) square_shift: u16,
        /// The shift that reduces the product of the rise and the reduced squared distance to sixteen bits.
        pub(crate) area_shift: u16,
        pub(crate) scale: Scale,
        /// Padding of the fields above to a multiple of four bytes.
        pub(crate) padding: u16,
    }
}

impl Bars {
    /// A linkage without bars, which never closes.
    pub const NONE: Self = Self {
        base: 0,
        left_crank: 0,
        right_crank: 0,
        couplers: CouplerLengths::NONE,
        square_shift: 1,
        area_shift: 0,
        area_reciprocal: 0,
        left_reciprocal: 0,
        right_reciprocal: 0,
        scale: Scale { bits: 0 },
        padding: 0,
    };

    /// Creates bars with these lengths in steps: the distance between the shafts, the left and the right crank, whose
    /// sum is at most [`MAX_LENGTH_STEPS`]; and the left and the right coupler.
    ///
    /// # Panics
    /// Panics if a coupler is shorter than [`MIN_COUPLER_STEPS`].
    pub const fn new([base, left, right]: [i16; 3], [a, b]: [i16; 2], scale: Scale) -> Self {
        assert!(a >= MIN_COUPLER_STEPS && b >= MIN_COUPLER_STEPS);
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
            left_crank: left,
            right_crank: right,
            couplers: CouplerLengths::new(a, b),
            square_shift,
            area_shift,
            area_reciprocal: if area > 1 << 14 {
                ((1u64 << 30) / area) as u16
            } else {
                u16::MAX
            },
            left_reciprocal: ((1 << 27) / a as i32) as i16,
            right_reciprocal: ((1 << 27) / b as i32) as i16,
            scale,
            padding: 0,
        }
    }

    /// The scale, which determines the length of a step.
    pub const fn scale(&self) -> Scale {
        self.scale
    }
}
