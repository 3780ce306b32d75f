//! The mean of a video's cycles and its standard error.
//!
//! The cycles of a robot differ by more than the error of a tag's position, so their spread gives the error of their
//! mean. The spread of a few cycles is itself uncertain. Student's t distribution gives the factor by which the error
//! must be enlarged so that the true value lies within two standard errors as often as for a video of many cycles.
//!
//! Walks of a gait may differ more from each other than the cycles within a walk, because each walk starts at another
//! place on the floor. In that case the samples are the walks instead of their cycles.

/// Probability that a normally distributed value lies within two standard deviations of its mean.
const PROBABILITY_WITHIN_TWO_SIGMAS: f64 = 0.9545;

/// A mean over the cycles of a video.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// The mean, in the unit of the cycles' values.
    pub value: f64,
    /// Standard deviation of single cycles.
    pub standard_deviation: f64,
    /// Standard error of the mean: the true value is within two standard errors of `value` with a probability of
    /// 95 %.
    pub standard_error: f64,
    /// The part of the standard error that more cycles do not reduce: the errors of camera, clock and ruler.
    pub systematic_error: f64,
}

/// The values of a walk's cycles.
pub(crate) struct WalkValues {
    /// The value of each cycle.
    pub cycles: Vec<f64>,
    /// The part of the error that all cycles have in common.
    pub systematic_error: f64,
}

/// Computes the mean over walks of at least two cycles each.
pub(crate) fn compute_mean(walks: &[WalkValues]) -> Mean {
    let cycle_count = walks.iter().map(|walk| walk.cycles.len()).sum::<usize>();
    let cycle_mean = |cycles: &[f64]| cycles.iter().sum::<f64>() / cycles.len() as f64;
    let weighted_mean = |value: &dyn Fn(&WalkValues) -> f64| {
        let term = |walk: &WalkValues| walk.cycles.len() as f64 * value(walk);
        walks.iter().map(term).sum::<f64>() / cycle_count as f64
    };
    let mean = weighted_mean(&|walk| cycle_mean(&walk.cycles));
    let sum_of_squares_about = |cycles: &[f64], centre: f64| {
        let squares = cycles.iter().map(|cycle| (cycle - centre).powi(2));
        squares.sum::<f64>()
    };
    let about_mean = |walk: &WalkValues| sum_of_squares_about(&walk.cycles, mean);
    let total_sum_of_squares: f64 = walks.iter().map(about_mean).sum();
    let within = |walk: &WalkValues| sum_of_squares_about(&walk.cycles, cycle_mean(&walk.cycles));
    let sum_of_squares_within: f64 = walks.iter().map(within).sum();
    let degrees_of_freedom = cycle_count - walks.len();
    let variance_within = sum_of_squares_within / degrees_of_freedom as f64;
    let variance_between = (total_sum_of_squares - sum_of_squares_within)
        / walks.len().saturating_sub(1).max(1) as f64;
    let (variance, degrees_of_freedom) = match variance_between > variance_within {
        true => (variance_between, walks.len() - 1),
        false => (variance_within, degrees_of_freedom),
    };
    let random_error =
        (variance / cycle_count as f64).sqrt() * small_sample_factor(degrees_of_freedom);
    // Camera, clock and ruler are nearly the same for all walks, so more walks do not reduce their error.
    let systematic_error = weighted_mean(&|walk| walk.systematic_error);
    Mean {
        value: mean,
        standard_deviation: (total_sum_of_squares / (cycle_count - 1) as f64).sqrt(),
        standard_error: random_error.hypot(systematic_error),
        systematic_error,
    }
}

/// Returns the median of values; of an even number of values, the larger of the two in the middle. `None` if there are
/// no values.
pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Returns the factor by which an error must be enlarged if it was estimated with few degrees of freedom, so that the
/// true value lies within two standard errors with a probability of 95 %.
pub(crate) fn small_sample_factor(degrees_of_freedom: usize) -> f64 {
    let (mut low, mut high) = (1.0, 100.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        let probability = student_t_probability(2.0 * middle, degrees_of_freedom);
        match probability < PROBABILITY_WITHIN_TWO_SIGMAS {
            true => low = middle,
            false => high = middle,
        }
    }
    high
}

/// Returns the probability that a t-distributed variable lies between `-t` and `t`.
fn student_t_probability(t: f64, degrees_of_freedom: usize) -> f64 {
    let angle = (t / (degrees_of_freedom as f64).sqrt()).atan();
    let (sin, cos) = angle.sin_cos();
    // For a whole number of degrees of freedom, the probability is a finite series.
    let is_odd = degrees_of_freedom % 2 == 1;
    let mut term = if is_odd { cos } else { 1.0 };
    let mut sum = 0.0;
    for i in 0..degrees_of_freedom / 2 {
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
    use fastrand::Rng;
    use lizard_studio::render::random_normal;

    #[test]
    fn students_distribution_matches_published_tables() {
        for (degrees_of_freedom, t) in [
            (1, 12.706),
            (2, 4.303),
            (3, 3.182),
            (4, 2.776),
            (9, 2.262),
            (30, 2.042),
        ] {
            let probability = student_t_probability(t, degrees_of_freedom);
            assert!(
                (probability - 0.95).abs() < 1e-4,
                "{degrees_of_freedom} degrees of freedom: {probability}"
            );
        }
    }

    /// Returns the values of a walk whose cycles scatter around `mean`.
    fn scattered_walk(cycle_count: usize, mean: f64, rng: &mut Rng) -> WalkValues {
        let cycle = |_| mean + random_normal(rng);
        WalkValues {
            cycles: (0..cycle_count).map(cycle).collect(),
            systematic_error: 0.0,
        }
    }

    /// Returns the fraction of videos in which the true value, 3, lies within two standard errors of the mean.
    fn hit_fraction(video_count: u32, mut record_video: impl FnMut() -> Vec<WalkValues>) -> f64 {
        let hits = (0..video_count).filter(|_| {
            let mean = compute_mean(&record_video());
            (mean.value - 3.0).abs() < 2.0 * mean.standard_error
        });
        hits.count() as f64 / f64::from(video_count)
    }

    #[test]
    fn the_true_value_lies_within_two_standard_errors_in_95_percent_of_videos_of_three_to_ten_cycles()
     {
        let mut rng = Rng::with_seed(1);
        for cycle_count in [3, 5, 10] {
            let record_video = || vec![scattered_walk(cycle_count, 3.0, &mut rng)];
            let hit_fraction = hit_fraction(4000, record_video);
            assert!(
                (0.945..0.965).contains(&hit_fraction),
                "{cycle_count} cycles: {hit_fraction}"
            );
        }
    }

    #[test]
    fn the_true_value_lies_within_two_standard_errors_in_90_to_99_percent_of_videos_of_several_walks()
     {
        let mut rng = Rng::with_seed(1);
        for (walk_spread, walk_count) in
            [(0.0, 2), (0.0, 3), (1.0, 2), (1.0, 3), (3.0, 2), (3.0, 3)]
        {
            let mut record_walk = |_| {
                let mean = 3.0 + walk_spread * random_normal(&mut rng);
                scattered_walk(4, mean, &mut rng)
            };
            let record_video = || (0..walk_count).map(&mut record_walk).collect();
            let hit_fraction = hit_fraction(2000, record_video);
            // Two or three walks hardly show whether walks differ, so the bounds are wide.
            assert!(
                (0.9..0.99).contains(&hit_fraction),
                "{walk_count} walks, spread {walk_spread}: {hit_fraction}"
            );
        }
    }
}
