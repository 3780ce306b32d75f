//! A gait that walks faster than the one that is being made.
//!
//! The search of `lizard tune` takes minutes, and here there is one thread. So it goes on one
//! gait at a time: whoever asks can say how far it is, show the best so far, and stop at
//! any time. The kinds of gait take turns, round by round; they do not depend on each other, so
//! the gait that is found in the end is that of `lizard tune` with the same numbers.

use lizard_robot::{Ground, Robot};
use lizard_tune::{Comparison, Kind, NoTuning, Scored, Search, Tuning, trials};
use serde::{Deserialize, Serialize};

use crate::refused::Refused;
use crate::trial::{Bars, with, without_gaits};

/// What is wanted: the gait that is to be surpassed, and how long to search.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Wish {
    /// The gait.
    pub bars: Bars,
    /// How fast a servo may turn, deg/s; as in that gait where nothing is said.
    pub rate: Option<f64>,
    /// Rounds of the search, as `lizard tune --rounds` has them.
    pub rounds: usize,
    /// Seed of the random numbers, as `lizard tune --seed` has it.
    pub seed: u64,
}

/// What a search that has begun is going to do.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Begun {
    /// How many gaits it tries.
    pub all: usize,
    /// How fast a servo may turn, deg/s.
    pub rate: f64,
}

/// How far a search is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Progress {
    /// How many gaits it has tried.
    pub done: usize,
    /// The speed of the best so far, which 95 % of the random robots exceed, mm/s or deg/s.
    pub best: Option<f64>,
}

/// What was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Found {
    /// The gait, which has the name of the one of before.
    pub bars: Bars,
    /// Both gaits on random robots that the search has not seen.
    pub comparison: Comparison,
    /// Whether it surpasses the one of before.
    pub better: bool,
    /// By what share, where 5 % of the robots are slower.
    pub gain: f64,
}

/// A search under way.
#[derive(Debug, Clone)]
pub struct Faster {
    tuning: Tuning,
    searches: [Search; Kind::ALL.len()],
    /// The kind whose round it is.
    turn: usize,
    /// The scores of the round so far.
    scores: Vec<Option<f64>>,
    progress: Progress,
    all: usize,
}

impl Faster {
    /// Begins a search for the robot of a text on this ground. Takes as long as a few trials.
    ///
    /// # Errors
    /// What the gait of the wish breaks, or why it cannot be made faster.
    pub fn begin(text: &str, ground: &Ground, wish: &Wish) -> Result<Self, Refused> {
        let said = |key: &str, refused: String| Refused {
            refused,
            line: None,
            key: key.to_string(),
        };
        let robot: Robot = with(&without_gaits(text), &wish.bars.table())
            .map_err(|error| said(&error.key, format!("{}: {}", error.key, error.problem)))?;
        let gait = &robot.gaits()[1];
        let tuning = Tuning::new(&robot, ground, gait, wish.rate, &wish.bars.name, wish.seed);
        let tuning = tuning.map_err(|no| match no {
            NoTuning::Goal(_) => said("", no.to_string()),
            NoTuning::Rate { .. } => said("rate", format!("servos of at most {no}")),
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
            all: Kind::ALL.len() * trials(wish.rounds),
        })
    }

    /// What it is going to do.
    pub fn begun(&self) -> Begun {
        Begun {
            all: self.all,
            rate: self.tuning.rate(),
        }
    }

    /// Tries one more gait, unless all are tried.
    pub fn step(&mut self) -> Progress {
        if self.progress.done < self.all {
            let search = &mut self.searches[self.turn];
            let tried = &search.trials()[self.scores.len()];
            let score = self.tuning.score(Kind::ALL[self.turn], tried);
            self.scores.push(score);
            self.progress.done += 1;
            if score > self.progress.best {
                self.progress.best = score;
            }
            if self.scores.len() == search.trials().len() {
                search.judged(self.scores.drain(..));
                self.turn = (self.turn + 1) % Kind::ALL.len();
            }
        }
        self.progress.clone()
    }

    /// The best so far, beside the gait of before on so many random robots; none as long as no
    /// gait is one that the robot's limits allow.
    pub fn found(&self, robots: usize) -> Option<Found> {
        let mut searches = self.searches.clone();
        if !self.scores.is_empty() {
            searches[self.turn].judged(self.scores.iter().copied());
        }
        let kinds = Kind::ALL.into_iter().zip(&searches);
        let scored = kinds.flat_map(|(kind, search)| {
            let each = search.found().into_iter();
            each.map(move |(score, parameters)| Scored {
                kind,
                score,
                parameters,
            })
        });
        let built = self.tuning.best(scored.collect())?;
        let comparison = self.tuning.compare(&built, robots);
        Some(Found {
            bars: Bars::of(built.gait())?,
            better: comparison.is_better(),
            gain: comparison.gain(),
            comparison,
        })
    }
}

#[cfg(test)]
mod tests {
    use lizard_twin::{ServoModel, Twin};

    use super::*;
    use crate::paper::{TEXT, paper};
    use crate::trial::trial;

    fn wish(name: &str) -> Wish {
        let gait = paper().gait(name).cloned().expect(name);
        Wish {
            bars: Bars::of(&gait).expect("bars"),
            rate: None,
            rounds: 0,
            seed: 3,
        }
    }

    fn refused(wish: &Wish) -> String {
        Faster::begin(TEXT, paper().ground(), wish)
            .expect_err("refused")
            .refused
    }

    #[test]
    fn a_search_that_is_stopped_has_the_best_of_what_it_tried() {
        let robot = paper();
        let mut faster = Faster::begin(TEXT, robot.ground(), &wish("walk")).expect("it begins");
        assert_eq!(faster.begun().all, 40);
        assert_eq!(faster.found(20), None, "nothing is tried yet");
        let best = (0..3).map(|_| faster.step()).last().expect("three").best;
        let found = faster.found(20).expect("one");
        // The same without the page.
        let walk = robot.gait("walk").expect("there");
        let tuning = Tuning::new(&robot, robot.ground(), walk, None, "walk", 3).expect("straight");
        let trials = tuning.search(Kind::Wave).trials().to_vec();
        let scored = trials.into_iter().take(3).filter_map(|parameters| {
            let kind = Kind::Wave;
            let score = tuning.score(kind, &parameters)?;
            Some(Scored {
                kind,
                score,
                parameters,
            })
        });
        let scored: Vec<_> = scored.collect();
        let scores = scored.iter().map(|one| one.score);
        assert_eq!(best, Some(scores.fold(f64::NEG_INFINITY, f64::max)));
        let alone = tuning.best(scored).expect("it walks");
        assert_eq!(found.comparison, tuning.compare(&alone, 20));
        // What the page takes over is the gait that was found.
        assert_eq!(found.bars.table(), alone.fragment());
        let twin = Twin::new(&robot, ServoModel::SG90);
        let tried = trial(TEXT, &found.bars, &twin).expect("it walks");
        assert_eq!(tried.speed, found.comparison.tuned.rate);
        assert_eq!(faster.step().done, 4, "it can go on");
    }

    #[test]
    fn what_cannot_be_made_faster_says_why() {
        assert!(refused(&wish("arc-left")).contains("goes ahead and turns"));
        let rate = Some(900.0);
        assert_eq!(
            refused(&Wish {
                rate,
                ..wish("walk")
            }),
            "servos of at most 900: from 10 to 310 deg/s, which is limits.gait_slew in robot.toml"
        );
        let mut wide = wish("walk");
        wide.bars.amplitude = 60.0;
        assert!(
            refused(&wide).starts_with("gait.walk: "),
            "{}",
            refused(&wide)
        );
    }
}
