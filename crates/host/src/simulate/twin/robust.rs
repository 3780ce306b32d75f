//! The spread of a gait's displacement over slightly different robots and floors.

use std::io::{self, Write};

use lizard_robot::{
    CheckedGait, Effort, GroundContact, HIGH_UTILISATION, PACES_PERCENT, Robot, Travel,
};
use lizard_tune::{FRICTION_FACTORS, PLAY_SPREAD_TEXT, SPREAD_TEXT, Variation, compute_quantiles};
use lizard_twin::ServoModel;
use serde::Serialize;

use super::replay::Replay;
use super::report::format_component;
use crate::Failure;
use crate::shared::json;
use crate::shared::progress::create_progress_bar;

/// The spread of a gait's displacement per cycle; the serialized field names are the JSON keys.
#[derive(Debug, Serialize)]
struct Spread {
    /// The gait's name.
    gait: String,
    #[serde(rename = "times")]
    variation_count: usize,
    /// The 5th, 50th and 95th percentile of the displacement forward, mm.
    forward: [f64; 3],
    /// The same percentiles of the displacement to the left, mm.
    left: [f64; 3],
    /// The same percentiles of the turn, deg counter-clockwise.
    turn: [f64; 3],
    /// The utilisation of the servos at each pace on each supply.
    #[serde(rename = "lines")]
    utilisations: Vec<Utilisation>,
}

/// A gait's highest utilisation of a servo's torque-speed line at one pace on one supply.
#[derive(Debug, Serialize)]
struct Utilisation {
    /// Pace, percent of the gait's nominal pace.
    pace: f64,
    /// The servos' supply voltage, V.
    volts: f64,
    /// The utilisation on the robot's own floor, and on a floor with the highest friction of the variations; 1 is on
    /// the line, a greater value is beyond it.
    #[serde(rename = "share")]
    by_floor: [f64; 2],
}

impl Utilisation {
    /// Computes a gait's utilisation at each of the [`PACES_PERCENT`] on every supply.
    fn compute_all(robot: &Robot, gait: &CheckedGait) -> Vec<Self> {
        let efforts = [1.0, FRICTION_FACTORS.1].map(|factor| {
            let ground = GroundContact {
                friction_coefficient: robot.ground().friction_coefficient * factor,
                ..*robot.ground()
            };
            Effort::simulate(gait, &ground, &robot.motors())
        });
        let compute_one = |pace: f64, volts: f64| Self {
            pace,
            volts,
            by_floor: efforts.each_ref().map(|effort| {
                effort.utilisation(pace / 100.0, volts / robot.servo_type().supply_volts)
            }),
        };
        let compute_at_pace = |pace| robot.reported_volts().map(|volts| compute_one(pace, volts));
        let paces = PACES_PERCENT.into_iter();
        paces.flat_map(compute_at_pace).collect()
    }
}

/// Simulates every moving gait of the run `variation_count` times with different variations of robot and floor, and
/// prints the spreads.
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
    let gaits = replay.spans.iter();
    let gaits = gaits.filter_map(|span| robot.find_gait_in_line(&span.command));
    let gaits: Vec<&CheckedGait> = gaits.filter(|gait| gait.has_movement()).collect();
    let bar = create_progress_bar(
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
            Variation::sample(robot.ground(), seed)
                .with_play(seed)
                .simulate_cycle(robot, gait, model)
        };
        let travels: Vec<Travel> = (0..u64::from(variation_count)).map(simulate).collect();
        let component_quantiles = |component: fn(&Travel) -> f64| {
            compute_quantiles(travels.iter().map(component).collect(), [0.05, 0.5, 0.95])
        };
        spreads.push(Spread {
            gait: gait.name().to_owned(),
            variation_count: travels.len(),
            forward: component_quantiles(|travel| travel.forward),
            left: component_quantiles(|travel| travel.left),
            turn: component_quantiles(|travel| travel.turn),
            utilisations: Utilisation::compute_all(robot, gait),
        });
    }
    bar.finish_and_clear();
    if is_json {
        for spread in &spreads {
            json::write_line(out, spread)?;
        }
    } else {
        print_tables(&spreads, variation_count, out)?;
    }
    Ok(())
}

/// Prints a table of the spreads and a table of the utilisation, or a message if there is no gait.
fn print_tables(spreads: &[Spread], variation_count: u32, out: &mut impl Write) -> io::Result<()> {
    let Some(first_spread) = spreads.first() else {
        return writeln!(out, "\nno spread: no command is a gait that moves");
    };
    writeln!(
        out,
        "\n{variation_count} robots and floors: {SPREAD_TEXT}, {PLAY_SPREAD_TEXT}; a cycle, mm and deg:\n"
    )?;
    write!(out, "{:<12}", "gait")?;
    for first_column in ["ahead  5 %", "left  5 %", "turn  5 %"] {
        write!(out, "{first_column:>11}{:>11}{:>11}", "50 %", "95 %")?;
    }
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
        "\nThe highest utilisation of a servo's torque-speed line, on the robot's own floor and with the most friction.\n\
         Above {HIGH_UTILISATION}, marked with !, little is left; above 1 a servo falls behind: `lizard gaits --servos`\n"
    )?;
    write!(out, "{:<12}", "gait")?;
    for Utilisation { pace, volts, .. } in &first_spread.utilisations {
        write!(out, "{:>18}", format!("{pace:.0} %, {volts:.2} V"))?;
    }
    writeln!(out)?;
    for spread in spreads {
        write!(out, "{:<12}", spread.gait)?;
        for utilisation in &spread.utilisations {
            let [own_floor, rough_floor] = utilisation.by_floor.map(format_utilisation);
            write!(out, "{:>18}", format!("{own_floor} {rough_floor}"))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Formats a utilisation, with a mark if little torque is left.
fn format_utilisation(utilisation: f64) -> String {
    let mark = if utilisation >= HIGH_UTILISATION {
        '!'
    } else {
        ' '
    };
    format!("{utilisation:.2}{mark}")
}
