//! The comparison of the given gait with the gait that the search has found.

use lizard_kinematics::Check;
use lizard_robot::CheckedGait;
use serde::Serialize;

use crate::judge::{BuiltGait, Judge};
use crate::variation::quantiles;

/// Speeds of the given gait and of the gait that was found, on the same random robots.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Unit of the speeds: mm/s, or deg/s for a turn.
    pub unit: &'static str,
    /// Servo speed that neither gait exceeds, deg/s.
    pub rate: f64,
    /// The given gait, at the pace at which its fastest servo turns at `rate`.
    pub gait: GaitFigures,
    /// The gait that was found.
    pub tuned: GaitFigures,
    /// Number of random robots on which both gaits were simulated.
    #[serde(rename = "robots")]
    pub robot_count: usize,
    /// Number of robots on which the gait that was found is faster than the given gait.
    #[serde(rename = "faster")]
    pub faster_count: usize,
    /// Table for robot.toml that defines the gait that was found.
    pub fragment: String,
}

/// Speeds and margins of a gait.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GaitFigures {
    /// Name of the gait.
    pub name: String,
    /// Time of a cycle, s.
    pub period: f64,
    /// Speed of the fastest servo, deg/s.
    pub rate: f64,
    /// Name and value of the gait's smallest margin; the value is the sine of an angle.
    pub margin: (&'static str, f64),
    /// Speed predicted by the contact model, with ideal servos, mm/s or deg/s.
    pub predicted: f64,
    /// Speed with SG-90 servos and their dead band, simulated frame by frame, mm/s or deg/s.
    pub sg90: f64,
    /// 5th, 50th and 95th percentiles of the speed on the random robots, mm/s or deg/s.
    pub speeds: [f64; 3],
}

impl Comparison {
    /// Simulates both gaits on the judge's robots, at paces at which their fastest servos turn at `rate` (deg/s).
    pub(crate) fn simulate(
        judge: &Judge,
        rate: f64,
        gait: &CheckedGait,
        found_gait: &BuiltGait,
    ) -> Self {
        // At another pace the gait covers the same distance, so only its period changes.
        let period_factor = gait.audit().peak_speed.speed / rate;
        let (given, given_speeds) = GaitFigures::simulate(judge, gait, period_factor);
        let (tuned, tuned_speeds) = GaitFigures::simulate(judge, found_gait.gait(), 1.0);
        let faster_count = tuned_speeds
            .iter()
            .zip(&given_speeds)
            .filter(|(tuned, given)| tuned > given)
            .count();
        Self {
            unit: judge.goal().speed_unit(),
            rate,
            gait: given,
            tuned,
            robot_count: tuned_speeds.len(),
            faster_count,
            fragment: found_gait.table().to_owned(),
        }
    }

    /// True if the speed that 95 % of the robots exceed is higher with the gait that was found, and if that gait is
    /// faster on more than half of the robots.
    pub fn is_better(&self) -> bool {
        self.tuned.speeds[0] > self.gait.speeds[0] && 2 * self.faster_count > self.robot_count
    }

    /// Gain in the speed that 95 % of the robots exceed, as a share of that speed of the given gait.
    pub fn gain(&self) -> f64 {
        self.tuned.speeds[0] / self.gait.speeds[0] - 1.0
    }
}

impl GaitFigures {
    /// Simulates a gait whose period is multiplied by `period_factor`; also returns its speed on each robot.
    fn simulate(judge: &Judge, gait: &CheckedGait, period_factor: f64) -> (Self, Vec<f64>) {
        let period = gait.period() * period_factor;
        let audit = gait.audit();
        let margins = [audit.type2, audit.type1, audit.leg];
        let min_margin = margins.into_iter().fold(audit.leg, |smallest, margin| {
            if margin.value < smallest.value {
                margin
            } else {
                smallest
            }
        });
        let speeds = judge.speeds(gait, period);
        let figures = Self {
            name: gait.name().to_owned(),
            period,
            rate: audit.peak_speed.speed / period_factor,
            margin: (Check::name(min_margin.check), min_margin.value),
            predicted: judge.goal().progress(&judge.simulate_ideal_cycle(gait)) / period,
            sg90: judge.speed_on_robot(gait, period),
            speeds: quantiles(speeds.clone(), [0.05, 0.5, 0.95]),
        };
        (figures, speeds)
    }
}
