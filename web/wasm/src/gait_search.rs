//! The search for a gait that is faster than the edited gait.
//!
//! A search takes minutes, and the page has one thread for it. Therefore each call tries one gait: the caller can show
//! the progress and the best gait so far, and stop at any time. The kinds of gait alternate, round by round. Their
//! searches do not depend on each other; the final gait equals the result of `lizard tune` with the same parameters.

use lizard_robot::Bars;
use lizard_tune::{Comparison, GaitKind, Search, Tuning, TuningError, trial_count};
use lizard_twin::Twin;
use serde::{Deserialize, Serialize};
use tsify::Tsify;

use crate::refusal::Refusal;

/// The task of a search: the gait to beat, and the parameters of the search.
#[derive(Clone, Debug, PartialEq, Deserialize, Tsify)]
pub struct SearchTask {
    /// The gait to beat.
    pub bars: Bars,
    /// Speed that no servo may exceed, deg/s; `None` selects the largest servo speed of the gait to beat.
    pub rate: Option<f64>,
    /// Number of rounds, as for `lizard tune --rounds`.
    pub rounds: usize,
    /// Seed of the random numbers, as for `lizard tune --seed`.
    pub seed: u64,
}

/// The extent of a search.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct SearchExtent {
    /// Number of gaits to try.
    pub total: usize,
    /// Speed that no servo may exceed, deg/s.
    pub rate: f64,
}

/// The progress of a search.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Tsify)]
pub struct Progress {
    /// Number of gaits tried so far.
    pub done: usize,
    /// Score of the best gait so far: the speed that 95 % of the random robots exceed, mm/s or deg/s. `None` until a
    /// valid gait is found.
    pub best_score: Option<f64>,
}

/// The best gait that a search has found.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct FoundGait {
    /// The best gait found, with the name of the gait to beat.
    pub bars: Bars,
    /// Comparison of the found gait with the gait to beat, on random robots that the search did not use.
    #[tsify(type = "{ unit: string; rate: number; robots: number; faster: number }")]
    pub comparison: Comparison,
    /// True if the found gait is faster than the gait to beat.
    pub is_better: bool,
    /// Relative gain in the speed that 95 % of the robots exceed; 0.1 is 10 % faster. `None` if the gait to beat does
    /// not move 95 % of them towards its goal.
    pub gain: Option<f64>,
}

/// A search in progress.
#[derive(Debug, Clone)]
pub struct GaitSearch {
    tuning: Tuning,
    /// The searches by kind of gait, in the order of [`GaitKind::ALL`].
    searches: [Search; GaitKind::ALL.len()],
    /// Index of the kind whose gaits are being tried.
    kind_index: usize,
    /// Scores of this kind's gaits that were tried in the current round.
    scores: Vec<Option<f64>>,
    progress: Progress,
    trial_count: usize,
}

impl GaitSearch {
    /// Prepares a search with a twin's robot and floor; takes as long as a few trials.
    ///
    /// # Errors
    /// Returns the limit that the gait to beat violates, or the reason why it cannot be made faster.
    pub fn begin(twin: &Twin, task: &SearchTask) -> Result<Self, Refusal> {
        let robot = twin.robot().with_gait(&task.bars.to_toml());
        let robot = robot.map_err(Refusal::for_gait)?;
        // The first gait of this robot is `stand`.
        let (gait, ground) = (&robot.gaits()[1], twin.ground());
        let tuning = Tuning::new(&robot, ground, gait, task.rate, &task.bars.name, task.seed);
        let tuning = tuning.map_err(|error| match error {
            TuningError::Goal(_) => Refusal::for_key("", error.to_string()),
            TuningError::ServoSpeed { .. } => {
                Refusal::for_key("rate", format!("servo speed {error}"))
            }
        })?;
        Ok(Self {
            searches: GaitKind::ALL.map(|kind| tuning.start_search(kind)),
            tuning,
            kind_index: 0,
            scores: Vec::new(),
            progress: Progress::default(),
            trial_count: GaitKind::ALL.len() * trial_count(task.rounds),
        })
    }

    /// Returns the number of gaits to try and the servos' speed limit.
    pub fn extent(&self) -> SearchExtent {
        SearchExtent {
            total: self.trial_count,
            rate: self.tuning.max_servo_speed(),
        }
    }

