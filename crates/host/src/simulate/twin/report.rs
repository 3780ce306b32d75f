//! The result of each command of a run, compared with its prediction.

use std::io::{self, Write};

use lizard_robot::{DriveEffect, Prediction, Robot, RoutineRow, Travel, UNDETERMINED_NOTE};
use lizard_twin::{FRAME_PERIOD_S, ServoModel};
use serde::Serialize;

use super::replay::Replay;
use crate::shared::displacement::Displacement;
use crate::shared::json;
use crate::shared::number::round_to_decimals;

/// The report of a run: a row for each command.
pub struct Report {
    /// The rows in order of time.
    pub rows: Vec<CommandReport>,
}

/// The result of one command; the serialized field names are the JSON keys.
#[derive(Debug, Serialize)]
pub struct CommandReport {
    /// The command as it was sent.
    pub command: String,
    /// Times of the command's first frame and of the first frame after the command, s since power-on.
    pub seconds: [f64; 2],
    /// Displacement of the body over the complete command.
    #[serde(rename = "way")]
    pub displacement: Displacement,
    /// The gait's last complete cycle, and its prediction.
    pub cycle: Option<Cycle>,
    /// Displacement that `lizard gaits` predicts for one round of a routine with these servos; null for a routine with
    /// inputs, for other commands, and if the script changes the speed.
    pub round: Option<Displacement>,
    /// Distance that each foot slid over the floor, in servo order, mm. This field and the fields below cover the cycle
    /// in `cycle`, or all frames of the command if `cycle` is null.
    pub foot_slip: [f64; 4],
    /// Largest lag of a leg behind its servo, deg.
    pub lag: f64,
    /// Name and value of the smallest margin.
    pub margin: Option<(&'static str, f64)>,
    /// Smallest and largest slider travel, mm.
    pub stroke: Option<[f64; 2]>,
    /// Largest angular rate of a servo, deg/s.
    pub servo_rate: f64,
    /// Largest deviation of a servo from its pulse, deg.
    pub servo_error: f64,
}

/// One cycle of a gait.
#[derive(Debug, Serialize)]
pub struct Cycle {
    /// Displacement of the body during the cycle.
    #[serde(rename = "way")]
    pub displacement: Displacement,
    /// Displacement predicted by the contact model with ideal servos.
    #[serde(rename = "predicted")]
    pub ideal_displacement: Displacement,
    /// Mean speed over the cycle, mm/s; null if the displacement is undetermined.
    pub speed: Option<f64>,
    /// Predicted displacement divided by the displacement with rigid legs; null if the legs are rigid, or if the
    /// displacement with rigid legs is almost zero or undetermined.
    #[serde(rename = "share_of_rigid")]
    pub fraction_of_rigid: Option<f64>,
}

/// Predicts one round of a routine with the servo model `model`; `None` unless the command runs exactly one round of a
/// routine.
fn predict_round(
    robot: &Robot,
    command: &str,
    model: ServoModel,
) -> Option<(RoutineRow, Prediction)> {
    let routine = robot.routine(command.strip_suffix(" 1")?)?;
    let round = RoutineRow::simulate(robot, routine);
    let prediction = match model {
        ServoModel::Motors(_) => round.movement_with_servos,
        ServoModel::Ideal | ServoModel::Unloaded(_) => round.movement,
    };
    Some((round, prediction))
}

impl Displacement {
    /// Returns the components of `travel` that the prediction determines; all components without a prediction.
    fn from_travel(travel: Travel, prediction: Option<&Prediction>) -> Self {
        let keep_determined =
            |component: fn(&Prediction) -> Option<f64>, value: f64| match prediction {
                Some(prediction) => component(prediction).map(|_| value),
                None => Some(value),
            };
        Self {
            forward: keep_determined(|prediction| prediction.forward, travel.forward),
            left: keep_determined(|prediction| prediction.left, travel.left),
            turn: keep_determined(|prediction| prediction.turn, travel.turn),
        }
    }
}

impl Report {
    /// Summarises a replay in one row for each command. If `changes_speed` is true, the script changes the speed of the
    /// gaits, and cycles and predicted rounds are omitted.
    pub fn compute(robot: &Robot, replay: &Replay, model: ServoModel, changes_speed: bool) -> Self {
        let stages = replay
            .stages
            .iter()
            .filter(|stage| !stage.frames.is_empty());
        let compute_row = |stage: &super::replay::Stage| {
            let stage_totals = replay.compute_totals(stage.frames.clone());
            let gait = robot.find_gait_in_line(&stage.command);
            let gait_prediction = gait.map(|gait| robot.predict(gait));
            let cycle = replay.find_last_cycle(stage).filter(|_| !changes_speed);
            let cycle_totals = cycle
                .as_ref()
                .map(|(_, frames)| replay.compute_totals(frames.clone()));
            let round = predict_round(robot, &stage.command, model).filter(|_| !changes_speed);
            let prediction = gait_prediction
                .as_ref()
                .or(round.as_ref().map(|(_, prediction)| prediction));
            let seconds_at = |frame: usize| replay.start_s + frame as f64 * FRAME_PERIOD_S;
            let reported_totals = cycle_totals.as_ref().unwrap_or(&stage_totals);
            CommandReport {
                command: stage.command.clone(),
                seconds: [seconds_at(stage.frames.start), seconds_at(stage.frames.end)],
                displacement: Displacement::from_travel(stage_totals.travel(), prediction),
                cycle: cycle_totals.zip(cycle).map(|(totals, (gait, _))| Cycle {
                    displacement: Displacement::from_travel(totals.travel(), prediction),
                    ideal_displacement: prediction.map_or(
                        Displacement::from_travel(totals.travel(), None),
                        |prediction| (*prediction).into(),
                    ),
                    speed: prediction
                        .and_then(|prediction| prediction.forward)
                        .map(|_| {
                            let travel = totals.travel();
                            travel.forward.hypot(travel.left) / totals.duration_s()
                        }),
                    fraction_of_rigid: DriveEffect::compute(gait, robot.ground())
                        .and_then(|effect| effect.fraction_of_rigid),
                }),
                // An input may end a step of the routine earlier or later than the prediction assumes.
                round: round
                    .filter(|(round, _)| !round.has_inputs)
                    .map(|(_, prediction)| prediction.into()),
                foot_slip: reported_totals.slips,
                lag: reported_totals.max_lag,
                margin: reported_totals
                    .min_margin
                    .map(|(check, value)| (check.name(), value)),
                stroke: reported_totals.stroke_range,
                servo_rate: reported_totals.max_rate,
                servo_error: reported_totals.max_error,
            }
        };
        Self {
            rows: stages.map(compute_row).collect(),
        }
    }

