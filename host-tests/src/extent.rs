//! Number of random inputs and duration of dialogues in tests. Both are small on a developer's machine and large in
//! continuous integration.

/// Returns a count of random inputs multiplied by the environment variable `LIZARD_FUZZ`, 1 by default.
///
/// # Panics
/// If `LIZARD_FUZZ` is not a whole number of at least 1.
pub fn scaled_count(count: u64) -> u64 {
    count * read_positive_number("LIZARD_FUZZ", 1)
}

/// Returns the duration of a test's dialogue in minutes: the environment variable `LIZARD_MINUTES`, 10 by default.
///
/// # Panics
/// If `LIZARD_MINUTES` is not a whole number of at least 1.
pub fn dialogue_minutes() -> u64 {
    read_positive_number("LIZARD_MINUTES", 10)
}

/// Returns the whole number in an environment variable; `None` if it is not set, or empty.
///
/// # Panics
/// If its value is not a whole number.
pub fn read_number(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok().filter(|text| !text.is_empty())?;
    let number = text.parse();
    Some(number.unwrap_or_else(|_| panic!("{name} is {text:?}; it must be a whole number")))
}

/// Returns the number in an environment variable, or a default if it is not set. Rejects 0, because a test without
/// inputs would check nothing.
fn read_positive_number(name: &str, default: u64) -> u64 {
    let number = read_number(name).unwrap_or(default);
    assert!(number > 0, "{name} is 0; it must be 1 or more");
    number
}
