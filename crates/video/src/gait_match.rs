//! The gait that a walk shows, if it is unambiguous.
//!
//! The movements over quarters of a cycle are compared with each gait's predictions for the cycle start, the duration
//! and the scale that fit best. Since every robot differs from its prediction, a good fit alone is no proof: the second
//! best gait must fit much worse according to the F-test for two variances.

use crate::cycle_timing::MAX_MISFIT;
use crate::cycles;
use crate::gait::Gait;
use crate::path::PathPoint;
use crate::video_error::VideoError;

/// Smallest ratio of the second best gait's misfit to the best gait's: the 1 % critical value of Fisher's F if both
/// variances come from four quarters of a cycle on three axes.
const MIN_MISFIT_RATIO: f64 = 4.16;

/// The gait that a walk matches, by its index.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GaitMatch {
    /// The walk shows this gait, unambiguously.
    Unique(usize),
    /// The second best gait fits nearly as well as the best one.
    Ambiguous {
        /// Index of the gait that fits best.
        best: usize,
        /// Index of the gait that fits nearly as well.
        second_best: usize,
    },
    /// No gait fits, for this reason.
    NoMatch(VideoError),
}

/// Finds the gait that a path shows.
pub(crate) fn match_gait(path: &[PathPoint], gaits: &[Gait]) -> GaitMatch {
    let mut fits: Vec<(f64, usize)> = Vec::new();
    let (mut best_slow_misfit, mut pace_ratio) = (f64::INFINITY, 1);
    let mut first_error = None;
    for (index, gait) in gaits.iter().enumerate() {
        match cycles::select_even_walk(path, gait) {
            Ok((_, _, movements)) => {
                fits.push((movements.compute_misfit(gait), index));
                let (slow_misfit, multiple) = movements.misfit_at_best_multiple(gait);
                if slow_misfit < best_slow_misfit {
                    (best_slow_misfit, pace_ratio) = (slow_misfit, multiple);
                }
            }
            Err(error) => {
                first_error = first_error.or(Some(error));
                if let Some((slow_misfit, multiple)) = cycles::find_slow_pace(path, gait)
                    && slow_misfit < best_slow_misfit
                {
                    (best_slow_misfit, pace_ratio) = (slow_misfit, multiple);
                }
            }
        }
    }
    fits.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best_misfit = fits.first().map_or(f64::INFINITY, |fit| fit.0);
    match fits[..] {
        // A gait at a slow pace can resemble another gait at its usual pace, so a better fit at a slow pace has
        // priority.
        _ if best_slow_misfit < best_misfit.min(MAX_MISFIT) => {
            GaitMatch::NoMatch(VideoError::WrongPace { ratio: pace_ratio })
        }
        [(_, best), (second_misfit, second_best), ..]
            if best_misfit < MAX_MISFIT && second_misfit < MIN_MISFIT_RATIO * best_misfit =>
        {
            GaitMatch::Ambiguous { best, second_best }
        }
        [(_, best), ..] if best_misfit < MAX_MISFIT => GaitMatch::Unique(best),
        [(_, best), ..] => GaitMatch::NoMatch(VideoError::GaitMismatch {
            period: gaits[best].period,
        }),
        [] => GaitMatch::NoMatch(first_error.unwrap_or(VideoError::NoGait)),
    }
}
