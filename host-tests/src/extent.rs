//! The duration of tests with random inputs: short at a desk, long in continuous integration.

use std::num::NonZeroU64;

/// Multiplies a count by the environment's `LIZARD_FUZZ`.
///
/// # Panics
/// `LIZARD_FUZZ` is not a whole number from 1 on.
pub fn times(count: u64) -> u64 {
    count * number("LIZARD_FUZZ", 1)
}

/// Minutes of a test's dialogue: the environment's `LIZARD_MINUTES`, or ten.
///
/// # Panics
/// `LIZARD_MINUTES` is not a whole number from 1 on.
pub fn minutes() -> u64 {
    number("LIZARD_MINUTES", 10)
}

/// Reads a number from the environment. 0 is refused, since such a test would try nothing.
fn number(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).map_or(otherwise, |given| match given.parse::<NonZeroU64>() {
        Ok(number) => number.get(),
        Err(_) => panic!("{name} is {given:?}; it must be a whole number from 1 on"),
    })
}
