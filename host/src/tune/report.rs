//! The result, compared with the gait that was to be improved.

use std::io::{self, Write};

use lizard_kinematics::Check;
use lizard_robot::{CheckedGait, Robot};
use serde::Serialize;

use super::goal::Goal;
use super::judge::{Built, Judge};
use crate::variation::{SPREAD, quantiles};

/// The comparison.
#[derive(Debug, Serialize)]
pub struct Report {
    /// mm/s, or deg/s for a turn.
    unit: &'static str,
    /// How fast a servo may turn, deg/s.
    rate: f64,
    /// The gait that was to be surpassed, at a pace with that rate.
    pub gait: Figures,
    /// The one that was found.
    pub tuned: Figures,
    /// Random robots that both were walked on.
    robots: usize,
    /// On how many of them the one that was found is faster.
    pub faster: usize,
    /// Its table for robot.toml.
    pub fragment: String,
}

/// What a gait comes to.
#[derive(Debug, Serialize)]
pub struct Figures {
    name: String,
    /// s
    period: f64,
    /// Its fastest servo, deg/s.
    pub rate: f64,
    /// Its smallest margin, a sine, and which one.
    margin: (&'static str, f64),
    /// By the contact model, with servos that are where their pulses say.
    pub predicted: f64,
    /// The same frame by frame as the firmware sends it, to SG-90 with their dead band.
    sg90: f64,
    /// The same on random robots: 5 %, half and 95 % are slower.
    pub speeds: [f64; 3],
}

impl Report {
    /// Walks both gaits on the judge's robots.
    pub fn of(
        robot: &Robot,
        judge: &Judge,
        goal: Goal,
        rate: f64,
        gait: &CheckedGait,
        found: &Built,
    ) -> Self {
        // At another pace it goes the same way in another time.
        let paced = gait.audit().peak.speed / rate;
        let (before, all_before) = Figures::of(robot, judge, goal, gait, paced);
        let (tuned, all_tuned) = Figures::of(robot, judge, goal, found.gait(), 1.0);
        let faster = all_tuned
            .iter()
            .zip(&all_before)
            .filter(|(a, b)| a > b)
            .count();
        Self {
            unit: goal.unit(),
            rate,
            gait: before,
            tuned,
            robots: all_tuned.len(),
            faster,
            fragment: found.fragment.clone(),
        }
    }

    /// Whether the gait was surpassed where it counts: on the slow robots.
    fn is_better(&self) -> bool {
        self.tuned.speeds[0] > self.gait.speeds[0] && 2 * self.faster > self.robots
    }

    /// Prints it as a piece of a robot.toml: all but the table is comment.
    pub fn print(&self, out: &mut impl Write) -> io::Result<()> {
        let Self {
            unit,
            robots,
            faster,
            ..
        } = self;
        let (gait, tuned) = (&self.gait.name, &self.tuned.name);
        writeln!(
            out,
            "# {unit} with servos of at most {:.1} deg/s; the last three on {robots} random robots and floors\n#",
            self.rate
        )?;
        let width = [gait, tuned]
            .map(|name| name.len())
            .into_iter()
            .fold(8, usize::max);
        writeln!(
            out,
            "# {:width$}  cycle, s   deg/s  least margin      predicted   SG-90     5 %    50 %    95 %",
            "gait"
        )?;
        for row in [&self.gait, &self.tuned] {
            let [low, middle, high] = row.speeds;
            let (margin, value) = row.margin;
            writeln!(
                out,
                "# {:width$}  {:8.2}  {:6.1}  {value:.3} {margin:10}  {:9.1}  {:6.1}  {low:6.1}  {middle:6.1}  {high:6.1}",
                row.name, row.period, row.rate, row.predicted, row.sg90
            )?;
        }
        writeln!(out, "#")?;
        if self.is_better() {
            let [a, b] = [&self.tuned, &self.gait].map(|row| row.speeds[0]);
            writeln!(
                out,
                "# {tuned} is faster than {gait} on {faster} of {robots}, and by {:.0} % where 5 % are slower.",
                100.0 * (a / b - 1.0)
            )?;
        } else {
            writeln!(
                out,
                "# No gait of these kinds was found that surpasses {gait} on the slow ones; this is the best,\n\
                 # faster on {faster} of {robots}:"
            )?;
        }
        writeln!(out, "# At random: {}.\n", SPREAD.replace('\n', "\n# "))?;
        write!(out, "{}", self.fragment)
    }
}

impl Figures {
    /// Of a gait whose cycle is `paced` times as long, and its speed on each robot.
    fn of(
        robot: &Robot,
        judge: &Judge,
        goal: Goal,
        gait: &CheckedGait,
        paced: f64,
    ) -> (Self, Vec<f64>) {
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
            predicted: goal.reached(&gait.walked(robot.ground()).travel) / period,
            sg90: judge.exact(gait, period),
            speeds: quantiles(speeds.clone(), [0.05, 0.5, 0.95]),
        };
        (figures, speeds)
    }
}
