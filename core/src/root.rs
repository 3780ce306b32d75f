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
