//! The task: a gait of a robot on a floor that is to be surpassed.

use lizard_robot::{CheckedGait, Ground, Robot};
use thiserror::Error;

use crate::comparison::Comparison;
use crate::goal::{Goal, NoGoal};
use crate::judge::{Built, Judge};
use crate::plan::{Kind, Plan, Space};
use crate::search::Search;

/// Random robots that a gait is judged by while it is searched.
const JUDGES: usize = 16;
/// Those of the comparison come from seeds that the search has not seen.
const FRESH: u64 = 1 << 40;
/// Servos slower than this do not walk, deg/s.
const SLOWEST: f64 = 10.0;

/// Why a gait cannot be tuned.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NoTuning {
    /// It has no goal.
    #[error(transparent)]
    Goal(#[from] NoGoal),
    /// A wish for servos that do not walk, or that the robot's limits do not allow.
    #[error(
        "{rate}: from {least} to {most} deg/s, which is limits.gait_slew in robot.toml",
        least = SLOWEST
    )]
    Rate {
        /// How fast servos were to turn, deg/s.
        rate: f64,
        /// How fast they may, deg/s.
        most: f64,
    },
}

/// Parameters of a kind of gait (each 0 to 1), and the score of their gait.
#[derive(Debug, Clone, PartialEq)]
pub struct Scored {
    /// The kind.
    pub kind: Kind,
    /// As [`Tuning::score`] has it, mm/s or deg/s.
    pub score: f64,
    /// The parameters.
    pub parameters: Vec<f64>,
}

/// A gait that is to be surpassed.
#[derive(Debug, Clone)]
pub struct Tuning {
    robot: Robot,
    ground: Ground,
    gait: CheckedGait,
    /// What gaits that are found are called.
    name: String,
    rate: f64,
    space: Space,
    judge: Judge,
    seed: u64,
}

impl Tuning {
    /// A gait of a robot on this ground, to be surpassed by servos that turn at `rate` (deg/s),
    /// or as fast as in that gait; what is found will have this name, which a robot.toml must
    /// take. Takes as long as a few trials, because it looks for the widest stride that the
    /// robot's limits allow.
    ///
    /// # Errors
    /// A gait that neither goes straight ahead nor turns on the spot, or a rate that will not
    /// do.
    pub fn new(
        robot: &Robot,
        ground: &Ground,
        gait: &CheckedGait,
        rate: Option<f64>,
        name: &str,
        seed: u64,
    ) -> Result<Self, NoTuning> {
        let goal = Goal::of(gait, ground)?;
        let rate = allowed(robot, gait, rate)?;
        let widest = Built::widest(robot, goal, rate);
        Ok(Self {
            robot: robot.clone(),
            ground: *ground,
            gait: gait.clone(),
            name: name.to_owned(),
            rate,
            space: Space { goal, widest },
            judge: Judge::new(robot, ground, goal, JUDGES, seed),
            seed,
        })
    }

    /// What the gait is for.
    pub const fn goal(&self) -> Goal {
        self.space.goal
    }

    /// How fast a servo may turn, deg/s.
    pub const fn rate(&self) -> f64 {
        self.rate
    }

    /// The search of a kind of gait. Kinds do not depend on each other.
    pub fn search(&self, kind: Kind) -> Search {
        Search::new(&kind.begin(), self.seed.wrapping_add(kind as u64))
    }

    /// The speed that 95 % of the random robots exceed with the gait of such parameters, mm/s or
    /// deg/s; none of one that the robot's limits forbid, or that leads elsewhere. Takes some
    /// hundredths of a second to some tenths.
    pub fn score(&self, kind: Kind, parameters: &[f64]) -> Option<f64> {
        self.judge.score(self.build(kind, parameters)?.gait())
    }

    /// The gait of the best of these whose way does not depend on ties.
    pub fn best(&self, mut scored: Vec<Scored>) -> Option<Built> {
        scored.sort_by(|a, b| b.score.total_cmp(&a.score));
        scored
            .iter()
            .filter_map(|one| self.build(one.kind, &one.parameters))
            .find(|built| built.gait().predict(&self.ground).is_decided())
    }

    /// The gait that was found beside the one that was to be surpassed, on so many random
    /// robots that the search has not seen.
    pub fn compare(&self, found: &Built, robots: usize) -> Comparison {
        let seed = self.seed.wrapping_add(FRESH);
        let judge = Judge::new(&self.robot, &self.ground, self.goal(), robots, seed);
        Comparison::of(&judge, self.rate, &self.gait, found)
    }

    fn build(&self, kind: Kind, parameters: &[f64]) -> Option<Built> {
        let plan = Plan::of(kind, self.space, parameters);
        Built::of(&self.robot, &plan, &self.name, self.rate)
    }
}

/// How fast servos may turn: as asked, or as fast as in the gait.
fn allowed(robot: &Robot, gait: &CheckedGait, asked: Option<f64>) -> Result<f64, NoTuning> {
    let Some(rate) = asked else {
        return Ok(gait.audit().peak.speed);
    };
    let most = robot.pace().gait_slew;
    if (SLOWEST..=most).contains(&rate) {
        return Ok(rate);
    }
    Err(NoTuning::Rate { rate, most })
}
