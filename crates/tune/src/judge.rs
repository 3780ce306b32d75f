//! The score of a gait. The gait is computed and checked like any gait of robot.toml, at the pace at which its fastest
//! servo reaches the speed limit. Then the gait is simulated on random robots.

use lizard_robot::{Bars, CheckedGait, Ground, Robot, Travel};
use lizard_twin::ServoModel;

use crate::goal::Goal;
use crate::plan::{GaitKind, MAX_PERIOD_S, SearchSpace, plan_gait};
use crate::variation::{Variation, quantiles};

/// Bounds of the search for a robot's largest amplitude, deg.
const AMPLITUDE_BOUNDS: (f64, f64) = (5.0, 80.0);
/// The servos of the random robots. Their dead band reduces small strides by a larger share than large strides.
const SERVO_MODEL: ServoModel = ServoModel::SG90;
/// A period at which no servo exceeds its speed limit, s. The gait's servo speed is measured at this period.
const SLOW_PERIOD_S: f64 = 3.0;
/// Number of iterations that fit the period to the servo speed.
const PERIOD_ITERATIONS: usize = 3;
/// The share of the robots that are slower than the score.
const SLOWEST_SHARE: f64 = 0.05;

/// A gait of the search, built and checked, with its table for robot.toml.
#[derive(Debug, Clone)]
pub struct BuiltGait {
    /// The robot with only this gait and `stand`.
    robot: Robot,
    table: String,
}

impl BuiltGait {
    /// Builds a gait with the shortest period at which no servo is faster than `max_rate` (deg/s). Returns `None` if
    /// the gait violates a limit of the robot, or if that period is longer than [`MAX_PERIOD_S`].
    pub(crate) fn build(robot: &Robot, bars: &Bars, max_rate: f64) -> Option<Self> {
        let build_with_period = |period: f64| {
            let bars = Bars {
                period,
                ..bars.clone()
            };
            let table = bars.to_toml();
            let robot = robot.with_gait(&table).ok()?;
            Some(Self { robot, table })
        };
        let mut shortest_gait: Option<Self> = None;
        let mut built = build_with_period(SLOW_PERIOD_S)?;
        for _ in 0..PERIOD_ITERATIONS {
            let period = round_period(built.gait().period() * built.peak_rate() / max_rate);
            if period > MAX_PERIOD_S {
                return None;
            }
            built = build_with_period(period)?;
            let is_shorter = |shortest: &Self| period < shortest.gait().period();
            if built.peak_rate() <= max_rate && shortest_gait.as_ref().is_none_or(is_shorter) {
                shortest_gait = Some(built.clone());
            }
        }
        // The peak speed depends on the phases at which frames are sent, so a slightly shorter period may also keep
        // the servos within the limit.
        let shorter_gait = build_with_period(shortest_gait.as_ref()?.gait().period() - 0.01);
        shorter_gait
            .filter(|gait| gait.peak_rate() <= max_rate)
            .or(shortest_gait)
    }

    /// Finds the largest amplitude, deg, at which a wave gait with the first start parameters of the search is within
    /// the robot's limits.
    pub(crate) fn find_max_amplitude(robot: &Robot, goal: Goal, max_rate: f64) -> f64 {
        let is_within_limits = |max_amplitude: f64| {
            let start = &GaitKind::Wave.start_parameters()[0];
            let bars = plan_gait(
                GaitKind::Wave,
                SearchSpace {
                    goal,
                    max_amplitude,
                },
                "x",
                start,
            );
            Self::build(robot, &bars, max_rate).is_some()
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
        // The first gait is `stand`.
        self.robot.gaits().last().unwrap_or(&self.robot.gaits()[0])
    }

    /// The gait's table for robot.toml.
    pub fn table(&self) -> &str {
        &self.table
    }

    /// Speed of the fastest servo, deg/s.
    fn peak_rate(&self) -> f64 {
        self.gait().audit().peak_speed.speed
    }
}

/// Rounds a period up to hundredths of a second, at least 0.2 s.
fn round_period(period: f64) -> f64 {
    // A rounding error must not raise the period to the next hundredth.
    ((period * 100.0 - 1e-6).ceil() / 100.0).max(0.2)
}

/// The random robots on which gaits are scored.
#[derive(Debug, Clone)]
pub struct Judge {
    robot: Robot,
    ground: Ground,
    goal: Goal,
    variations: Vec<Variation>,
}

impl Judge {
    /// Draws `robot_count` random variations of this robot on this ground, from consecutive seeds, the first of which
    /// is `seed`.
    pub fn new(robot: &Robot, ground: &Ground, goal: Goal, robot_count: usize, seed: u64) -> Self {
        let variation_of = |index: u64| Variation::random(ground, seed.wrapping_add(index));
        Self {
            robot: robot.clone(),
            ground: *ground,
            goal,
            variations: (0..robot_count as u64).map(variation_of).collect(),
        }
    }

