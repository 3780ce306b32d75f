//! Numbers from environment variables, such as the number of a test's random inputs and the duration of its dialogue.

/// Returns a count of random inputs, multiplied by the environment variable `LIZARD_FUZZ` (default 1).
///
/// # Panics
/// If `LIZARD_FUZZ` is not a whole number of at least 1.
pub fn scaled_count(count: u64) -> u64 {
    count * read_positive_number("LIZARD_FUZZ", 1)
}

/// Returns the duration of a test's dialogue in minutes, from the environment variable `LIZARD_MINUTES` (default 10).
///
/// # Panics
/// If `LIZARD_MINUTES` is not a whole number of at least 1.
pub fn dialogue_minutes() -> u64 {
    read_positive_number("LIZARD_MINUTES", 10)
}

/// Returns the whole number in an environment variable; `None` if the variable is empty or not set.
///
/// # Panics
/// If its value is not a whole number.
pub fn read_number(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok().filter(|text| !text.is_empty())?;
    let number = text.parse();
    Some(number.unwrap_or_else(|_| panic!("{name} must be a whole number, but is {text:?}")))
}

/// Returns the whole number in an environment variable, or a default if the variable is empty or not set.
///
/// # Panics
/// If its value is not a whole number of at least 1. With 0 inputs, a test would check nothing.
pub fn read_positive_number(name: &str, default: u64) -> u64 {
    let number = read_number(name).unwrap_or(default);
    assert!(number > 0, "{name} must be at least 1, but is 0");
    number
}
