//! The result of each command of a run, compared with its prediction.

use std::io::{self, Write};

use lizard_robot::{DriveEffect, Prediction, Robot, RoutineRow, Travel, UNDETERMINED_NOTE};
use lizard_twin::{FRAME_PERIOD_S, ServoModel};
use serde::Serialize;

use super::replay::Replay;
use crate::shared::displacement::Displacement;
use crate::shared::number::{format_or_dash, round_to_decimals};
use crate::simulate::sim::spans::Span;

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
    /// The gait's last complete cycle, and its prediction. Present only if the command is a moving gait without a
    /// count, the gait ran for at least two cycles, and the script does not change the speed; otherwise null.
    pub cycle: Option<Cycle>,
    /// Displacement that `lizard gaits` predicts for one round of a routine with this run's servo model; null for a
    /// routine with inputs, for other commands, and if the script changes the speed.
    pub round: Option<Displacement>,
    /// Distance that each foot slid over the floor, in servo order, mm. This field and the fields below cover the cycle
    /// in `cycle`, or all frames of the command if `cycle` is null.
    pub foot_slip: [f64; 4],
    /// Largest lag of a leg behind its servo, deg.
    pub lag: f64,
    /// Name and value of the smallest margin; null if the linkage's loops close in no frame.
    pub margin: Option<(&'static str, f64)>,
    /// Smallest and largest slider travel, mm; null if the linkage's loops close in no frame.
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
        ServoModel::Ideal | ServoModel::Unloaded { .. } => round.movement,
    };
    Some((round, prediction))
}

/// Summarises a replay in one report for each command, in order of time. If `changes_speed` is true, the script changes
/// the speed of the gaits, and cycles and predicted rounds are omitted.
pub fn compute_reports(
    robot: &Robot,
    replay: &Replay,
    model: ServoModel,
    changes_speed: bool,
) -> Vec<CommandReport> {
    let compute_report = |span: &Span| {
        let frames = replay.frame_range(span);
        let span_totals = replay.compute_totals(frames.clone());
        let cycle = replay.find_last_cycle(span).filter(|_| !changes_speed);
        let cycle_totals = cycle
            .as_ref()
            .map(|(_, frames)| replay.compute_totals(frames.clone()));
        let round = predict_round(robot, &span.command, model).filter(|_| !changes_speed);
        let gait = robot.find_gait_in_line(&span.command);
        let prediction = gait
            .map(|gait| robot.predict(gait))
            .or(round.as_ref().map(|(_, prediction)| *prediction))
            .map(Displacement::from);
        let are_determined = prediction.map_or([true; 3], |prediction| prediction.are_determined());
        let start_s = replay.log.seconds_at(0);
        let seconds_at = |frame: usize| start_s + frame as f64 * FRAME_PERIOD_S;
        let reported_totals = cycle_totals.as_ref().unwrap_or(&span_totals);
        // The frames of a cycle may be up to half a frame longer or shorter than the cycle.
        let scale = cycle.as_ref().map_or(1.0, |(gait, _)| {
            gait.period() / reported_totals.duration_s()
        });
        CommandReport {
            command: span.command.clone(),
            seconds: [frames.start, frames.end].map(seconds_at),
            displacement: Displacement::from_travel(span_totals.travel(), are_determined),
            cycle: cycle.map(|(gait, _)| {
                let travel = reported_totals.travel();
                let travel = Travel {
                    forward: scale * travel.forward,
                    left: scale * travel.left,
                    turn: scale * travel.turn,
                };
                let displacement = Displacement::from_travel(travel, are_determined);
                Cycle {
                    displacement,
                    ideal_displacement: prediction.unwrap_or(displacement),
                    speed: prediction
                        .and_then(|prediction| prediction.forward)
                        .map(|_| travel.forward.hypot(travel.left) / gait.period()),
                    fraction_of_rigid: DriveEffect::compute(gait, robot.ground())
                        .and_then(|effect| effect.fraction_of_rigid),
                }
            }),
            // An input may end a step of the routine earlier or later than the prediction assumes.
            round: round
                .filter(|(round, _)| !round.has_inputs)
                .map(|(_, prediction)| prediction.into()),
            foot_slip: reported_totals.slips.map(|slip| scale * slip),
            lag: reported_totals.max_lag,
            margin: reported_totals
                .min_margin
                .map(|(check, value)| (check.name(), value)),
            stroke: reported_totals.stroke_range,
            servo_rate: reported_totals.max_rate,
            servo_error: reported_totals.max_error,
        }
    };
    let spans = replay.spans.iter();
    let spans = spans.filter(|span| !replay.frame_range(span).is_empty());
    spans.map(compute_report).collect()
}