    /// Writes the rows as JSON, one object per line.
    ///
    /// # Errors
    /// Fails if writing fails.
    pub fn write_json(&self, out: &mut impl Write) -> io::Result<()> {
        for row in &self.rows {
            json::write_line(out, row)?;
        }
        Ok(())
    }

    /// Prints a table of the gaits' cycles, and a line for each other command that moved the body.
    ///
    /// # Errors
    /// Fails if writing fails.
    pub fn print(&self, out: &mut impl Write) -> io::Result<()> {
        let has_springs = self.rows.iter().any(|row| row.lag > 0.0);
        let name_width = self
            .rows
            .iter()
            .map(|row| row.command.len())
            .fold(10, usize::max);
        writeln!(
            out,
            "{:name_width$}   one cycle, mm and deg        by ideal servos            speed  feet slid  least margin       slider, mm   servos{}",
            "",
            if has_springs { "    springs" } else { "" }
        )?;
        writeln!(
            out,
            "{:name_width$}     ahead    left    turn    ahead    left    turn     mm/s  mm a foot                     least  most   deg/s{}",
            "gait",
            if has_springs {
                "  lag deg  % of rigid"
            } else {
                ""
            }
        )?;
        for row in &self.rows {
            let Some(cycle) = &row.cycle else { continue };
            write!(out, "{:name_width$}  ", row.command)?;
            for displacement in [&cycle.displacement, &cycle.ideal_displacement] {
                for component in [displacement.forward, displacement.left, displacement.turn] {
                    write!(out, "{:>8}", format_component(component, 1))?;
                }
            }
            write!(
                out,
                " {:>8} {:>10.1}  {:>6} {:<11}",
                cycle
                    .speed
                    .map_or("-".to_owned(), |speed| format!("{speed:.1}")),
                row.foot_slip.iter().sum::<f64>() / 4.0,
                row.margin
                    .map_or("-".to_owned(), |(_, value)| format!("{value:.3}")),
                row.margin.map_or("", |(name, _)| name),
            )?;
            let [min_travel, max_travel] = row.stroke.unwrap_or_default();
            write!(
                out,
                " {min_travel:>+6.1} {max_travel:>+5.1} {:>7.0}",
                row.servo_rate
            )?;
            if has_springs {
                let fraction = cycle.fraction_of_rigid;
                let percent = fraction.map_or("-".to_owned(), |fraction| {
                    format!("{:.0}", 100.0 * fraction)
                });
                write!(out, " {:>8.1} {percent:>11}", row.lag)?;
            }
            writeln!(out)?;
        }
        for row in self.rows.iter().filter(|row| row.cycle.is_none()) {
            let [start_s, end_s] = row.seconds;
            let displacement = &row.displacement;
            if [displacement.forward, displacement.left, displacement.turn]
                .map(|component| component.is_some_and(|component| component.abs() > 0.05))
                == [false; 3]
            {
                continue;
            }
            writeln!(
                out,
                "\n{} from {start_s:.2} to {end_s:.2} s: {}",
                row.command,
                describe_displacement(displacement)
            )?;
            if let Some(round) = &row.round {
                writeln!(out, "predicted: {}", describe_displacement(round))?;
            }
        }
        let is_undetermined = |row: &CommandReport| {
            let displacement = &row.displacement;
            [displacement.forward, displacement.left, displacement.turn].contains(&None)
        };
        if self.rows.iter().any(is_undetermined) {
            write!(out, "\n{UNDETERMINED_NOTE}")?;
        }
        Ok(())
    }
}

/// Describes a displacement for the user.
fn describe_displacement(displacement: &Displacement) -> String {
    let [forward, left, turn] = [displacement.forward, displacement.left, displacement.turn]
        .map(|component| format_component(component, 1));
    format!("ahead {forward} mm, left {left} mm, turn {turn} deg")
}

/// Formats a component of a displacement with its sign, never as `-0`; an undetermined component becomes a dash.
pub fn format_component(component: Option<f64>, decimals: usize) -> String {
    component.map_or("-".to_owned(), |value| {
        format!("{:+.decimals$}", round_to_decimals(value, decimals as i32))
    })
}
