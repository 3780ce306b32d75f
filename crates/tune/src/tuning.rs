//! The tuning task: finding a gait that is faster than a given gait, for a robot on a floor.

use lizard_robot::{CheckedGait, Ground, Robot};
use thiserror::Error;

use crate::comparison::Comparison;
use crate::goal::{Goal, GoalError};
use crate::judge::{BuiltGait, Judge};
use crate::plan::{GaitKind, SearchSpace, plan_gait};
use crate::search::Search;

/// Number of random robots on which the search scores a gait.
const SCORING_ROBOT_COUNT: usize = 16;
/// Offset of the seeds of the comparison's robots from those of the search's robots, so that no robot is in both.
const COMPARISON_SEED_OFFSET: u64 = 1 << 40;
/// Smallest servo speed that is accepted, deg/s.
const MIN_RATE: f64 = 10.0;

/// The error for a gait that cannot be tuned.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TuningError {
    /// The gait neither walks straight nor turns on the spot.
    #[error(transparent)]
    Goal(#[from] GoalError),
    /// The requested servo speed is too low for walking, or higher than the robot's limits allow.
    #[error(
        "{rate}: from {min_rate} to {max_rate} deg/s, which is limits.gait_slew in robot.toml",
        min_rate = MIN_RATE
    )]
    Rate {
        /// The requested servo speed, deg/s.
        rate: f64,
        /// The largest speed allowed, deg/s.
        max_rate: f64,
    },
}

/// Parameters of a gait and their score.
#[derive(Debug, Clone, PartialEq)]
pub struct ScoredParameters {
    /// Kind of the gait.
    pub kind: GaitKind,
    /// Score of the gait by [`Tuning::score`], mm/s or deg/s.
    pub score: f64,
    /// Parameters of the gait, each 0 to 1.
    pub parameters: Vec<f64>,
}

/// The task of finding a gait that is faster than a given gait.
#[derive(Debug, Clone)]
pub struct Tuning {
    robot: Robot,
    ground: Ground,
    gait: CheckedGait,
    /// Name for the gaits that the search finds.
    found_gait_name: String,
    /// Largest speed of a servo, deg/s.
    rate: f64,
    space: SearchSpace,
    judge: Judge,
    seed: u64,
}

impl Tuning {
    /// Prepares the search for a faster gait on this ground. The servos turn at most at `rate` (deg/s) or, if `None`,
    /// as fast as in the given gait. The gaits found get the name `name`, which must be valid in a robot.toml. The
    /// call takes as long as a few trials, because it finds the largest amplitude that the robot's limits allow.
    ///
    /// # Errors
    /// Fails for a gait that neither walks straight nor turns on the spot, or for a rate out of range.
    pub fn new(
        robot: &Robot,
        ground: &Ground,
        gait: &CheckedGait,
        rate: Option<f64>,
        name: &str,
        seed: u64,
    ) -> Result<Self, TuningError> {
        let goal = Goal::from_gait(gait, ground)?;
        let rate = rate_limit(robot, gait, rate)?;
        let max_amplitude = BuiltGait::find_max_amplitude(robot, goal, rate);
        Ok(Self {
            robot: robot.clone(),
            ground: *ground,
            gait: gait.clone(),
            found_gait_name: name.to_owned(),
            rate,
            space: SearchSpace {
                goal,
                max_amplitude,
            },
            judge: Judge::new(robot, ground, goal, SCORING_ROBOT_COUNT, seed),
            seed,
        })
    }

    /// The goal of the given gait, which the search keeps.
    pub const fn goal(&self) -> Goal {
        self.space.goal
    }

    /// Largest speed of a servo that the gaits may use, deg/s.
    pub const fn rate(&self) -> f64 {
        self.rate
    }

    /// Starts the search for a kind of gait. The searches for different kinds are independent of each other.
    pub fn search(&self, kind: GaitKind) -> Search {
        Search::new(
            &kind.start_parameters(),
            self.seed.wrapping_add(kind as u64),
        )
    }

    /// Scores a gait by the speed that it exceeds on 95 % of the random robots, mm/s or deg/s. `None` if the gait
    /// violates a limit of the robot, or if its movement has a component in another direction than the goal's. The call
    /// takes a few hundredths to a few tenths of a second.
    pub fn score(&self, kind: GaitKind, parameters: &[f64]) -> Option<f64> {
        self.judge.score(self.build(kind, parameters)?.gait())
    }

    /// Builds the gait with the best score among those whose movement does not depend on unmeasurable differences
    /// between the pads. `None` if there is no such gait.
    pub fn build_best(&self, mut candidates: Vec<ScoredParameters>) -> Option<BuiltGait> {
        candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
        candidates
            .iter()
            .filter_map(|candidate| self.build(candidate.kind, &candidate.parameters))
            .find(|candidate| candidate.gait().predict(&self.ground).is_decided())
    }

    /// Compares the gait that was found with the given gait, on random robots that the search has not used.
    pub fn compare(&self, found_gait: &BuiltGait, robot_count: usize) -> Comparison {
        let seed = self.seed.wrapping_add(COMPARISON_SEED_OFFSET);
        let judge = Judge::new(&self.robot, &self.ground, self.goal(), robot_count, seed);
        Comparison::simulate(&judge, self.rate, &self.gait, found_gait)
    }

    fn build(&self, kind: GaitKind, parameters: &[f64]) -> Option<BuiltGait> {
        let bars = plan_gait(kind, self.space, &self.found_gait_name, parameters);
        BuiltGait::build(&self.robot, &bars, self.rate)
    }
}

/// Returns the speed limit of the servos, deg/s: the requested limit or, without a request, the gait's own peak
/// speed.
fn rate_limit(
    robot: &Robot,
    gait: &CheckedGait,
    requested_rate: Option<f64>,
) -> Result<f64, TuningError> {
    let Some(rate) = requested_rate else {
        return Ok(gait.audit().peak_speed.speed);
    };
    let max_rate = robot.speed_limits().gait_slew;
    if (MIN_RATE..=max_rate).contains(&rate) {
        return Ok(rate);
    }
    Err(TuningError::Rate { rate, max_rate })
}
