//! Differential evolution (R. Storn, K. Price, *Journal of Global Optimization* 11, 1997), with steps towards one of
//! the best members (J. Zhang, A. Sanderson, *IEEE Transactions on Evolutionary Computation* 13, 2009). The method
//! needs no gradient, handles rejected trials, and is short.
//!
//! The search does not compute scores: the caller scores the trials of a round, in any order, and returns the scores.
//! Random numbers come from one seed in a fixed order, so the same seed finds the same gait on every machine.

use fastrand::Rng;

/// Number of members in the population.
const MEMBER_COUNT: usize = 20;
/// Number of best members that are leaders. Each trial moves towards a random leader, so that the search does not
/// end at the first local maximum.
const LEADER_COUNT: usize = 5;
/// Probability that a trial changes a parameter of its member.
const CHANGE_PROBABILITY: f64 = 0.9;
/// Range of a trial's step factor, which is drawn uniformly.
const STEP_RANGE: (f64, f64) = (0.4, 0.9);

/// Returns the number of trials in a [`Search`] with `round_count` rounds. It includes the initial population, which is
/// scored before the first round.
pub const fn trial_count(round_count: usize) -> usize {
    MEMBER_COUNT * (round_count + 1)
}

/// A member of the population.
#[derive(Debug, Clone)]
struct Member {
    /// Parameters, each 0 to 1.
    parameters: Vec<f64>,
    /// Score; `None` if the parameters were rejected.
    score: Option<f64>,
}

/// A search for the parameters (each 0 to 1) with the highest score.
#[derive(Debug, Clone)]
pub struct Search {
    rng: Rng,
    members: Vec<Member>,
    trials: Vec<Vec<f64>>,
}

impl Search {
    /// Starts a search with the given parameter sets and with random sets that complete the population.
    pub fn new(start_parameters: &[Vec<f64>], seed: u64) -> Self {
        let mut rng = Rng::with_seed(seed);
        let parameter_count = start_parameters.first().map_or(0, Vec::len);
        let mut trials = start_parameters.to_vec();
        trials.resize_with(MEMBER_COUNT, || {
            (0..parameter_count).map(|_| rng.f64()).collect()
        });
        Self {
            rng,
            members: Vec::new(),
            trials,
        }
    }

    /// The parameter sets to score in this round.
    pub fn trials(&self) -> &[Vec<f64>] {
        &self.trials
    }

    /// Accepts the scores of this round's trials, in the order of [`Search::trials`], and creates the trials of the
    /// next round. A trial is rejected if its score is `None` or missing.
    pub fn accept_scores(&mut self, scores: impl IntoIterator<Item = Option<f64>>) {
        let scores = scores.into_iter().chain(std::iter::repeat(None));
        let trials = std::mem::take(&mut self.trials).into_iter().zip(scores);
        let scored_members = trials.map(|(parameters, score)| Member { parameters, score });
        if self.members.is_empty() {
            self.members = scored_members.collect();
        } else {
            for (member, trial) in self.members.iter_mut().zip(scored_members) {
                // A rejected member has the lowest score.
                if trial.score >= member.score {
                    *member = trial;
                }
            }
        }
        self.trials = (0..self.members.len())
            .map(|index| create_trial(&self.members, index, &mut self.rng))
            .collect();
    }

    /// Returns the scores and parameters of the current members, the best first.
    pub fn ranked_results(&self) -> Vec<(f64, Vec<f64>)> {
        let members = self.members.iter();
        let results = members.filter_map(|member| Some((member.score?, member.parameters.clone())));
        let mut results: Vec<_> = results.collect();
        results.sort_by(|a, b| b.0.total_cmp(&a.0));
        results
    }
}

/// Creates a trial from the member with the given index: a step towards one of the best members plus a step along the
/// difference of two other members, crossed with the member itself. A parameter that would leave the range 0 to 1 moves
/// halfway to the bound instead.
fn create_trial(members: &[Member], index: usize, rng: &mut Rng) -> Vec<f64> {
    let own_parameters = &members[index].parameters;
    let mut ranked_members: Vec<&Member> = members.iter().collect();
    let score = |member: &Member| member.score.unwrap_or(f64::NEG_INFINITY);
    ranked_members.sort_by(|a, b| score(b).total_cmp(&score(a)));
    let leader = ranked_members[rng.usize(..LEADER_COUNT)];
    let mut others: Vec<usize> = (0..members.len()).filter(|i| *i != index).collect();
    rng.shuffle(&mut others);
    let [plus, minus] = [0, 1].map(|i| &members[others[i]].parameters);
    let step_factor = STEP_RANGE.0 + (STEP_RANGE.1 - STEP_RANGE.0) * rng.f64();
    let changed_index = rng.usize(..own_parameters.len());
    (0..own_parameters.len())
        .map(|i| {
            if i != changed_index && rng.f64() >= CHANGE_PROBABILITY {
                return own_parameters[i];
            }
            match own_parameters[i]
                + step_factor * (leader.parameters[i] - own_parameters[i] + plus[i] - minus[i])
            {
                low if low < 0.0 => own_parameters[i] / 2.0,
                high if high > 1.0 => (1.0 + own_parameters[i]) / 2.0,
                inside => inside,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computes a score with a narrow curved ridge and its maximum at (0.7, 0.49). Rejects parameters with x + y <=
    /// 0.5.
    fn score_on_ridge(parameters: &[f64]) -> Option<f64> {
        let (x, y) = (parameters[0], parameters[1]);
        let error = 40.0 * (y - x * x).powi(2) + (x - 0.7).powi(2);
        (x + y > 0.5).then_some(-error)
    }

    fn run_search(
        start_parameters: &[Vec<f64>],
        round_count: usize,
        seed: u64,
        score: impl Fn(&[f64]) -> Option<f64>,
    ) -> Vec<(f64, Vec<f64>)> {
        let mut search = Search::new(start_parameters, seed);
        for _ in 0..=round_count {
            let trials = search.trials().to_vec();
            search.accept_scores(trials.iter().map(|parameters| score(parameters)));
        }
        search.ranked_results()
    }

    #[test]
    fn the_search_finds_the_maximum_of_a_curved_ridge() {
        let results = run_search(&[vec![0.1, 0.9]], 60, 1, score_on_ridge);
        let best = &results[0].1;
        let error = (best[0] - 0.7).hypot(best[1] - 0.49);
        assert!(error < 1e-3, "{best:?}");
        assert!(results.windows(2).all(|pair| pair[0].0 >= pair[1].0));
    }

    #[test]
    fn the_same_seed_finds_the_same_parameters() {
        let find_results = |seed| run_search(&[vec![0.1, 0.9]], 5, seed, score_on_ridge);
        assert_eq!(find_results(7), find_results(7));
        assert_ne!(find_results(7)[0].1, find_results(8)[0].1);
    }

    #[test]
    fn rejected_trials_are_not_among_the_results() {
        assert_eq!(run_search(&[vec![0.5; 3]], 2, 1, |_| None), []);
        let mut search = Search::new(&[vec![0.5; 3]], 1);
        search.accept_scores([Some(1.0)]);
        assert_eq!(
            search.ranked_results(),
            [(1.0, vec![0.5; 3])],
            "the trials without a score are rejected"
        );
    }

    #[test]
    fn a_search_has_the_predicted_number_of_trials() {
        let scored_count = std::cell::Cell::new(0);
        run_search(&[vec![0.5; 2]], 3, 1, |_| {
            scored_count.set(scored_count.get() + 1);
            Some(0.0)
        });
        assert_eq!(scored_count.get(), trial_count(3));
    }
}
