//! The search: differential evolution (R. Storn, K. Price, *Journal of Global Optimization*
//! 11, 1997; towards one of the best, as J. Zhang and A. Sanderson do, *IEEE Transactions on
//! Evolutionary Computation* 13, 2009), which needs no slope, takes refusals for granted and is a page long. Each
//! round's trials are judged on all cores; random numbers come from one seed and in one order, so
//! the same seed finds the same gait on every machine.

use fastrand::Rng;
use rayon::prelude::*;

/// Members of the population.
const MEMBERS: usize = 20;
/// A trial goes towards one of this many of the best, so the search does not get stuck on one hill.
const LEADERS: usize = 5;
/// How many of a member's parameters a trial changes on average.
const CHANGED: f64 = 0.9;
/// How far a difference of two members is taken: uniform within these, anew for each trial.
const STEPS: (f64, f64) = (0.4, 0.9);

/// How many times `judge` is called by [`search`].
pub const fn trials(rounds: usize) -> usize {
    MEMBERS * (rounds + 1)
}

/// What has been found.
#[derive(Debug, Clone)]
pub struct Member<T> {
    /// Its parameters, 0 to 1.
    pub parameters: Vec<f64>,
    /// How good it is, and what was judged; none where it is refused.
    pub found: Option<(f64, T)>,
}

/// Looks for parameters (each 0 to 1) of the greatest score, from these and from random ones
/// on; the best come first.
pub fn search<T: Clone + Send + Sync>(
    begin: &[Vec<f64>],
    rounds: usize,
    seed: u64,
    judge: impl Fn(&[f64]) -> Option<(f64, T)> + Sync,
) -> Vec<Member<T>> {
    let mut rng = Rng::with_seed(seed);
    let judged = |all: Vec<Vec<f64>>| -> Vec<Member<T>> {
        let member = |parameters: Vec<f64>| Member {
            found: judge(&parameters),
            parameters,
        };
        all.into_par_iter().map(member).collect()
    };
    let parameters = begin.first().map_or(0, Vec::len);
    let mut first = begin.to_vec();
    first.resize_with(MEMBERS, || (0..parameters).map(|_| rng.f64()).collect());
    let mut members = judged(first);
    for _ in 0..rounds {
        let trials = (0..MEMBERS).map(|i| trial(&members, i, &mut rng)).collect();
        for (member, trial) in members.iter_mut().zip(judged(trials)) {
            if score(&trial) >= score(member) {
                *member = trial;
            }
        }
    }
    members.sort_by(|a, b| score(b).total_cmp(&score(a)));
    members
}

fn score<T>(member: &Member<T>) -> f64 {
    member
        .found
        .as_ref()
        .map_or(f64::NEG_INFINITY, |(score, _)| *score)
}

/// Some way to one of the best members and along the difference of two others, crossed with the member
/// itself. What leaves 0 to 1 is thrown back halfway.
fn trial<T>(members: &[Member<T>], of: usize, rng: &mut Rng) -> Vec<f64> {
    let own = &members[of].parameters;
    let mut ranks: Vec<&Member<T>> = members.iter().collect();
    ranks.sort_by(|a, b| score(b).total_cmp(&score(a)));
    let best = ranks[rng.usize(..LEADERS)];
    let mut others: Vec<usize> = (0..members.len()).filter(|i| *i != of).collect();
    rng.shuffle(&mut others);
    let [plus, minus] = [0, 1].map(|i| &members[others[i]].parameters);
    let step = STEPS.0 + (STEPS.1 - STEPS.0) * rng.f64();
    let always = rng.usize(..own.len());
    (0..own.len())
        .map(|i| {
            if i != always && rng.f64() >= CHANGED {
                return own[i];
            }
            match own[i] + step * (best.parameters[i] - own[i] + plus[i] - minus[i]) {
                low if low < 0.0 => own[i] / 2.0,
                high if high > 1.0 => (1.0 + own[i]) / 2.0,
                inside => inside,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A narrow curved ridge with its top at (0.7, 0.49), and a quarter of the square refused.
    fn ridge(at: &[f64]) -> Option<(f64, ())> {
        let (x, y) = (at[0], at[1]);
        let off = 40.0 * (y - x * x).powi(2) + (x - 0.7).powi(2);
        (x + y > 0.5).then_some((-off, ()))
    }

    #[test]
    fn it_climbs_a_curved_ridge() {
        let found = search(&[vec![0.1, 0.9]], 60, 1, ridge);
        let best = &found[0];
        let off = (best.parameters[0] - 0.7).hypot(best.parameters[1] - 0.49);
        assert!(off < 1e-3, "{best:?}");
        assert!(
            found
                .windows(2)
                .all(|pair| score(&pair[0]) >= score(&pair[1]))
        );
    }

    #[test]
    fn a_seed_finds_the_same_every_time() {
        let best = |seed| {
            search(&[vec![0.1, 0.9]], 5, seed, ridge)[0]
                .parameters
                .clone()
        };
        assert_eq!(best(7), best(7));
        assert_ne!(best(7), best(8));
    }

    #[test]
    fn where_all_is_refused_nothing_is_found() {
        let found = search(&[vec![0.5; 3]], 2, 1, |_| None::<(f64, ())>);
        assert!(found.iter().all(|member| member.found.is_none()));
    }

    #[test]
    fn it_judges_as_often_as_it_says() {
        let calls = std::sync::atomic::AtomicUsize::new(0);
        search(&[vec![0.5; 2]], 3, 1, |_| {
            calls.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            Some((0.0, ()))
        });
        assert_eq!(calls.into_inner(), trials(3));
    }
}
