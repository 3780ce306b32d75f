//! Builds and scores gaits. A gait is computed and checked like any gait in robot.toml, at the pace at which its
//! fastest servo reaches the speed limit. Then the gait is simulated on random robots.

use lizard_robot::{Bars, CheckedGait, GroundContact, Robot, Travel};
use lizard_twin::ServoModel;

use crate::goal::Goal;
use crate::plan::{GaitKind, MAX_PERIOD_S};
use crate::variation::{Variation, compute_quantiles};

/// Bounds of the search for a robot's largest amplitude, deg.
const AMPLITUDE_BOUNDS: (f64, f64) = (5.0, 80.0);
/// The servos of the random robots. Their dead band reduces small strides by a larger fraction than large strides.
const SERVO_MODEL: ServoModel = ServoModel::SG90;
/// First period that is tried, s; so long that on most robots no servo exceeds its speed limit.
const SLOW_PERIOD_S: f64 = 3.0;
/// Number of iterations that fit the period to the servo speed.
const PERIOD_ITERATIONS: usize = 3;
/// Fraction of the random robots that are slower than the score.
const SLOWEST_FRACTION: f64 = 0.05;

/// A built and checked gait, with its table for robot.toml.
#[derive(Debug, Clone)]
pub struct BuiltGait {
    /// The robot with only this gait and `stand`.
    robot: Robot,
    table: String,
}

impl BuiltGait {
    /// Builds a gait with nearly the shortest period at which no servo exceeds `max_servo_speed` (deg/s). Returns
    /// `None` if the gait violates a limit of the robot, or if no period up to [`MAX_PERIOD_S`] is found.
    pub(crate) fn build(robot: &Robot, bars: &Bars, max_servo_speed: f64) -> Option<Self> {
        let build_with_period = |period: f64| {
            let mut bars = bars.clone();
            bars.period = period;
            let table = bars.to_toml();
            let robot = robot.with_gait(&table).ok()?;
            Some(Self { robot, table })
        };
        let mut shortest_gait: Option<Self> = None;
        let mut built =
            build_with_period(SLOW_PERIOD_S).or_else(|| build_with_period(MAX_PERIOD_S))?;
        for _ in 0..PERIOD_ITERATIONS {
            let period =
                round_period(built.gait().period() * built.peak_servo_speed() / max_servo_speed);
            if period > MAX_PERIOD_S {
                return None;
            }
            built = build_with_period(period)?;
            let is_shorter = |shortest: &Self| period < shortest.gait().period();
            let is_within_limit = built.peak_servo_speed() <= max_servo_speed;
            if is_within_limit && shortest_gait.as_ref().is_none_or(is_shorter) {
                shortest_gait = Some(built.clone());
            }
        }
        // The peak speed depends on the phases of the frames, so a slightly shorter period may also keep the servos
        // within the limit.
        let shorter_gait = build_with_period(shortest_gait.as_ref()?.gait().period() - 0.01);
        shorter_gait
            .filter(|gait| gait.peak_servo_speed() <= max_servo_speed)
            .or(shortest_gait)
    }