    /// Tries the next gait, unless all gaits were tried; returns the progress.
    pub fn try_next(&mut self) -> Progress {
        if self.progress.done < self.trial_count {
            let search = &mut self.searches[self.kind_index];
            let parameters = &search.trials()[self.scores.len()];
            let kind = GaitKind::ALL[self.kind_index];
            let score = self.tuning.score(kind, parameters);
            self.scores.push(score);
            self.progress.done += 1;
            if score > self.progress.best_score {
                self.progress.best_score = score;
            }
            if self.scores.len() == search.trials().len() {
                search.accept_scores(self.scores.drain(..));
                self.kind_index = (self.kind_index + 1) % GaitKind::ALL.len();
            }
        }
        self.progress.clone()
    }

    /// Compares the best gait so far with the gait to beat on `robot_count` random robots; `None` until a valid gait is
    /// found.
    pub fn compare_best(&self, robot_count: usize) -> Option<FoundGait> {
        let mut searches = self.searches.clone();
        if !self.scores.is_empty() {
            searches[self.kind_index].accept_scores(self.scores.iter().copied());
        }
        let results = searches.iter().map(Search::ranked_results);
        let best = self.tuning.build_best(results)?;
        let comparison = self.tuning.compare(&best, robot_count);
        Some(FoundGait {
            bars: best.gait().bars()?,
            is_better: comparison.is_better(),
            gain: comparison.gain(),
            comparison,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::{load_paper_robot, load_paper_robot_and_twin};
    use crate::trial::EditedGait;

    fn make_task(name: &str) -> SearchTask {
        let robot = load_paper_robot();
        let gait = robot.gait(name).expect("the robot has this gait");
        SearchTask {
            bars: gait.bars().expect("the gait has bars"),
            rate: None,
            rounds: 0,
            seed: 3,
        }
    }

    /// Returns the message with which a search is refused.
    fn refusal_reason(task: &SearchTask) -> String {
        let (_, twin) = load_paper_robot_and_twin();
        let refusal = GaitSearch::begin(&twin, task).expect_err("the search is refused");
        refusal.reason
    }

    #[test]
    fn an_unfinished_search_returns_the_best_gait_so_far() {
        let (robot, twin) = load_paper_robot_and_twin();
        let mut search =
            GaitSearch::begin(&twin, &make_task("walk")).expect("the gait can be made faster");
        assert_eq!(search.extent().total, 40);
        assert_eq!(search.compare_best(20), None, "no gait has been tried yet");
        let progress: [Progress; 3] = std::array::from_fn(|_| search.try_next());
        let best_score = progress[2].best_score;
        let found = search.compare_best(20).expect("a gait was valid");
        // The search of `lizard tune` tries the same gaits.
        let walk = robot.gait("walk").expect("the robot has this gait");
        let tuning = Tuning::new(&robot, robot.ground(), walk, None, "walk", 3)
            .expect("`walk` goes straight ahead");
        let kind = GaitKind::Wave;
        let round_parameters = tuning.start_search(kind).trials().to_vec();
        let tried_parameters = round_parameters.into_iter().take(3);
        let results = tried_parameters.filter_map(|parameters| {
            let score = tuning.score(kind, &parameters)?;
            Some((score, parameters))
        });
        let results: Vec<_> = results.collect();
        let scores = results.iter().map(|(score, _)| *score);
        assert_eq!(best_score, Some(scores.fold(f64::NEG_INFINITY, f64::max)));
        // Only gaits of the first kind have been tried.
        let best_tuned = tuning.build_best([results]);
        let best_tuned = best_tuned.expect("a gait was valid");
        assert_eq!(found.comparison, tuning.compare(&best_tuned, 20));
        // The page uses exactly the found gait.
        assert_eq!(found.bars.to_toml(), best_tuned.table());
        let trial = EditedGait::Bars(found.bars).try_on(&twin);
        let trial = trial.expect("bars always have a table");
        let trial = trial.expect("the gait is valid");
        assert_eq!(trial.max_servo_speed, found.comparison.tuned.rate);
        assert_eq!(search.try_next().done, 4, "the search must continue");
    }

    #[test]
    fn the_refusal_of_a_search_names_the_reason() {
        assert!(refusal_reason(&make_task("arc-left")).contains("walks along a curve"));
        let mut fast_task = make_task("walk");
        fast_task.rate = Some(900.0);
        assert_eq!(
            refusal_reason(&fast_task),
            "servo speed 900: must be between 10 and 310 deg/s (limits.gait_slew in robot.toml)"
        );
        let mut wide_task = make_task("walk");
        wide_task.bars.amplitude = 60.0;
        let reason = refusal_reason(&wide_task);
        assert!(reason.starts_with("in \"walk\" "), "{reason}");
    }
}
