//! Integer square root, for the one root that the five-bar's closed form needs.

/// The largest integer whose square is at most `square`.
///
/// Digit by digit, one result bit a step: no division and no start value, the
/// same number of steps for every input.
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
    }
}
