//! Integer square root and division, computed bit by bit.
//!
//! The reported length of a slider is a root; a voltage and the limits of a travel are quotients. The chip has no
//! instruction for roots or quotients, and the compiler's 32-bit division takes a kilobyte of flash.

use lizard_avr::mul_unsigned;

/// Computes the largest integer whose square is at most `value`.
///
/// Each iteration computes one bit of the result, without dividing. The number of iterations does not depend on
/// `value`.
pub const fn isqrt(value: u32) -> u16 {
    let mut remainder = value;
    let mut root: u32 = 0;
    let mut bit: u32 = 1 << 30;
    while bit != 0 {
        let trial = root + bit;
        root >>= 1;
        if remainder >= trial {
            remainder -= trial;
            root += bit;
        }
        bit >>= 2;
    }
    root as u16
}

/// Computes `dividend / divisor`, rounded down. Saturates at 65535, which is also the result for the divisor 0.
#[inline(never)]
pub fn saturating_div(dividend: u32, divisor: u16) -> u16 {
    let (mut remainder, mut quotient) = (dividend, 0);
    let mut bit = 1u16 << 15;
    while bit > 0 {
        let product = mul_unsigned(divisor, bit);
        if remainder >= product {
            remainder -= product;
            quotient |= bit;
        }
        bit >>= 1;
    }
    quotient
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn has_correct_root(value: u32) -> bool {
        let root = u64::from(isqrt(value));
        root * root <= value.into() && u64::from(value) < (root + 1) * (root + 1)
    }

    #[test]
    fn every_square_and_its_neighbours_have_the_correct_root() {
        for side in 0..=u32::from(u16::MAX) {
            let square = side * side;
            assert_eq!(u32::from(isqrt(square)), side);
            assert!(has_correct_root(square.saturating_sub(1)));
            assert!(has_correct_root(square.saturating_add(1)));
        }
        assert_eq!(isqrt(u32::MAX), u16::MAX);
    }

    proptest! {
        #[test]
        fn every_root_is_the_largest_integer_whose_square_is_at_most_the_argument(value: u32) {
            prop_assert!(has_correct_root(value));
        }

        #[test]
        fn a_quotient_is_rounded_down_and_limited_to_sixteen_bits(
            dividend: u32,
            divisor: u16,
        ) {
            let exact = dividend.checked_div(divisor.into());
            let expected = exact.map_or(u16::MAX, |exact| exact.min(u16::MAX.into()) as u16);
            prop_assert_eq!(saturating_div(dividend, divisor), expected);
            prop_assert_eq!(saturating_div(dividend >> 14, divisor | 1), (dividend >> 14).div_euclid(u32::from(divisor | 1)).min(65535) as u16);
        }
    }
}
