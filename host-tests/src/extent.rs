//! How long tests with random inputs go on: short at a desk, long in continuous integration.

/// So many of something, as many times as the environment's `LIZARD_FUZZ` says.
///
/// # Panics
/// `LIZARD_FUZZ` is no number.
#[must_use]
pub fn times(count: u64) -> u64 {
    (count as f64 * number("LIZARD_FUZZ", 1.0)) as u64
}

/// Minutes that a robot is talked to: the environment's `LIZARD_MINUTES`, or ten.
///
/// # Panics
/// `LIZARD_MINUTES` is no number.
#[must_use]
pub fn minutes() -> u64 {
    number("LIZARD_MINUTES", 10.0) as u64
}

fn number(name: &str, otherwise: f64) -> f64 {
    std::env::var(name).map_or(otherwise, |given| match given.parse() {
        Ok(number) => number,
        Err(_) => panic!("{name} is {given} and no number"),
    })
}