    /// Computes the speed of a gait on each random robot, mm/s or deg/s.
    pub fn speeds(&self, gait: &CheckedGait, period: f64) -> Vec<f64> {
        let movement_of =
            |variation: &Variation| variation.simulate_cycle(&self.robot, gait, SERVO_MODEL);
        let speed_of = |variation: &Variation| self.goal.progress(&movement_of(variation)) / period;
        self.variations.iter().map(speed_of).collect()
    }

    /// Computes the speed of a gait on the robot itself, mm/s or deg/s.
    pub fn speed_on_robot(&self, gait: &CheckedGait, period: f64) -> f64 {
        self.goal.progress(&self.simulate_cycle_by_frames(gait)) / period
    }

    /// The goal towards which gaits are scored.
    pub const fn goal(&self) -> Goal {
        self.goal
    }

    /// Simulates a cycle on the robot itself in fine steps, with ideal servos.
    pub fn simulate_ideal_cycle(&self, gait: &CheckedGait) -> Travel {
        gait.simulate_cycle(&self.ground).travel
    }

    /// Simulates a cycle on the robot itself frame by frame, with the servos [`SERVO_MODEL`].
    fn simulate_cycle_by_frames(&self, gait: &CheckedGait) -> Travel {
        Variation::unvaried(&self.ground).simulate_cycle(&self.robot, gait, SERVO_MODEL)
    }

    /// Computes the speed that the gait exceeds on 95 % of the random robots. `None` if the gait's movement on the
    /// robot itself has a component in another direction than the goal's.
    pub fn score(&self, gait: &CheckedGait) -> Option<f64> {
        // A simulation by frames would miss the end of a cycle whose period is not a whole number of frames, and so
        // show a sideways movement. So the direction is checked in fine steps.
        if !self.goal.is_direction_of(&self.simulate_ideal_cycle(gait)) {
            return None;
        }
        let [score] = quantiles(self.speeds(gait, gait.period()), [SLOWEST_SHARE]);
        Some(score)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper_robot() -> Robot {
        Robot::parse(include_str!("../../../robots/paper.toml")).expect("paper.toml is valid")
    }

    fn wave_bars(max_amplitude: f64, amplitude_share: f64) -> Bars {
        let space = SearchSpace {
            goal: Goal::Ahead(1.0),
            max_amplitude,
        };
        plan_gait(
            GaitKind::Wave,
            space,
            "x",
            &[0.5, 0.25, amplitude_share, 0.5],
        )
    }

    #[test]
    fn the_largest_amplitude_of_the_papers_robot_is_the_one_that_its_leg_margin_allows() {
        // sin(41.41 deg - amplitude) = 0.3.
        let max_amplitude = BuiltGait::find_max_amplitude(&paper_robot(), Goal::Ahead(1.0), 262.0);
        assert!(
            (max_amplitude - (41.41 - 0.3f64.asin().to_degrees())).abs() < 0.4,
            "{max_amplitude}"
        );
    }

    #[test]
    fn a_built_gait_uses_the_servo_speed_that_is_allowed() {
        let robot = paper_robot();
        let bars = wave_bars(45.0, 0.375);
        for rate in [150.0, 262.2, 300.0] {
            let built =
                BuiltGait::build(&robot, &bars, rate).expect("the gait is within the limits");
            assert!(
                built.peak_rate() <= rate && built.peak_rate() > 0.97 * rate,
                "{rate} {}",
                built.peak_rate()
            );
        }
    }

    #[test]
    fn a_gait_beyond_a_limit_is_not_built() {
        // At 45 deg in both directions, the margins of the legs are below their limit.
        let wide_bars = wave_bars(45.0, 1.0);
        assert!(BuiltGait::build(&paper_robot(), &wide_bars, 250.0).is_none());
    }

    #[test]
    fn walk_and_left_score_below_their_speed_on_the_robot_itself() {
        let robot = paper_robot();
        for (name, goal, min_score) in [
            ("walk", Goal::Ahead(1.0), 28.0),
            ("left", Goal::Turn(1.0), 13.0),
        ] {
            let gait = robot.gait(name).expect("paper.toml has the gait");
            let judge = Judge::new(&robot, robot.ground(), goal, 20, 0);
            let score = judge.score(gait).expect("the gait moves towards its goal");
            let robot_speed = judge.speed_on_robot(gait, gait.period());
            assert!(
                min_score < score && score < robot_speed,
                "{name} {score} {robot_speed}"
            );
        }
        let walk = robot.gait("walk").expect("paper.toml has the gait");
        let turn_judge = Judge::new(&robot, robot.ground(), Goal::Turn(1.0), 2, 0);
        assert_eq!(turn_judge.score(walk), None);
    }
}
