//! The search: differential evolution (R. Storn, K. Price, *Journal of Global Optimization*
//! 11, 1997; towards one of the best, as J. Zhang and A. Sanderson do, *IEEE Transactions on
//! Evolutionary Computation* 13, 2009), which needs no slope, takes refusals for granted and is
//! a page long.
//!
//! The search does not judge: whoever runs it takes the trials of a round, scores them in any
//! order, and gives the scores back. Random numbers come from one seed and in one order, so the
//! same seed finds the same gait on every machine.

use fastrand::Rng;

/// Members of the population.
const MEMBERS: usize = 20;
/// A trial goes towards one of this many of the best, so the search does not get stuck on one hill.
const LEADERS: usize = 5;
/// How many of a member's parameters a trial changes on average.
const CHANGED: f64 = 0.9;
/// How far a difference of two members is taken: uniform within these, anew for each trial.
const STEPS: (f64, f64) = (0.4, 0.9);

/// How many trials a [`Search`] of so many rounds has; the first population is judged before
/// the first round.
pub const fn trials(rounds: usize) -> usize {
    MEMBERS * (rounds + 1)
}

/// One of the population.
#[derive(Debug, Clone)]
struct Member {
    /// Its parameters, 0 to 1.
    parameters: Vec<f64>,
    /// How good it is; none where it is refused.
    score: Option<f64>,
}

/// Looks for parameters (each 0 to 1) of the greatest score.
#[derive(Debug, Clone)]
pub struct Search {
    rng: Rng,
    members: Vec<Member>,
    trials: Vec<Vec<f64>>,
}

impl Search {
    /// Begins with these parameters and with random ones.
    pub fn new(begin: &[Vec<f64>], seed: u64) -> Self {
        let mut rng = Rng::with_seed(seed);
        let parameters = begin.first().map_or(0, Vec::len);
        let mut trials = begin.to_vec();
        trials.resize_with(MEMBERS, || (0..parameters).map(|_| rng.f64()).collect());
        Self {
            rng,
            members: Vec::new(),
            trials,
        }
    }

    /// The parameters that are to be scored now.
    pub fn trials(&self) -> &[Vec<f64>] {
        &self.trials
    }

    /// Takes the scores of the trials, in their order; none for one that is refused. What is
    /// left out counts as refused. The next round's trials follow.
    pub fn judged(&mut self, scores: impl IntoIterator<Item = Option<f64>>) {
        let scores = scores.into_iter().chain(std::iter::repeat(None));
        let trials = std::mem::take(&mut self.trials).into_iter().zip(scores);
        let judged = trials.map(|(parameters, score)| Member { parameters, score });
        if self.members.is_empty() {
            self.members = judged.collect();
        } else {
            for (member, trial) in self.members.iter_mut().zip(judged) {
                if score(&trial) >= score(member) {
                    *member = trial;
                }
            }
        }
        let rng = &mut self.rng;
        let trial = |of| trial(&self.members, of, rng);
        self.trials = (0..self.members.len()).map(trial).collect();
    }

    /// What has been found so far, the best first: score and parameters.
    pub fn found(&self) -> Vec<(f64, Vec<f64>)> {
        let each = self.members.iter();
        let found = each.filter_map(|member| Some((member.score?, member.parameters.clone())));
        let mut found: Vec<_> = found.collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found
    }
}

fn score(member: &Member) -> f64 {
    member.score.unwrap_or(f64::NEG_INFINITY)
}

/// Some way to one of the best members and along the difference of two others, crossed with the member
/// itself. What leaves 0 to 1 is thrown back halfway.
fn trial(members: &[Member], of: usize, rng: &mut Rng) -> Vec<f64> {
    let own = &members[of].parameters;
    let mut ranks: Vec<&Member> = members.iter().collect();
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
    fn ridge(at: &[f64]) -> Option<f64> {
        let (x, y) = (at[0], at[1]);
        let off = 40.0 * (y - x * x).powi(2) + (x - 0.7).powi(2);
        (x + y > 0.5).then_some(-off)
    }

    fn searched(
        begin: &[Vec<f64>],
        rounds: usize,
        seed: u64,
        judge: impl Fn(&[f64]) -> Option<f64>,
    ) -> Vec<(f64, Vec<f64>)> {
        let mut search = Search::new(begin, seed);
        for _ in 0..=rounds {
            let trials = search.trials().to_vec();
            search.judged(trials.iter().map(|at| judge(at)));
        }
        search.found()
    }

    #[test]
    fn it_climbs_a_curved_ridge() {
        let found = searched(&[vec![0.1, 0.9]], 60, 1, ridge);
        let best = &found[0].1;
        let off = (best[0] - 0.7).hypot(best[1] - 0.49);
        assert!(off < 1e-3, "{best:?}");
        assert!(found.windows(2).all(|pair| pair[0].0 >= pair[1].0));
    }

    #[test]
    fn a_seed_finds_the_same_every_time() {
        let best = |seed| searched(&[vec![0.1, 0.9]], 5, seed, ridge)[0].1.clone();
        assert_eq!(best(7), best(7));
        assert_ne!(best(7), best(8));
    }

    #[test]
    fn where_all_is_refused_nothing_is_found() {
        assert_eq!(searched(&[vec![0.5; 3]], 2, 1, |_| None), []);
        let mut search = Search::new(&[vec![0.5; 3]], 1);
        search.judged([Some(1.0)]);
        assert_eq!(
            search.found(),
            [(1.0, vec![0.5; 3])],
            "the rest was left out"
        );
    }

    #[test]
    fn it_has_as_many_trials_as_it_says() {
        let calls = std::cell::Cell::new(0);
        searched(&[vec![0.5; 2]], 3, 1, |_| {
            calls.set(calls.get() + 1);
            Some(0.0)
        });
        assert_eq!(calls.get(), trials(3));
    }
}