    /// Finds the largest amplitude, deg, at which a wave gait with the first of its start parameters is within the
    /// robot's limits.
    pub(crate) fn find_max_amplitude(robot: &Robot, goal: Goal, max_servo_speed: f64) -> f64 {
        let is_within_limits = |amplitude: f64| {
            let parameters = &GaitKind::Wave.start_parameters()[0];
            let bars = GaitKind::Wave.plan_gait(goal, amplitude, "x", parameters);
            Self::build(robot, &bars, max_servo_speed).is_some()
        };
        let (mut low, mut high) = AMPLITUDE_BOUNDS;
        while high - low > 0.2 {
            let middle = f64::midpoint(low, high);
            if is_within_limits(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// The checked gait.
    pub fn gait(&self) -> &CheckedGait {
        // The built gait follows `stand`, so it is the last.
        self.robot.gaits().last().unwrap_or(&self.robot.gaits()[0])
    }

    /// The gait's table for robot.toml.
    pub fn table(&self) -> &str {
        &self.table
    }

    /// Speed of the fastest servo, deg/s.
    fn peak_servo_speed(&self) -> f64 {
        self.gait().audit().peak_speed.speed
    }
}

/// Rounds a period up to hundredths of a second, at least 0.2 s.
fn round_period(period: f64) -> f64 {
    // The subtraction keeps a rounding error from raising the period to the next hundredth.
    ((period * 100.0 - 1e-6).ceil() / 100.0).max(0.2)
}

/// Scores gaits on random robots.
#[derive(Debug, Clone)]
pub struct Scorer {
    /// The robot without variation.
    pub robot: Robot,
    /// The ground without variation.
    pub ground: GroundContact,
    goal: Goal,
    variations: Vec<Variation>,
}

impl Scorer {
    /// Creates `robot_count` random variations of the robot and the ground, with consecutive seeds from `seed` on.
    pub fn new(
        robot: &Robot,
        ground: &GroundContact,
        goal: Goal,
        robot_count: usize,
        seed: u64,
    ) -> Self {
        let sample = |index: u64| Variation::sample(ground, seed.wrapping_add(index));
        Self {
            robot: robot.clone(),
            ground: *ground,
            goal,
            variations: (0..robot_count as u64).map(sample).collect(),
        }
    }

    /// Computes the speed of a gait on each random robot, mm/s or deg/s, if a cycle takes `period` seconds.
    pub fn compute_speeds(&self, gait: &CheckedGait, period: f64) -> Vec<f64> {
        let variations = self.variations.iter();
        let speeds = variations.map(|variation| self.compute_speed(variation, gait, period));
        speeds.collect()
    }

    /// Computes the speed of a gait on the robot without variation, mm/s or deg/s, if a cycle takes `period` seconds.
    pub fn compute_nominal_speed(&self, gait: &CheckedGait, period: f64) -> f64 {
        self.compute_speed(&Variation::nominal(&self.ground), gait, period)
    }

    /// Simulates a cycle frame by frame with servos of [`SERVO_MODEL`], and computes the speed, mm/s or deg/s, if the
    /// cycle takes `period` seconds.
    fn compute_speed(&self, variation: &Variation, gait: &CheckedGait, period: f64) -> f64 {
        let movement = variation.simulate_cycle(&self.robot, gait, SERVO_MODEL);
        self.goal.progress(&movement) / period
    }

    /// The goal towards which gaits are scored.
    pub const fn goal(&self) -> Goal {
        self.goal
    }

    /// Simulates a cycle in fine steps on the robot without variation, with ideal servos.
    pub fn simulate_ideal_cycle(&self, gait: &CheckedGait) -> Travel {
        gait.simulate_cycle(&self.ground).travel
    }

    /// Computes the speed that the gait exceeds on 95 % of the random robots. Returns `None` if the movement of the
    /// robot without variation has a component in a direction other than the goal's.
    pub fn score(&self, gait: &CheckedGait) -> Option<f64> {
        // The direction is checked in fine steps. If the period is not a whole number of frames, a simulation by frames
        // does not include the end of the cycle, so it would show a sideways movement.
        let ideal_movement = self.simulate_ideal_cycle(gait);
        if !self.goal.is_free_of_drift(&ideal_movement) {
            return None;
        }
        let speeds = self.compute_speeds(gait, gait.period());
        let [score] = compute_quantiles(speeds, [SLOWEST_FRACTION]);
        Some(score)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper_robot() -> Robot {
        Robot::parse(include_str!("../../../robots/paper.toml")).expect("paper.toml is valid")
    }

    #[test]
    fn the_leg_margin_limits_the_amplitude_of_the_papers_robot_at_any_speed_limit() {
        let text = include_str!("../../../robots/paper.toml");
        let (dimensions, _) = text.split_once("[gait.stand]").expect("the first gait");
        let stand = "[gait.stand]\nperiod = 1.0\nwaveform = \"still\"\n";
        for (speed_limit, max_servo_speed) in [(310.0, 262.0), (60.0, 50.0)] {
            let limit = format!("gait_slew = {speed_limit}");
            let text = dimensions.replacen("gait_slew = 310.0", &limit, 1) + stand;
            let robot = Robot::parse(&text).expect("the robot is valid");
            let max_amplitude =
                BuiltGait::find_max_amplitude(&robot, Goal::Straight(1.0), max_servo_speed);
            // The limit of the leg margin: sin(41.41 deg - amplitude) = 0.3.
            assert!(
                (max_amplitude - (41.41 - 0.3f64.asin().to_degrees())).abs() < 0.4,
                "largest amplitude {max_amplitude} deg at up to {speed_limit} deg/s"
            );
        }
    }

    #[test]
    fn a_built_gait_uses_more_than_97_percent_of_the_allowed_servo_speed() {
        let robot = paper_robot();
        let parameters = [0.5, 0.25, 0.375, 0.5];
        let bars = GaitKind::Wave.plan_gait(Goal::Straight(1.0), 45.0, "x", &parameters);
        for allowed in [150.0, 262.2, 300.0] {
            let built = BuiltGait::build(&robot, &bars, allowed);
            let built = built.expect("the gait is within the limits");
            let used = built.peak_servo_speed();
            assert!(
                used <= allowed && used > 0.97 * allowed,
                "allowed: {allowed} deg/s, used: {used} deg/s"
            );
        }
    }

    #[test]
    fn the_score_is_below_the_speed_of_the_robot_without_variation() {
        let robot = paper_robot();
        for (name, goal, min_score) in [
            ("walk", Goal::Straight(1.0), 28.0),
            ("left", Goal::Turn(1.0), 13.0),
        ] {
            let gait = robot.gait(name).expect("paper.toml has the gait");
            let scorer = Scorer::new(&robot, robot.ground(), goal, 20, 0);
            let score = scorer.score(gait).expect("the gait moves towards its goal");
            let nominal_speed = scorer.compute_nominal_speed(gait, gait.period());
            assert!(
                min_score < score && score < nominal_speed,
                "{name}: score {score}, nominal speed {nominal_speed}"
            );
        }
    }

    #[test]
    fn a_gait_that_moves_in_another_direction_than_the_goal_has_no_score() {
        let robot = paper_robot();
        let walk = robot.gait("walk").expect("paper.toml has the gait");
        let turn_scorer = Scorer::new(&robot, robot.ground(), Goal::Turn(1.0), 2, 0);
        assert_eq!(turn_scorer.score(walk), None);
    }
}
