//! The gait that a walk shows, if it is clear.
//!
//! The movements over quarters of a cycle are compared with those of each gait, at the beginning of the cycle and at the
//! clock at which they fit best. The gait that fits best is not yet it: a robot differs from every prediction. So the next best has to
//! fit much worse, by the test that statistics has for two variances.

use crate::cycles;
use crate::gait::Gait;
use crate::path::Seen;
use crate::trouble::Trouble;

/// Largest misfit of the gait that is taken: of a robot that goes half as far as predicted.
const FITS: f64 = 0.25;
/// Least misfit of any other gait over that of the best: Fisher's F for a chance of 1 %, where either variance is known
/// from four quarters of a cycle on three axes.
const CLEAR: f64 = 4.16;

/// The gait that a walk is like, by its number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Likeness {
    /// This gait, clearly.
    One(usize),
    /// This gait best and that one nearly as well.
    Two(usize, usize),
    /// No gait, and why not the one that fits best.
    None(Trouble),
}

/// Compares a path with gaits.
pub(crate) fn of(path: &[Seen], gaits: &[Gait]) -> Likeness {
    let mut fits: Vec<(f64, usize)> = Vec::new();
    let mut slow = (f64::INFINITY, 1);
    let mut trouble = None;
    for (number, gait) in gaits.iter().enumerate() {
        match cycles::steps(path, gait) {
            Ok(steps) => {
                fits.push((steps.misfit(gait), number));
                let longer = steps.misfit_of_longer(gait);
                if longer.0 < slow.0 {
                    slow = longer;
                }
            }
            Err(why) => trouble = trouble.or(Some(why)),
        }
    }
    fits.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = fits.first().map_or(f64::INFINITY, |fit| fit.0);
    match fits[..] {
        // A slow gait may go as far in a second as another one that is not slow.
        _ if slow.0 < best.min(FITS) => Likeness::None(Trouble::AnotherPace { times: slow.1 }),
        [(_, number), (next, rival), ..] if best < FITS && next < CLEAR * best => {
            Likeness::Two(number, rival)
        }
        [(_, number), ..] if best < FITS => Likeness::One(number),
        [(_, number), ..] => Likeness::None(Trouble::NotThisGait {
            period: gaits[number].period,
        }),
        [] => Likeness::None(trouble.unwrap_or(Trouble::NoGait)),
    }
}
