//! A square root and a quotient, computed in integers bit by bit.
//!
//! The slider's length that is reported is a root; a voltage and a limit of a travel are quotients. The chip has an
//! instruction for neither, and the compiler's 32-bit division takes a kilobyte.

use lizard_avr::mul_unsigned;

/// The largest integer whose square is at most `square`.
///
/// Computes one result bit per step, without a division or a start value, in the same number of steps for every
/// input.
pub const fn root(square: u32) -> u16 {
    let mut rest = square;
    let mut root: u32 = 0;
    let mut bit: u32 = 1 << 30;
    while bit != 0 {
        let trial = root + bit;
        root >>= 1;
        if rest >= trial {
            rest -= trial;
            root += bit;
        }
        bit >>= 2;
    }
    root as u16
}

/// `dividend / divisor`, rounded down; 65535 if the quotient is larger or the divisor is 0.
#[inline(never)]
pub fn quotient(dividend: u32, divisor: u16) -> u16 {
    let (mut rest, mut quotient) = (dividend, 0);
    let mut bit = 1u16 << 15;
    while bit > 0 {
        let product = mul_unsigned(divisor, bit);
        if rest >= product {
            rest -= product;
            quotient |= bit;
        }
        bit >>= 1;
    }
    quotient
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn is_root(square: u32) -> bool {
        let root = u64::from(root(square));
        root * root <= square.into() && u64::from(square) < (root + 1) * (root + 1)
    }

    #[test]
    fn every_square_and_its_neighbours_have_the_right_root() {
        for side in 0..=u32::from(u16::MAX) {
            let square = side * side;
            assert_eq!(u32::from(root(square)), side);
            assert!(is_root(square.saturating_sub(1)) && is_root(square.saturating_add(1)));
        }
        assert_eq!(root(u32::MAX), u16::MAX);
    }

    proptest! {
        #[test]
        fn any_root_is_the_largest_integer_whose_square_is_no_more(square: u32) {
            prop_assert!(is_root(square));
        }

        #[test]
        fn a_quotient_is_that_of_the_processor_as_far_as_sixteen_bits_go(
            dividend: u32,
            divisor: u16,
        ) {
            let exact = dividend.checked_div(divisor.into());
            let expected = exact.map_or(u16::MAX, |exact| exact.min(u16::MAX.into()) as u16);
            prop_assert_eq!(quotient(dividend, divisor), expected);
            prop_assert_eq!(quotient(dividend >> 14, divisor | 1), (dividend >> 14).div_euclid(u32::from(divisor | 1)).min(65535) as u16);
        }
    }
}
