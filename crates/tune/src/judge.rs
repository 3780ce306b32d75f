//! How good a plan is: its gait is computed and checked like any gait of robot.toml, at
//! the pace at which its fastest servo turns as fast as it may, and walked on random
//! robots.

use lizard_robot::{CheckedGait, Ground, Robot, Travel};
use lizard_twin::ServoModel;

use crate::goal::Goal;
use crate::plan::{Kind, LONGEST, Plan, Space};
use crate::variation::{Variation, quantiles};

/// The largest amplitude of a robot's legs is between these, deg.
const WIDTHS: (f64, f64) = (5.0, 80.0);
/// What its servos can do: small strides lose a larger share to their dead band.
const SERVOS: ServoModel = ServoModel::SG90;
/// A pace at which no servo is too fast, to learn how fast they are, s.
const SLOW: f64 = 3.0;
/// Rounds in which the period is fitted to the rate.
const FITS: usize = 3;
/// What every robot.toml begins with.
const STAND: &str = "[gait.stand]\nperiod = 1.0\nwaveform = \"still\"\n";
/// What every one but this share of the robots surpasses.
const SLOWEST: f64 = 0.05;

/// A gait with its period and the table of robot.toml that it was read from.
#[derive(Debug, Clone)]
pub struct Built {
    /// The robot that has this gait and `stand`.
    robot: Robot,
    /// Its table.
    fragment: String,
}

impl Built {
    /// The gait of a plan, its period the shortest with servos not faster than `rate`
    /// (deg/s); none where a limit of the robot forbids it.
    pub(crate) fn of(robot: &Robot, plan: &Plan, name: &str, rate: f64) -> Option<Self> {
        let build = |period: f64| {
            let fragment = plan.fragment(name, period);
            let robot = robot.with_gaits(&format!("{STAND}{fragment}")).ok()?;
            Some(Self { robot, fragment })
        };
        let mut fits = None;
        let mut built = build(SLOW)?;
        for _ in 0..FITS {
            let period = fitted(built.gait().period() * built.peak() / rate);
            if period > LONGEST {
                return None;
            }
            built = build(period)?;
            if built.peak() > rate {
                continue;
            }
            if fits
                .as_ref()
                .is_none_or(|fits: &Self| period < fits.gait().period())
            {
                fits = Some(built.clone());
            }
        }
        // A shorter period is a longer mean of the servo's turn in a frame.
        let shorter = build(fits.as_ref()?.gait().period() - 0.01);
        shorter.filter(|shorter| shorter.peak() <= rate).or(fits)
    }

