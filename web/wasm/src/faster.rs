//! The search for a gait that walks faster than the edited one.
//!
//! The search of `lizard tune` takes minutes, and the page has one thread for it. So this search tries
//! one gait per call: its caller can show the progress and the best gait so far, and stop at any
//! time. The kinds of gait take turns, round by round; they do not depend on each other, so the
//! final gait equals that of `lizard tune` with the same parameters.

use lizard_robot::Bars;
use lizard_tune::{Comparison, Kind, ScoredParameters, Search, Tuning, TuningError, trials};
use lizard_twin::Twin;
use serde::{Deserialize, Serialize};
use tsify::Tsify;

use crate::refused::Refused;

/// The task of a search: the gait to beat, and the parameters of the search.
#[derive(Clone, Debug, PartialEq, Deserialize, Tsify)]
pub struct SearchTask {
    /// The gait to beat.
    pub bars: Bars,
    /// Largest speed of a servo, deg/s; `None` for the largest speed in the given gait.
    pub rate: Option<f64>,
    /// Rounds of the search, as `lizard tune --rounds` has them.
    pub rounds: usize,
    /// Seed of the random numbers, as `lizard tune --seed` has it.
    pub seed: u64,
}

/// The extent of a search.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct SearchExtent {
    /// Number of gaits that the search tries.
    pub all: usize,
    /// Largest speed of a servo, deg/s.
    pub rate: f64,
}

/// The progress of a search.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Progress {
    /// Number of gaits that the search has tried.
    pub done: usize,
    /// Score of the best gait so far: the speed that 95 % of the random robots exceed, mm/s or deg/s; `None` while no
    /// gait was valid.
    pub best: Option<f64>,
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Found {
    /// The gait that was found, with the name of the given one.
    pub bars: Bars,
    /// Comparison of the found and the given gait on random robots that the search has not used.
    #[tsify(type = "{ unit: string; rate: number; robots: number; faster: number }")]
    pub comparison: Comparison,
    /// True if the found gait is faster than the given gait.
    pub better: bool,
    /// Gain in the speed that 95 % of the robots exceed, as a share.
    pub gain: f64,
}

/// A search in progress.
#[derive(Debug, Clone)]
pub struct Faster {
    tuning: Tuning,
    searches: [Search; Kind::ALL.len()],
    /// Index of the kind of gait that is being tried.
    turn: usize,
    /// Scores of the current round of that kind so far.
    scores: Vec<Option<f64>>,
    progress: Progress,
    all: usize,
}

impl Faster {
    /// Prepares a search with the robot and the floor of a twin; takes as long as a few trials.
    ///
    /// # Errors
    /// Returns the limit that the given gait breaks, or the reason why it cannot be made faster.
    pub fn begin(twin: &Twin, task: &SearchTask) -> Result<Self, Refused> {
        let refusal_of = |key: &str, reason: String| Refused {
            refused: reason,
            meaning: None,
            line: None,
            key: key.to_string(),
        };
        let robot = twin.robot().with_gait(&task.bars.table());
        let robot = robot.map_err(Refused::of_gait)?;
        let (gait, ground) = (&robot.gaits()[1], twin.ground());
        let tuning = Tuning::new(&robot, ground, gait, task.rate, &task.bars.name, task.seed);
        let tuning = tuning.map_err(|error| match error {
            TuningError::Goal(_) => refusal_of("", error.to_string()),
            TuningError::Rate { .. } => refusal_of("rate", format!("servos of at most {error}")),
        })?;
        Ok(Self {
            searches: Kind::ALL.map(|kind| tuning.search(kind)),
            tuning,
            turn: 0,
            scores: Vec::new(),
            progress: Progress {
                done: 0,
                best: None,
            },
            all: Kind::ALL.len() * trials(task.rounds),
        })
    }

    /// Returns the extent of this search.
    pub fn begun(&self) -> SearchExtent {
        SearchExtent {
            all: self.all,
            rate: self.tuning.rate(),
        }
    }

