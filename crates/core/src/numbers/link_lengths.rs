//! The link lengths of a five-bar linkage, and factors that a host computes from them for the guard, so that the
//! firmware does not have to divide.

use crate::numbers::couplers::CouplerLengths;
use crate::numbers::units::Scale;

/// The upper limit, in steps, of two lengths: base plus both cranks (l0 + l1 + l4 in the paper), and each coupler.
pub const MAX_LENGTH_STEPS: f64 = 127.0 * 256.0;

/// The smallest allowed length of a coupler, in steps, so that 2^27 divided by it fits into an i16.
pub const MIN_COUPLER_STEPS: i16 = 4097;

lizard_avr::pod! {
    /// The link lengths of a five-bar, in steps of `scale`, and the factors derived from them. The guard's
    /// margins are sines of angles, so they do not depend on the scale.
    #[derive(Debug, PartialEq, Eq)]
    pub struct LinkLengths {
        pub(crate) couplers: CouplerLengths,
        /// The distance between the shafts.
        pub(crate) base: i16,
        pub(crate) left_crank: i16,
        pub(crate) right_crank: i16,
        /// The reciprocal of the couplers' product, scaled by `square_shift` and `area_shift`: 2^30 divided by the
        /// product after its shift to 2^14..2^15, at most 65535.
        pub(crate) area_reciprocal: u16,
        /// 2^27 divided by the left coupler.
        pub(crate) left_reciprocal: i16,
        /// 2^27 divided by the right coupler.
        pub(crate) right_reciprocal: i16,
        /// The shift that reduces the squared distance between the crank tips to fifteen bits.
        pub(crate) square_shift: u16,
        /// The shift that reduces the product of the rise (see [`crate::numbers::couplers`]) and the reduced squared
        /// distance to sixteen bits.
        pub(crate) area_shift: u16,
        pub(crate) scale: Scale,
        /// Pads the struct to a multiple of four bytes.
        pub(crate) padding: u16,
    }
}

impl LinkLengths {
    /// Creates the link lengths, in steps of `scale`, and computes their factors. The sum of base and cranks must be at
    /// most [`MAX_LENGTH_STEPS`].
    ///
    /// # Panics
    /// Panics if a coupler is shorter than [`MIN_COUPLER_STEPS`].
    pub const fn new(
        [base, left_crank, right_crank]: [i16; 3],
        [left_coupler, right_coupler]: [i16; 2],
        scale: Scale,
    ) -> Self {
        assert!(left_coupler >= MIN_COUPLER_STEPS && right_coupler >= MIN_COUPLER_STEPS);
        let half_sum = (left_coupler as u32 + right_coupler as u32) / 2;
        // Shifts the square of half the sum to fifteen bits.
        let square_shift = 17 - (half_sum * half_sum).leading_zeros() as u16;
        let mut product = (left_coupler as u64 * right_coupler as u64) >> square_shift;
        // Shifts the product to 2^14..2^15, so that its reciprocal uses all sixteen bits.
        let mut area_shift = 9;
        while product < 1 << 14 {
            product <<= 1;
            area_shift -= 1;
        }
        Self {
            base,
            left_crank,
            right_crank,
            couplers: CouplerLengths::new(left_coupler, right_coupler),
            square_shift,
            area_shift,
            area_reciprocal: if product > 1 << 14 {
                ((1u64 << 30) / product) as u16
            } else {
                u16::MAX
            },
            left_reciprocal: ((1 << 27) / left_coupler as i32) as i16,
            right_reciprocal: ((1 << 27) / right_coupler as i32) as i16,
            scale,
            padding: 0,
        }
    }

    /// The scale, which determines the length of a step.
    pub const fn scale(&self) -> Scale {
        self.scale
    }
}
