//! A search for a threshold by halving an interval.

/// Halves the interval from `low` to `high` `count` times, so that `is_below` stays true at `low` and false at `high`.
/// Returns the last `low`.
pub(crate) fn bisect(
    mut low: f64,
    mut high: f64,
    count: u32,
    is_below: impl Fn(f64) -> bool,
) -> f64 {
    for _ in 0..count {
        let middle = (low + high) / 2.0;
        match is_below(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}
