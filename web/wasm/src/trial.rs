//! The trial of an edited gait on a robot, before the gait is written to a file.
//!
//! Only the edited gait is checked, so that the answer comes while the user still drags the value. A refusal offers the
//! nearest smaller gait and the nearest longer period that are valid.

use lizard_robot::servo::SERVO_NAMES;
use lizard_robot::{Bars, Robot, edit};
use lizard_twin::Twin;
use serde::{Deserialize, Serialize};
use tsify::Tsify;

use crate::drawn_gait::DrawnGait;
use crate::prediction::GaitPrediction;
use crate::refusal::Refusal;

/// Size of the smallest offered gait, in tenths of a degree of amplitude or hundredths of the drawn size.
const MIN_SIZE_STEPS: i64 = 5;
/// Longest period in robot.toml, in hundredths of a second.
const MAX_PERIOD_HUNDREDTHS: i64 = 6000;

/// An edited gait.
#[derive(Clone, Debug, PartialEq, Deserialize, Tsify)]
#[serde(untagged)]
pub enum EditedGait {
    /// A gait along a drawn line.
    DrawnGait(DrawnGait),
    /// A gait whose legs share a waveform, each with its own start and gain.
    Bars(Bars),
}

/// The result of the trial of a valid gait.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Trial {
    /// Prediction of a cycle.
    #[serde(flatten)]
    pub prediction: GaitPrediction,
    /// The gait's table for robot.toml.
    pub table: String,
    /// Name of the margin that comes nearest to its limit.
    pub margin_name: &'static str,
    /// Smallest value of that margin, the sine of an angle.
    pub min_margin: f64,
    /// Limit of that margin, the sine of an angle.
    pub margin_limit: f64,
    /// Name of the servo that turns fastest.
    pub fastest_servo: &'static str,
    /// Largest speed of that servo, deg/s.
    pub max_servo_speed: f64,
    /// Duration of a cycle, s.
    pub period: f64,
}

/// A value that makes a refused gait valid.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Alternative {
    /// Name of the changed parameter: `amplitude`, `size` or `period`.
    #[tsify(type = "'amplitude' | 'size' | 'period'")]
    pub parameter: &'static str,
    /// Valid value: an amplitude in deg, a size as a factor, or a period in s.
    pub value: f64,
}

/// The refusal of a gait, with valid alternatives.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct RefusedTrial {
    /// The refusal.
    #[serde(flatten)]
    pub refusal: Refusal,
    /// The nearest valid values; each of them alone makes the gait valid.
    pub alternatives: Vec<Alternative>,
}

impl EditedGait {
    fn format_table(&self, robot: &Robot) -> Option<String> {
        match self {
            Self::DrawnGait(drawn_gait) => drawn_gait.format_table(robot),
            Self::Bars(bars) => Some(bars.to_toml()),
        }
    }

    /// Returns the text of a robot.toml with this gait. The gait replaces the gait of the same name, or else is added
    /// at the end. `None` if the drawn line has no length.
    pub fn put_into(&self, text: &str, robot: &Robot) -> Option<String> {
        let (Self::DrawnGait(DrawnGait { name, .. }) | Self::Bars(Bars { name, .. })) = self;
        Some(edit::with_gait(text, name, &self.format_table(robot)?))
    }

    /// Tries the gait with a twin's robot, floor and servos; `None` if the drawn line has no length.
    ///
    /// # Errors
    /// Returns the first limit that the gait violates, with valid alternatives.
    pub fn try_on(&self, twin: &Twin) -> Option<Result<Trial, RefusedTrial>> {
        let table = self.format_table(twin.robot())?;
        Some(try_table(table, twin).map_err(|refusal| RefusedTrial {
            refusal,
            alternatives: self.find_alternatives(twin.robot()),
        }))
    }

    /// Finds the nearest smaller gait and the nearest longer period that are valid.
    fn find_alternatives(&self, robot: &Robot) -> Vec<Alternative> {
        let (size_parameter, size, steps_per_unit, period) = match self {
            Self::DrawnGait(drawn_gait) => ("size", drawn_gait.size, 100.0, drawn_gait.period),
            Self::Bars(bars) => ("amplitude", bars.amplitude, 10.0, bars.period),
        };
        let is_valid_with = |size: f64, period: f64| {
            let mut changed_gait = self.clone();
            match &mut changed_gait {
                Self::DrawnGait(drawn_gait) => {
                    drawn_gait.size = size;
                    drawn_gait.period = period;
                }
                Self::Bars(bars) => {
                    bars.amplitude = size;
                    bars.period = period;
                }
            }
            let table = changed_gait.format_table(robot);
            table.is_some_and(|table| robot.with_gait(&table).is_ok())
        };
        let is_size_valid = |steps: i64| is_valid_with(steps as f64 / steps_per_unit, period);
        let is_period_valid = |hundredths: i64| is_valid_with(size, hundredths as f64 / 100.0);
        let largest_steps = (size * steps_per_unit).ceil() as i64 - 1;
        let size_steps = find_nearest_valid(largest_steps, MIN_SIZE_STEPS, is_size_valid);
        let min_hundredths = (period * 100.0).floor() as i64 + 1;
        let hundredths = find_nearest_valid(min_hundredths, MAX_PERIOD_HUNDREDTHS, is_period_valid);
        let size = size_steps.map(|steps| (size_parameter, steps as f64 / steps_per_unit));
        let period = hundredths.map(|hundredths| ("period", hundredths as f64 / 100.0));
        let alternatives = size.into_iter().chain(period);
        alternatives
            .map(|(parameter, value)| Alternative { parameter, value })
            .collect()
    }
}

/// Tries a gait; `table` has the format of robot.toml.
fn try_table(table: String, twin: &Twin) -> Result<Trial, Refusal> {
    let robot = twin.robot().with_gait(&table).map_err(Refusal::for_gait)?;
    let mut trial_twin = Twin::new(&robot, twin.servo_model());
    trial_twin.set_ground(*twin.ground());
    // The first gait of this robot is `stand`.
    let gait = &robot.gaits()[1];
    let (audit, limits) = (gait.audit(), robot.limits());
    let margins = [
        (audit.type2, limits.type2),
        (audit.type1, limits.type1),
        (audit.leg, limits.leg),
    ];
    let (nearest_margin, margin_limit) = margins
        .into_iter()
        .min_by(|a, b| (a.0.value - a.1).total_cmp(&(b.0.value - b.1)))
        .expect("there are three margins");
    Ok(Trial {
        prediction: GaitPrediction::predict(&trial_twin, gait),
        table,
        margin_name: nearest_margin.check.name(),
        min_margin: nearest_margin.value,
        margin_limit,
        fastest_servo: SERVO_NAMES[audit.peak_speed.servo],
        max_servo_speed: audit.peak_speed.speed,
        period: gait.period(),
    })
}

/// Bisects between `from` and `to`, and returns the valid number nearest to `from`. All numbers between a valid number
/// and `to` must be valid, too. `None` if `to` is invalid or equals `from`.
fn find_nearest_valid(from: i64, to: i64, is_valid: impl Fn(i64) -> bool) -> Option<i64> {
    let direction = (to - from).signum();
    if direction == 0 || !is_valid(to) {
        return None;
    }
    let (mut invalid, mut valid) = (from - direction, to);
    while (valid - invalid).abs() > 1 {
        let midpoint = i64::midpoint(invalid, valid);
        match is_valid(midpoint) {
            true => valid = midpoint,
            false => invalid = midpoint,
        }
    }
    Some(valid)
}

#[cfg(test)]
mod tests;