    /// Tries the next gait, unless all are tried.
    pub fn step(&mut self) -> Progress {
        if self.progress.done < self.all {
            let search = &mut self.searches[self.turn];
            let parameters = &search.trials()[self.scores.len()];
            let score = self.tuning.score(Kind::ALL[self.turn], parameters);
            self.scores.push(score);
            self.progress.done += 1;
            if score > self.progress.best {
                self.progress.best = score;
            }
            if self.scores.len() == search.trials().len() {
                search.score(self.scores.drain(..));
                self.turn = (self.turn + 1) % Kind::ALL.len();
            }
        }
        self.progress.clone()
    }

    /// Compares the best gait so far with the given one, on a number of random robots; `None`
    /// until a gait is within the robot's limits.
    pub fn found(&self, robots: usize) -> Option<Found> {
        let mut searches = self.searches.clone();
        if !self.scores.is_empty() {
            searches[self.turn].score(self.scores.iter().copied());
        }
        let kinds = Kind::ALL.into_iter().zip(&searches);
        let scored = kinds.flat_map(|(kind, search)| {
            let found = search.found().into_iter();
            found.map(move |(score, parameters)| ScoredParameters {
                kind,
                score,
                parameters,
            })
        });
        let best = self.tuning.best(scored.collect())?;
        let comparison = self.tuning.compare(&best, robots);
        Some(Found {
            bars: best.gait().bars()?,
            better: comparison.is_better(),
            gain: comparison.gain(),
            comparison,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::{paper, with_twin};
    use crate::trial::EditedGait;

    fn task_of(name: &str) -> SearchTask {
        let gait = paper().gait(name).cloned().expect(name);
        SearchTask {
            bars: gait.bars().expect("bars"),
            rate: None,
            rounds: 0,
            seed: 3,
        }
    }

    fn refusal_of(task: &SearchTask) -> String {
        Faster::begin(&with_twin().1, task)
            .expect_err("refused")
            .refused
    }

    #[test]
    fn a_stopped_search_has_the_best_gait_so_far() {
        let (robot, twin) = with_twin();
        let mut faster = Faster::begin(&twin, &task_of("walk")).expect("it begins");
        assert_eq!(faster.begun().all, 40);
        assert_eq!(faster.found(20), None, "nothing is tried yet");
        let best = (0..3).map(|_| faster.step()).last().expect("three").best;
        let found = faster.found(20).expect("one");
        // The same trials by the search of `lizard tune`.
        let walk = robot.gait("walk").expect("there");
        let tuning = Tuning::new(&robot, robot.ground(), walk, None, "walk", 3).expect("straight");
        let trials = tuning.search(Kind::Wave).trials().to_vec();
        let scored = trials.into_iter().take(3).filter_map(|parameters| {
            let kind = Kind::Wave;
            let score = tuning.score(kind, &parameters)?;
            Some(ScoredParameters {
                kind,
                score,
                parameters,
            })
        });
        let scored: Vec<_> = scored.collect();
        let scores = scored.iter().map(|entry| entry.score);
        assert_eq!(best, Some(scores.fold(f64::NEG_INFINITY, f64::max)));
        let best_tuned = tuning.best(scored).expect("it walks");
        assert_eq!(found.comparison, tuning.compare(&best_tuned, 20));
        // The page takes over exactly the gait that was found.
        assert_eq!(found.bars.table(), best_tuned.table());
        let trial = EditedGait::Bars(found.bars).trial(&twin).expect("bars");
        let trial = trial.expect("it walks");
        assert_eq!(trial.speed, found.comparison.tuned.rate);
        assert_eq!(faster.step().done, 4, "it can go on");
    }

    #[test]
    fn a_gait_that_cannot_be_made_faster_is_refused_with_the_reason() {
        assert!(refusal_of(&task_of("arc-left")).contains("goes ahead and turns"));
        let rate = Some(900.0);
        assert_eq!(
            refusal_of(&SearchTask {
                rate,
                ..task_of("walk")
            }),
            "servos of at most 900: from 10 to 310 deg/s, which is limits.gait_slew in robot.toml"
        );
        let mut wide_task = task_of("walk");
        wide_task.bars.amplitude = 60.0;
        assert!(
            refusal_of(&wide_task).starts_with("in \"walk\" "),
            "{}",
            refusal_of(&wide_task)
        );
    }
}
