//! The task of finding a faster gait than a given gait, for a robot on a given ground.

use lizard_robot::{CheckedGait, GroundContact, Robot};
use thiserror::Error;

use crate::comparison::Comparison;
use crate::goal::{Goal, GoalError};
use crate::plan::GaitKind;
use crate::scorer::{BuiltGait, Scorer};
use crate::search::Search;

/// Number of random robots in the score of a gait.
const SCORING_ROBOT_COUNT: usize = 16;
/// Offset between the seeds of the search and of the comparison, so that no random robot is in both.
const COMPARISON_SEED_OFFSET: u64 = 1 << 40;
/// Smallest servo speed that a caller may request, deg/s.
const MIN_SERVO_SPEED: f64 = 10.0;

/// The error for an impossible tuning task.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TuningError {
    /// The gait neither walks straight nor turns on the spot.
    #[error(transparent)]
    Goal(#[from] GoalError),
    /// The requested servo speed is too low for walking, or higher than the robot's limits allow.
    #[error(
        "{requested}: must be between {MIN_SERVO_SPEED} and {limit} deg/s (limits.gait_slew in robot.toml)"
    )]
    ServoSpeed {
        /// The requested servo speed, deg/s.
        requested: f64,
        /// The robot's limit of the servo speed, deg/s.
        limit: f64,
    },
}

/// The task of finding a faster gait than a given gait.
#[derive(Debug, Clone)]
pub struct Tuning {
    gait: CheckedGait,
    /// Name of the tuned gait.
    tuned_gait_name: String,
    /// Largest servo speed of the tuned gait, deg/s.
    max_servo_speed: f64,
    /// Largest amplitude of the search, deg.
    max_amplitude: f64,
    scorer: Scorer,
    seed: u64,
}

impl Tuning {
    /// Prepares the search for a faster gait on `ground`. The servo speed is limited to `max_servo_speed` (deg/s) or,
    /// if that is `None`, to the largest servo speed of the given gait. The tuned gait gets the name `name`, which must
    /// be valid in a robot.toml. The call takes as long as a few calls of [`Tuning::score`], because it finds the
    /// largest amplitude within the robot's limits.
    ///
    /// # Errors
    /// Fails if the gait neither walks straight nor turns on the spot, or if the servo speed is out of range.
    pub fn new(
        robot: &Robot,
        ground: &GroundContact,
        gait: &CheckedGait,
        max_servo_speed: Option<f64>,
        name: &str,
        seed: u64,
    ) -> Result<Self, TuningError> {
        let goal = Goal::from_gait(gait, ground)?;
        let limit = robot.speed_limits().gait_slew;
        let max_servo_speed = match max_servo_speed {
            None => gait.audit().peak_speed.speed,
            Some(speed) if (MIN_SERVO_SPEED..=limit).contains(&speed) => speed,
            Some(requested) => return Err(TuningError::ServoSpeed { requested, limit }),
        };
        Ok(Self {
            gait: gait.clone(),
            tuned_gait_name: name.to_owned(),
            max_servo_speed,
            max_amplitude: BuiltGait::find_max_amplitude(robot, goal, max_servo_speed),
            scorer: Scorer::new(robot, ground, goal, SCORING_ROBOT_COUNT, seed),
            seed,
        })
    }

    /// The goal of the given gait and of the search.
    pub const fn goal(&self) -> Goal {
        self.scorer.goal()
    }

    /// Largest servo speed of the tuned gait, deg/s.
    pub const fn max_servo_speed(&self) -> f64 {
        self.max_servo_speed
    }

    /// Starts the search for a kind of gait, independently of other kinds.
    pub fn start_search(&self, kind: GaitKind) -> Search {
        let seed = self.seed.wrapping_add(kind as u64);
        Search::new(&kind.start_parameters(), seed)
    }

    /// Computes the speed that a gait exceeds on 95 % of the random robots, mm/s or deg/s. Returns `None` if the gait
    /// violates a limit of the robot, or if its movement has a component in a direction other than the goal's. The call
    /// takes between 0.01 s and 1 s.
    pub fn score(&self, kind: GaitKind, parameters: &[f64]) -> Option<f64> {
        self.scorer.score(self.build(kind, parameters)?.gait())
    }

    /// Builds the gait with the best score whose movement does not depend on unknown differences between the pads.
    /// `results_by_kind` has the scores and parameters that the searches have found, for each kind in the order of
    /// [`GaitKind::ALL`]. Returns `None` if there is no such gait.
    pub fn build_best(
        &self,
        results_by_kind: impl IntoIterator<Item = Vec<(f64, Vec<f64>)>>,
    ) -> Option<BuiltGait> {
        /// The parameters of a gait of some kind, and their score.
        struct Candidate {
            kind: GaitKind,
            score: f64,
            parameters: Vec<f64>,
        }
        let mut candidates = Vec::new();
        for (kind, results) in GaitKind::ALL.into_iter().zip(results_by_kind) {
            for (score, parameters) in results {
                candidates.push(Candidate {
                    kind,
                    score,
                    parameters,
                });
            }
        }
        candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
        let ground = &self.scorer.ground;
        candidates
            .iter()
            .filter_map(|candidate| self.build(candidate.kind, &candidate.parameters))
            .find(|built| built.gait().predict(ground).is_determined())
    }

    /// Compares the tuned gait with the given gait on random robots that the search has not used.
    pub fn compare(&self, tuned_gait: &BuiltGait, robot_count: usize) -> Comparison {
        let seed = self.seed.wrapping_add(COMPARISON_SEED_OFFSET);
        let Scorer { robot, ground, .. } = &self.scorer;
        let scorer = Scorer::new(robot, ground, self.goal(), robot_count, seed);
        Comparison::simulate(&scorer, self.max_servo_speed, &self.gait, tuned_gait)
    }

    /// Builds the gait for parameters of the search; returns `None` if it violates a limit of the robot.
    fn build(&self, kind: GaitKind, parameters: &[f64]) -> Option<BuiltGait> {
        let name = &self.tuned_gait_name;
        let planned_gait = kind.plan_gait(self.goal(), self.max_amplitude, name, parameters);
        BuiltGait::build(&self.scorer.robot, &planned_gait, self.max_servo_speed)
    }
}
