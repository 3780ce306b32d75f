//! The duration of tests with random inputs: short at a desk, long in continuous integration.

use std::num::NonZeroU64;

/// So many of something, as many times as the environment's `LIZARD_FUZZ` says.
///
/// # Panics
/// `LIZARD_FUZZ` is no whole number from 1 on.
#[must_use]
pub fn times(count: u64) -> u64 {
    count * number("LIZARD_FUZZ", 1)
}

/// Minutes that a robot is talked to: the environment's `LIZARD_MINUTES`, or ten.
///
/// # Panics
/// `LIZARD_MINUTES` is no whole number from 1 on.
#[must_use]
pub fn minutes() -> u64 {
    number("LIZARD_MINUTES", 10)
}

/// Not 0: a test would pass that has tried nothing.
fn number(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).map_or(otherwise, |given| match given.parse::<NonZeroU64>() {
        Ok(number) => number.get(),
        Err(_) => panic!("{name} is {given:?}; it must be a whole number from 1 on"),
    })
}