    /// The largest amplitude with which a plain walk is within the robot's limits, deg.
    pub(crate) fn widest(robot: &Robot, goal: Goal, rate: f64) -> f64 {
        let walks = |widest: f64| {
            let plan = Plan::of(Kind::Wave, Space { goal, widest }, &Kind::Wave.begin()[0]);
            Self::of(robot, &plan, "x", rate).is_some()
        };
        let (mut low, mut high) = WIDTHS;
        while high - low > 0.2 {
            let middle = f64::midpoint(low, high);
            if walks(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// The gait.
    pub fn gait(&self) -> &CheckedGait {
        // `stand` is the other one.
        self.robot.gaits().last().unwrap_or(&self.robot.gaits()[0])
    }

    /// Its table for robot.toml.
    pub fn fragment(&self) -> &str {
        &self.fragment
    }

    /// How fast its fastest servo turns, deg/s.
    fn peak(&self) -> f64 {
        self.gait().audit().peak.speed
    }
}

/// A period as it is written: hundredths of a second, not shorter than 0.2.
fn fitted(period: f64) -> f64 {
    // What is a hundredth but for rounding is not the next one.
    ((period * 100.0 - 1e-6).ceil() / 100.0).max(0.2)
}

/// Random robots that a gait is judged by.
#[derive(Debug, Clone)]
pub struct Judge {
    robot: Robot,
    ground: Ground,
    goal: Goal,
    robots: Vec<Variation>,
}

impl Judge {
    /// So many robots around this one on this ground, from this seed on.
    pub fn new(robot: &Robot, ground: &Ground, goal: Goal, robots: usize, seed: u64) -> Self {
        let of = |n: u64| Variation::of(ground, seed.wrapping_add(n));
        Self {
            robot: robot.clone(),
            ground: *ground,
            goal,
            robots: (0..robots as u64).map(of).collect(),
        }
    }

    /// What a gait reaches in a second on each robot: mm or deg.
    pub fn speeds(&self, gait: &CheckedGait, period: f64) -> Vec<f64> {
        let way = |varied: &Variation| varied.walked(&self.robot, gait, SERVOS);
        let speed = |varied: &Variation| self.goal.reached(&way(varied)) / period;
        self.robots.iter().map(speed).collect()
    }

    /// What it reaches in a second on the robot itself.
    pub fn exact(&self, gait: &CheckedGait, period: f64) -> f64 {
        self.goal.reached(&self.way(gait)) / period
    }

    /// What the gaits are for.
    pub const fn goal(&self) -> Goal {
        self.goal
    }

    /// Where a cycle in fine steps leads the robot itself, with servos that are where their
    /// pulses say.
    pub fn cycle(&self, gait: &CheckedGait) -> Travel {
        gait.walked(&self.ground).travel
    }

    /// Where a cycle leads the robot itself.
    fn way(&self, gait: &CheckedGait) -> Travel {
        Variation::none(&self.ground).walked(&self.robot, gait, SERVOS)
    }

    /// The speed that 95 % of the robots exceed; none for a gait that does not lead
    /// straight to its goal on the robot itself.
    pub fn score(&self, gait: &CheckedGait) -> Option<f64> {
        // Asked of a cycle in fine steps: frames of 20 ms leave a period a remainder.
        if !self.goal.is_true_to(&self.cycle(gait)) {
            return None;
        }
        let [slowest] = quantiles(self.speeds(gait, gait.period()), [SLOWEST]);
        Some(slowest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper() -> Robot {
        Robot::parse(include_str!("../../../robots/paper.toml")).expect("right")
    }

    fn plan(widest: f64, share: f64) -> Plan {
        let space = Space {
            goal: Goal::Ahead(1.0),
            widest,
        };
        Plan::of(Kind::Wave, space, &[0.5, 0.25, share, 0.5])
    }

    #[test]
    fn the_papers_legs_swing_as_wide_as_their_margin_allows() {
        // sin(41.41 deg - amplitude) = 0.3.
        let widest = Built::widest(&paper(), Goal::Ahead(1.0), 262.0);
        assert!(
            (widest - (41.41 - 0.3f64.asin().to_degrees())).abs() < 0.4,
            "{widest}"
        );
    }

    #[test]
    fn a_gait_is_as_fast_as_its_servos_may_be() {
        let robot = paper();
        let plan = plan(45.0, 0.375);
        for rate in [150.0, 262.2, 300.0] {
            let built = Built::of(&robot, &plan, "x", rate).expect("it walks");
            assert!(
                built.peak() <= rate && built.peak() > 0.97 * rate,
                "{rate} {}",
                built.peak()
            );
        }
    }

    #[test]
    fn what_a_limit_forbids_is_no_gait() {
        // 45 deg to either side take the legs beyond their margin.
        let wide = plan(45.0, 1.0);
        assert!(Built::of(&paper(), &wide, "x", 250.0).is_none());
    }

    #[test]
    fn todays_walk_and_left_score_as_they_are_predicted() {
        let robot = paper();
        for (name, goal, least) in [
            ("walk", Goal::Ahead(1.0), 28.0),
            ("left", Goal::Turn(1.0), 13.0),
        ] {
            let gait = robot.gait(name).expect(name);
            let judge = Judge::new(&robot, robot.ground(), goal, 20, 0);
            let score = judge.score(gait).expect("it leads there");
            let exact = judge.exact(gait, gait.period());
            assert!(least < score && score < exact, "{name} {score} {exact}");
        }
        let walk = robot.gait("walk").expect("walk");
        let turn = Judge::new(&robot, robot.ground(), Goal::Turn(1.0), 2, 0);
        assert_eq!(turn.score(walk), None);
    }
}
