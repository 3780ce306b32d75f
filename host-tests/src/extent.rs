//! The number of random inputs and the duration of tests: small on a developer's machine, large in continuous
//! integration.

use std::num::NonZeroU64;

/// Multiplies a count by the environment variable `LIZARD_FUZZ`, 1 by default.
///
/// # Panics
/// If `LIZARD_FUZZ` is not a whole number of at least 1.
pub fn scaled(count: u64) -> u64 {
    count * read_number("LIZARD_FUZZ", 1)
}

/// Reads the minutes of a test's dialogue from the environment variable `LIZARD_MINUTES`, 10 by default.
///
/// # Panics
/// If `LIZARD_MINUTES` is not a whole number of at least 1.
pub fn minutes() -> u64 {
    read_number("LIZARD_MINUTES", 10)
}

/// Reads a number from the environment. Rejects 0, with which a test would check nothing.
fn read_number(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |value| match value.parse::<NonZeroU64>() {
        Ok(count) => count.get(),
        Err(_) => panic!("{name} is {value:?}; it must be a whole number from 1 on"),
    })
}
