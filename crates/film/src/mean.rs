//! The mean of a film's cycles and its standard error.
//!
//! The cycles of a robot differ by more than the error of a tag's position. So the spread of the cycles
//! gives the error of their mean. The spread of a few cycles is itself uncertain: Student's distribution
//! tells by how much the error has to be enlarged for that. Then the true value lies within two errors
//! as often as for a film of many cycles.
//!
//! Several walks of a gait may differ more from each other than the cycles of a walk do, since each starts
//! elsewhere on the floor. Then the walks count as the samples, and not their cycles.

/// Share of a normal distribution within two standard deviations.
const SHARE_WITHIN_TWO: f64 = 0.9545;

/// A mean over the cycles of a film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// The mean, in the unit of the cycles' values.
    pub mean: f64,
    /// Spread of single cycles: their standard deviation.
    pub spread: f64,
    /// Standard error of the mean: the true value is within twice this with a probability of 95 %.
    pub error: f64,
    /// The part of the error that more cycles do not reduce: the errors of camera, clock and ruler.
    pub common: f64,
}

/// The values of a walk's cycles, and the part of the error that they share.
pub(crate) type Cycles = (Vec<f64>, f64);

/// Computes the mean over walks of two cycles or more.
pub(crate) fn mean_of_walks(walks: &[Cycles]) -> Mean {
    let count = walks.iter().map(|(cycles, _)| cycles.len()).sum::<usize>();
    let mean_of = |cycles: &[f64]| cycles.iter().sum::<f64>() / cycles.len() as f64;
    let weighted_mean = |value: &dyn Fn(&Cycles) -> f64| {
        let terms = walks.iter().map(|walk| walk.0.len() as f64 * value(walk));
        terms.sum::<f64>() / count as f64
    };
    let mean = weighted_mean(&|(cycles, _)| mean_of(cycles));
    let squares_around = |cycles: &[f64], middle: f64| {
        let squares = cycles.iter().map(|cycle| (cycle - middle).powi(2));
        squares.sum::<f64>()
    };
    let total_squares: f64 = walks
        .iter()
        .map(|(cycles, _)| squares_around(cycles, mean))
        .sum();
    let inside_squares: f64 = walks
        .iter()
        .map(|(cycles, _)| squares_around(cycles, mean_of(cycles)))
        .sum();
    let freedom = count - walks.len();
    let variance_within = inside_squares / freedom as f64;
    let variance_between =
        (total_squares - inside_squares) / walks.len().saturating_sub(1).max(1) as f64;
    let (variance, freedom) = match variance_between > variance_within {
        true => (variance_between, walks.len() - 1),
        false => (variance_within, freedom),
    };
    let error = (variance / count as f64).sqrt() * widening(freedom);
    // Camera, clock and ruler are nearly the same for all walks, so more walks do not reduce their error.
    let common = weighted_mean(&|(_, common)| *common);
    Mean {
        mean,
        spread: (total_squares / (count - 1) as f64).sqrt(),
        error: error.hypot(common),
        common,
    }
}

/// The factor that enlarges an error whose spread was estimated with few degrees of freedom, so that the true value
/// lies within two errors with a probability of 95 %.
pub(crate) fn widening(freedom: usize) -> f64 {
    let (mut low, mut high) = (1.0, 100.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        *if student_probability(2.0 * middle, freedom) < SHARE_WITHIN_TWO {
            &mut low
        } else {
            &mut high
        } = middle;
    }
    high
}

/// The probability that Student's variable lies between `-t` and `t`.
fn student_probability(t: f64, freedom: usize) -> f64 {
    let angle = (t / (freedom as f64).sqrt()).atan();
    let (sin, cos) = angle.sin_cos();
    // The terms of the finite series for whole degrees of freedom.
    let is_odd = freedom % 2 == 1;
    let mut term = if is_odd { cos } else { 1.0 };
    let mut sum = 0.0;
    for i in 0..freedom / 2 {
        sum += term;
        let numerator = if is_odd { 2 * i + 2 } else { 2 * i + 1 };
        term *= cos * cos * numerator as f64 / (numerator + 1) as f64;
    }
    match is_odd {
        true => (angle + sin * sum) * std::f64::consts::FRAC_2_PI,
        false => sin * sum,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn student_is_that_of_the_tables() {
        for (freedom, t) in [
            (1, 12.706),
            (2, 4.303),
            (3, 3.182),
            (4, 2.776),
            (9, 2.262),
            (30, 2.042),
        ] {
            let share = student_probability(t, freedom);
            assert!((share - 0.95).abs() < 1e-4, "{freedom}: {share}");
        }
    }

    /// Random numbers of a normal distribution, the same in every run.
    fn noise_source() -> impl FnMut() -> f64 {
        let mut state = 1u64;
        let mut uniform = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) as f64 / (1u64 << 31) as f64
        };
        move || (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }

    #[test]
    fn the_truth_lies_within_two_errors_as_often_for_three_cycles_as_for_ten() {
        let mut noise = noise_source();
        for count in [3, 5, 10] {
            let films = 4000;
            let hits = (0..films).filter(|_| {
                let cycles: Vec<f64> = (0..count).map(|_| 3.0 + noise()).collect();
                let mean = mean_of_walks(&[(cycles, 0.0)]);
                (mean.mean - 3.0).abs() < 2.0 * mean.error
            });
            let share = hits.count() as f64 / f64::from(films);
            assert!((0.945..0.965).contains(&share), "{count}: {share}");
        }
    }

    #[test]
    fn walks_that_differ_make_the_error_that_of_a_few_walks() {
        let mut noise = noise_source();
        for (walk_spread, walks) in [(0.0, 2), (0.0, 3), (1.0, 2), (1.0, 3), (3.0, 2), (3.0, 3)] {
            let films = 2000;
            let hits = (0..films).filter(|_| {
                let mut walk = |_| {
                    let walk_offset = walk_spread * noise();
                    ((0..4).map(|_| 3.0 + walk_offset + noise()).collect(), 0.0)
                };
                let values: Vec<_> = (0..walks).map(&mut walk).collect();
                let mean = mean_of_walks(&values);
                (mean.mean - 3.0).abs() < 2.0 * mean.error
            });
            let share = hits.count() as f64 / f64::from(films);
            // Two or three walks hardly show if walks differ, so the bounds are wide.
            assert!(
                (0.9..0.99).contains(&share),
                "{walk_spread} {walks}: {share}"
            );
        }
    }
}