/// Prints a table of the gaits' cycles, and a line for each other command that moved the body.
///
/// # Errors
/// Fails if writing fails.
pub fn print_table(rows: &[CommandReport], out: &mut impl Write) -> io::Result<()> {
    let has_springs = rows.iter().any(|row| row.lag > 0.0);
    let name_lengths = rows.iter().map(|row| row.command.len());
    let name_width = name_lengths.fold(10, usize::max);
    let (spring_heading, spring_units) = if has_springs {
        ("    springs", "  lag deg  % of rigid")
    } else {
        ("", "")
    };
    if rows.iter().any(|row| row.cycle.is_some()) {
        writeln!(
            out,
            "{:name_width$}   one cycle, mm and deg        by ideal servos            speed  feet slid  least margin       slider, mm   servos{spring_heading}",
            ""
        )?;
        writeln!(
            out,
            "{:name_width$}     ahead    left    turn    ahead    left    turn     mm/s  mm a foot                     least  most   deg/s{spring_units}",
            "gait"
        )?;
    }
    for row in rows {
        let Some(cycle) = &row.cycle else { continue };
        write!(out, "{:name_width$}  ", row.command)?;
        for displacement in [&cycle.displacement, &cycle.ideal_displacement] {
            for component in displacement.components() {
                write!(out, "{:>8}", format_component(component, 1))?;
            }
        }
        let [min_travel, max_travel] = row.stroke.unwrap_or_default();
        write!(
            out,
            " {:>8} {:>10.1}  {:>6} {:<11} {min_travel:>+6.1} {max_travel:>+5.1} {:>7.0}",
            format_or_dash(cycle.speed, 1),
            row.foot_slip.iter().sum::<f64>() / 4.0,
            format_or_dash(row.margin.map(|(_, value)| value), 3),
            row.margin.map_or("", |(name, _)| name),
            row.servo_rate
        )?;
        if has_springs {
            let percent = cycle.fraction_of_rigid.map(|fraction| 100.0 * fraction);
            let percent = format_or_dash(percent, 0);
            write!(out, " {:>8.1} {percent:>11}", row.lag)?;
        }
        writeln!(out)?;
    }
    for row in rows.iter().filter(|row| row.cycle.is_none()) {
        let [start_s, end_s] = row.seconds;
        let mut components = row.displacement.components().into_iter().flatten();
        if !components.any(|component| component.abs() > 0.05) {
            continue;
        }
        writeln!(
            out,
            "\n{} from {start_s:.2} to {end_s:.2} s: {}",
            row.command,
            describe_displacement(&row.displacement)
        )?;
        if let Some(round) = &row.round {
            writeln!(out, "predicted: {}", describe_displacement(round))?;
        }
    }
    let is_undetermined = |row: &CommandReport| row.displacement.components().contains(&None);
    if rows.iter().any(is_undetermined) {
        write!(out, "\n{UNDETERMINED_NOTE}")?;
    }
    Ok(())
}

/// Describes a displacement for the user.
fn describe_displacement(displacement: &Displacement) -> String {
    let components = displacement.components();
    let [forward, left, turn] = components.map(|component| format_component(component, 1));
    format!("ahead {forward} mm, left {left} mm, turn {turn} deg")
}

/// Formats a component of a displacement with its sign, never as `-0`; an undetermined component becomes a dash.
pub fn format_component(component: Option<f64>, decimals: usize) -> String {
    component.map_or("-".to_owned(), |value| {
        format!("{:+.decimals$}", round_to_decimals(value, decimals as i32))
    })
}
