//! The gait that a walk shows, if it is unambiguous.
//!
//! The movements over quarters of a cycle are compared with those that each gait predicts, at the beginning and the
//! duration of a cycle that fit best. Since every robot differs from its prediction, a good fit alone is no proof: the
//! second best gait has to fit much worse, by the F-test for two variances.

use crate::cycles;
use crate::gait::Gait;
use crate::path::PathPoint;
use crate::trouble::Trouble;

/// Largest misfit of an accepted gait: that of a robot which moves half as far as predicted.
const MAX_MISFIT: f64 = 0.25;
/// Smallest ratio of the second best gait's misfit to the best gait's: Fisher's F for a probability of 1 %, if both
/// variances come from four quarters of a cycle on three axes.
const MIN_MISFIT_RATIO: f64 = 4.16;

/// The gait that a walk resembles, by its index.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Likeness {
    /// The walk shows this gait, unambiguously.
    One(usize),
    /// The first gait fits best, and the second one nearly as well.
    Two(usize, usize),
    /// No gait fits, for this reason.
    None(Trouble),
}

/// Finds the gait that a path shows.
pub(crate) fn find_likeness(path: &[PathPoint], gaits: &[Gait]) -> Likeness {
    let mut fits: Vec<(f64, usize)> = Vec::new();
    let mut best_slow_fit = (f64::INFINITY, 1);
    let mut trouble = None;
    for (index, gait) in gaits.iter().enumerate() {
        match cycles::compute_movements(path, gait) {
            Ok(movements) => {
                fits.push((movements.misfit(gait), index));
                let slow_fit = movements.misfit_at_best_multiple(gait);
                if slow_fit.0 < best_slow_fit.0 {
                    best_slow_fit = slow_fit;
                }
            }
            Err(reason) => trouble = trouble.or(Some(reason)),
        }
    }
    fits.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best_misfit = fits.first().map_or(f64::INFINITY, |fit| fit.0);
    match fits[..] {
        // A slow gait may move as far in a second as another gait at its usual pace.
        _ if best_slow_fit.0 < best_misfit.min(MAX_MISFIT) => {
            Likeness::None(Trouble::AnotherPace {
                ratio: best_slow_fit.1,
            })
        }
        [(_, index), (second_misfit, rival), ..]
            if best_misfit < MAX_MISFIT && second_misfit < MIN_MISFIT_RATIO * best_misfit =>
        {
            Likeness::Two(index, rival)
        }
        [(_, index), ..] if best_misfit < MAX_MISFIT => Likeness::One(index),
        [(_, index), ..] => Likeness::None(Trouble::NotThisGait {
            period: gaits[index].period,
        }),
        [] => Likeness::None(trouble.unwrap_or(Trouble::NoGait)),
    }
}
