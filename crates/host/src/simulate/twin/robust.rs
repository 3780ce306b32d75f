//! The spread of a gait's distance over robots and floors that differ a little.

use std::io::{self, Write};

use lizard_robot::{CheckedGait, Robot, Travel};
use lizard_tune::{PLAYED, SPREAD, Variation, quantiles};
use lizard_twin::ServoModel;
use serde::Serialize;

use super::replay::Replay;
use super::report::known;
use crate::Failure;
use crate::shared::json;
use crate::shared::progress::bar;

/// The spread of a gait's paths.
#[derive(Debug, Serialize)]
struct Spread {
    gait: String,
    times: usize,
    /// 5 %, half and 95 % of the ways are below: mm ahead.
    forward: [f64; 3],
    /// Distance to the left, mm.
    left: [f64; 3],
    /// Turn, deg counter-clockwise.
    turn: [f64; 3],
}

/// Walks every gait of the run `times` times.
///
/// # Errors
/// Writing failed.
pub fn run(
    robot: &Robot,
    replay: &Replay,
    model: ServoModel,
    times: u32,
    json: bool,
    out: &mut impl Write,
) -> Result<(), Failure> {
    let gaits: Vec<&CheckedGait> = replay
        .stages
        .iter()
        .filter_map(|stage| robot.gait(&stage.command).filter(|gait| gait.moves()))
        .collect();
    let bar = bar(
        times as usize * gaits.len(),
        "{bar:40} {pos}/{len} walks, {eta}",
    );
    let mut spreads: Vec<Spread> = Vec::new();
    for gait in gaits {
        if spreads.iter().any(|spread| spread.gait == gait.name()) {
            continue;
        }
        let way = |seed: u64| {
            bar.inc(1);
            Variation::of(robot.ground(), seed)
                .with_play(seed)
                .walked(robot, gait, model)
        };
        let ways: Vec<Travel> = (0..u64::from(times)).map(way).collect();
        spreads.push(Spread::of(gait.name(), &ways));
    }
    bar.finish_and_clear();
    if json {
        for spread in &spreads {
            json::line(out, spread)?;
        }
    } else {
        print(&spreads, times, out)?;
    }
    Ok(())
}

impl Spread {
    fn of(gait: &str, ways: &[Travel]) -> Self {
        let part =
            |of: fn(&Travel) -> f64| quantiles(ways.iter().map(of).collect(), [0.05, 0.5, 0.95]);
        Self {
            gait: gait.to_owned(),
            times: ways.len(),
            forward: part(|way| way.forward),
            left: part(|way| way.left),
            turn: part(|way| way.turn),
        }
    }
}

fn print(spreads: &[Spread], times: u32, out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "\n{times} robots and floors: {SPREAD}, {PLAYED}; a cycle, mm and deg:\n"
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
        let parts = [spread.forward, spread.left, spread.turn];
        for value in parts.into_iter().flatten() {
            write!(out, "{:>11}", known(Some(value), 1))?;
        }
        writeln!(out)?;
    }
    Ok(())
}
