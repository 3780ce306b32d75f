//! What was found beside the gait that was to be surpassed.

use lizard_kinematics::Check;
use lizard_robot::CheckedGait;
use serde::Serialize;

use crate::judge::{Built, Judge};
use crate::variation::quantiles;

/// Two gaits on the same random robots.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// mm/s, or deg/s for a turn.
    pub unit: &'static str,
    /// How fast a servo may turn, deg/s.
    pub rate: f64,
    /// The gait that was to be surpassed, at a pace with that rate.
    pub gait: Figures,
    /// The one that was found.
    pub tuned: Figures,
    /// Random robots that both were walked on.
    pub robots: usize,
    /// On how many of them the one that was found is faster.
    pub faster: usize,
    /// Its table for robot.toml.
    pub fragment: String,
}

/// What a gait comes to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figures {
    /// Its name.
    pub name: String,
    /// s
    pub period: f64,
    /// Its fastest servo, deg/s.
    pub rate: f64,
    /// Its smallest margin, a sine, and which one.
    pub margin: (&'static str, f64),
    /// By the contact model, with servos that are where their pulses say.
    pub predicted: f64,
    /// The same frame by frame as the firmware sends it, to SG-90 with their dead band.
    pub sg90: f64,
    /// The same on random robots: 5 %, half and 95 % are slower.
    pub speeds: [f64; 3],
}

impl Comparison {
    /// Walks both gaits on the judge's robots.
    pub(crate) fn of(judge: &Judge, rate: f64, gait: &CheckedGait, found: &Built) -> Self {
        // At another pace it goes the same way in another time.
        let paced = gait.audit().peak.speed / rate;
        let (before, all_before) = Figures::of(judge, gait, paced);
        let (tuned, all_tuned) = Figures::of(judge, found.gait(), 1.0);
        let faster = all_tuned
            .iter()
            .zip(&all_before)
            .filter(|(a, b)| a > b)
            .count();
        Self {
            unit: judge.goal().unit(),
            rate,
            gait: before,
            tuned,
            robots: all_tuned.len(),
            faster,
            fragment: found.fragment().to_owned(),
        }
    }

    /// Whether the gait was surpassed where it counts: on the slow robots.
    pub fn is_better(&self) -> bool {
        self.tuned.speeds[0] > self.gait.speeds[0] && 2 * self.faster > self.robots
    }

    /// By what share the one that was found is faster where 5 % of the robots are slower.
    pub fn gain(&self) -> f64 {
        self.tuned.speeds[0] / self.gait.speeds[0] - 1.0
    }
}

impl Figures {
    /// Of a gait whose cycle is `paced` times as long, and its speed on each robot.
    fn of(judge: &Judge, gait: &CheckedGait, paced: f64) -> (Self, Vec<f64>) {
        let period = gait.period() * paced;
        let audit = gait.audit();
        let least = [audit.type2, audit.type1, audit.leg];
        let least = least
            .into_iter()
            .fold(audit.leg, |a, b| if b.value < a.value { b } else { a });
        let speeds = judge.speeds(gait, period);
        let figures = Self {
            name: gait.name().to_owned(),
            period,
            rate: audit.peak.speed / paced,
            margin: (Check::name(least.what), least.value),
            predicted: judge.goal().reached(&judge.cycle(gait)) / period,
            sg90: judge.exact(gait, period),
            speeds: quantiles(speeds.clone(), [0.05, 0.5, 0.95]),
        };
        (figures, speeds)
    }
}
