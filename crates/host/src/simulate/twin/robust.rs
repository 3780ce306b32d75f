//! The spread of a gait's distance over slightly different robots and floors.

use std::io::{self, Write};

use lizard_robot::{CheckedGait, Effort, Ground, HIGH_LINE_SHARE, PACES_PERCENT, Robot, Travel};
use lizard_tune::{FRICTION_FACTORS, PLAY_SPREAD_TEXT, SPREAD_TEXT, Variation, quantiles};
use lizard_twin::ServoModel;
use serde::Serialize;

use super::replay::Replay;
use super::report::format_component;
use crate::Failure;
use crate::shared::json;
use crate::shared::progress::progress_bar;

/// The spread of a gait's displacement in one cycle.
#[derive(Debug, Serialize)]
struct Spread {
    /// The name of the gait.
    gait: String,
    /// Number of simulated variations.
    times: usize,
    /// The 5th, 50th and 95th percentile of the distance forward, mm.
    forward: [f64; 3],
    /// The same percentiles of the distance to the left, mm.
    left: [f64; 3],
    /// The same percentiles of the turn, deg counter-clockwise.
    turn: [f64; 3],
    /// The load of the servos at each pace on each supply.
    lines: Vec<EffortShare>,
}

/// The largest share of a servo's torque-speed line that a gait uses at one pace on one supply.
#[derive(Debug, Serialize)]
struct EffortShare {
    /// Pace, percent of the gait's own pace.
    pace: f64,
    /// Supply voltage of the servos, V.
    volts: f64,
    /// The share on the robot's own floor, then the share on a floor with the highest friction of the variations; 1 is
    /// the complete line.
    share: [f64; 2],
}

impl EffortShare {
    /// The shares of a gait at each of the [`PACES_PERCENT`] on every supply.
    fn of_gait(robot: &Robot, gait: &CheckedGait) -> Vec<Self> {
        let efforts = [1.0, FRICTION_FACTORS.1].map(|factor| {
            let ground = Ground {
                friction_coefficient: robot.ground().friction_coefficient * factor,
                ..*robot.ground()
            };
            Effort::of(gait, &ground, &robot.motors())
        });
        let share_at = |pace: f64, volts: f64| Self {
            pace,
            volts,
            share: efforts
                .each_ref()
                .map(|effort| effort.line_share(pace / 100.0, volts / robot.servo_type().volts)),
        };
        let shares_at_pace = |pace| robot.reported_volts().map(|volts| share_at(pace, volts));
        PACES_PERCENT.into_iter().flat_map(shares_at_pace).collect()
    }
}

/// Walks every gait of the run `variation_count` times, each time with another variation of robot and floor, and prints
/// the spreads.
///
/// # Errors
/// Fails if writing fails.
pub fn run(
    robot: &Robot,
    replay: &Replay,
    model: ServoModel,
    variation_count: u32,
    is_json: bool,
    out: &mut impl Write,
) -> Result<(), Failure> {
    let gaits: Vec<&CheckedGait> = replay
        .stages
        .iter()
        .filter_map(|stage| {
            robot
                .gait(&stage.command)
                .filter(|gait| gait.has_movement())
        })
        .collect();
    let bar = progress_bar(
        variation_count as usize * gaits.len(),
        "{bar:40} {pos}/{len} walks, {eta}",
    );
    let mut spreads: Vec<Spread> = Vec::new();
    for gait in gaits {
        if spreads.iter().any(|spread| spread.gait == gait.name()) {
            continue;
        }
        let simulate = |seed: u64| {
            bar.inc(1);
            Variation::random(robot.ground(), seed)
                .with_play(seed)
                .simulate_cycle(robot, gait, model)
        };
        let paths: Vec<Travel> = (0..u64::from(variation_count)).map(simulate).collect();
        spreads.push(Spread::from_paths(
            gait.name(),
            &paths,
            EffortShare::of_gait(robot, gait),
        ));
    }
    bar.finish_and_clear();
    if is_json {
        for spread in &spreads {
            json::write_line(out, spread)?;
        }
    } else {
        print(&spreads, variation_count, out)?;
    }
    Ok(())
}

impl Spread {
    /// The spread of a gait over the paths of its variations.
    fn from_paths(gait: &str, paths: &[Travel], lines: Vec<EffortShare>) -> Self {
        let quantiles_of = |quantity: fn(&Travel) -> f64| {
            quantiles(paths.iter().map(quantity).collect(), [0.05, 0.5, 0.95])
        };
        Self {
            gait: gait.to_owned(),
            times: paths.len(),
            forward: quantiles_of(|path| path.forward),
            left: quantiles_of(|path| path.left),
            turn: quantiles_of(|path| path.turn),
            lines,
        }
    }
}

/// Prints a table of the spreads and a table of the shares of the torque-speed line.
fn print(spreads: &[Spread], variation_count: u32, out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "\n{variation_count} robots and floors: {SPREAD_TEXT}, {PLAY_SPREAD_TEXT}; a cycle, mm and deg:\n"
    )?;
    let columns = [
        "ahead  5 %",
        "50 %",
        "95 %",
        "left  5 %",
        "50 %",
        "95 %",
        "turn  5 %",
        "50 %",
        "95 %",
    ];
    write!(out, "{:<12}", "gait")?;
    columns
        .iter()
        .try_for_each(|name| write!(out, "{name:>11}"))?;
    writeln!(out)?;
    for spread in spreads {
        write!(out, "{:<12}", spread.gait)?;
        let components = [spread.forward, spread.left, spread.turn];
        for value in components.into_iter().flatten() {
            write!(out, "{:>11}", format_component(Some(value), 1))?;
        }
        writeln!(out)?;
    }
    writeln!(
        out,
        "\nThe largest share of a servo's torque-speed line, on the robot's own floor and with the most friction.\n\
         Above {HIGH_LINE_SHARE}, marked with !, little is left; above 1 a servo falls behind: `lizard gaits --servos`\n"
    )?;
    let Some(first_spread) = spreads.first() else {
        return Ok(());
    };
    write!(out, "{:<12}", "gait")?;
    for EffortShare { pace, volts, .. } in &first_spread.lines {
        write!(out, "{:>18}", format!("{pace:.0} %, {volts:.2} V"))?;
    }
    writeln!(out)?;
    for spread in spreads {
        write!(out, "{:<12}", spread.gait)?;
        for line in &spread.lines {
            let [own_floor_share, rough_floor_share] = line.share.map(format_share);
            write!(
                out,
                "{:>18}",
                format!("{own_floor_share} {rough_floor_share}")
            )?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Formats a share of the torque-speed line, with a mark if little torque is left.
fn format_share(share: f64) -> String {
    let mark = if share >= HIGH_LINE_SHARE { '!' } else { ' ' };
    format!("{share:.2}{mark}")
}
