//! Compares the given gait with the gait found by the search.

use lizard_kinematics::Check;
use lizard_robot::CheckedGait;
use serde::Serialize;

use crate::scorer::{BuiltGait, Scorer};
use crate::variation::compute_quantiles;

/// The speeds of the given gait and of the tuned gait on the same random robots.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Unit of the speeds: mm/s, or deg/s for a turn.
    pub unit: &'static str,
    /// Largest servo speed of both gaits, deg/s.
    pub rate: f64,
    /// The given gait at the pace at which its fastest servo reaches `rate`.
    pub gait: GaitPerformance,
    /// The tuned gait, which the search has found.
    pub tuned: GaitPerformance,
    /// Number of random robots on which both gaits were simulated.
    #[serde(rename = "robots")]
    pub robot_count: usize,
    /// Number of robots on which the tuned gait is faster than the given gait.
    #[serde(rename = "faster")]
    pub faster_count: usize,
    /// The tuned gait's table for robot.toml.
    pub fragment: String,
}

/// A gait's speeds and smallest margin.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GaitPerformance {
    /// The gait's name.
    pub name: String,
    /// Cycle time, s.
    pub period: f64,
    /// Speed of the fastest servo, deg/s.
    pub rate: f64,
    /// Name and value of the smallest margin; the value is the sine of an angle.
    pub margin: (&'static str, f64),
    /// Speed predicted by the contact model, with ideal servos, mm/s or deg/s.
    pub predicted: f64,
    /// Speed with SG-90 servos and their dead band, simulated frame by frame, mm/s or deg/s.
    pub sg90: f64,
    /// 5th, 50th and 95th percentiles of the speed on the random robots, mm/s or deg/s.
    pub speeds: [f64; 3],
}

impl Comparison {
    /// Simulates both gaits on the scorer's robots, at paces at which their fastest servos reach `rate` (deg/s).
    pub(crate) fn simulate(
        scorer: &Scorer,
        rate: f64,
        gait: &CheckedGait,
        tuned_gait: &BuiltGait,
    ) -> Self {
        // At another pace the gait covers the same distance, so only the period changes.
        let period_factor = gait.audit().peak_speed.speed / rate;
        let (given, given_speeds) = GaitPerformance::simulate(scorer, gait, period_factor);
        let (tuned, tuned_speeds) = GaitPerformance::simulate(scorer, tuned_gait.gait(), 1.0);
        let faster_count = tuned_speeds
            .iter()
            .zip(&given_speeds)
            .filter(|(tuned, given)| tuned > given)
            .count();
        Self {
            unit: scorer.goal().speed_unit(),
            rate,
            gait: given,
            tuned,
            robot_count: tuned_speeds.len(),
            faster_count,
            fragment: tuned_gait.table().to_owned(),
        }
    }

    /// True if the tuned gait has a higher 5th percentile of the speed and is faster on more than half of the robots.
    pub fn is_better(&self) -> bool {
        self.tuned.speeds[0] > self.gait.speeds[0] && 2 * self.faster_count > self.robot_count
    }

    /// Gain in the 5th percentile of the speed, as a fraction of the given gait's value; `None` if that value is not
    /// positive, because the given gait then does not move 95 % of the robots towards its goal.
    pub fn gain(&self) -> Option<f64> {
        let [given, tuned] = [&self.gait, &self.tuned].map(|gait| gait.speeds[0]);
        (given > 0.0).then(|| tuned / given - 1.0)
    }
}

impl GaitPerformance {
    /// Simulates a gait whose period is multiplied by `period_factor`; also returns the speed on each robot.
    fn simulate(scorer: &Scorer, gait: &CheckedGait, period_factor: f64) -> (Self, Vec<f64>) {
        let period = gait.period() * period_factor;
        let audit = gait.audit();
        let margins = [audit.leg, audit.type2, audit.type1].into_iter();
        let min_margin = margins.min_by(|a, b| a.value.total_cmp(&b.value));
        let min_margin = min_margin.unwrap_or(audit.leg);
        let speeds = scorer.compute_speeds(gait, period);
        let performance = Self {
            name: gait.name().to_owned(),
            period,
            rate: audit.peak_speed.speed / period_factor,
            margin: (Check::name(min_margin.check), min_margin.value),
            predicted: scorer.goal().progress(&scorer.simulate_ideal_cycle(gait)) / period,
            sg90: scorer.compute_nominal_speed(gait, period),
            speeds: compute_quantiles(speeds.clone(), [0.05, 0.5, 0.95]),
        };
        (performance, speeds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn make_comparison(given_speed: f64, tuned_speed: f64) -> Comparison {
        let [gait, tuned] = [given_speed, tuned_speed].map(|speed| GaitPerformance {
            name: "x".to_owned(),
            period: 1.0,
            rate: 100.0,
            margin: ("leg", 0.3),
            predicted: speed,
            sg90: speed,
            speeds: [speed; 3],
        });
        Comparison {
            unit: "mm/s",
            rate: 100.0,
            gait,
            tuned,
            robot_count: 1,
            faster_count: 1,
            fragment: String::new(),
        }
    }

    #[test]
    fn only_a_gait_with_a_positive_speed_is_a_base_for_a_gain() {
        assert_eq!(make_comparison(2.0, 5.0).gain(), Some(1.5));
        for given_speed in [0.0, -0.1] {
            let comparison = make_comparison(given_speed, 5.0);
            assert!(comparison.is_better());
            assert_eq!(comparison.gain(), None);
        }
    }
}
