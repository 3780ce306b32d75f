//! The spread of a gait's distance over slightly different robots and floors.

use std::io::{self, Write};

use lizard_robot::{CheckedGait, Effort, Ground, Robot, TIGHT, Travel};
use lizard_tune::{FRICTION, PLAY_SPREAD, SPREAD, Variation, quantiles};
use lizard_twin::ServoModel;
use serde::Serialize;

use super::replay::Replay;
use super::report::format_part;
use crate::Failure;
use crate::shared::json;
use crate::shared::progress::bar;

/// The spread of a gait's paths.
#[derive(Debug, Serialize)]
struct Spread {
    gait: String,
    times: usize,
    /// The 5th, 50th and 95th percentile of the distance forward, mm.
    forward: [f64; 3],
    /// Distance to the left, mm.
    left: [f64; 3],
    /// Turn, deg counter-clockwise.
    turn: [f64; 3],
    /// Largest share of a servo's torque-speed line: on the robot's own floor, and with the most
    /// friction.
    line: [f64; 2],
}

/// Walks every gait of the run `times` times.
///
/// # Errors
/// Fails if writing fails.
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
        let path = |seed: u64| {
            bar.inc(1);
            Variation::of(robot.ground(), seed)
                .with_play(seed)
                .walked(robot, gait, model)
        };
        let paths: Vec<Travel> = (0..u64::from(times)).map(path).collect();
        let line = [1.0, FRICTION.1].map(|more| {
            let ground = Ground {
                friction: robot.ground().friction * more,
                ..*robot.ground()
            };
            Effort::of(gait, &ground, &robot.motors()).line_share(1.0, 1.0)
        });
        spreads.push(Spread::of(gait.name(), &paths, line));
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
    fn of(gait: &str, paths: &[Travel], line: [f64; 2]) -> Self {
        let part = |quantity: fn(&Travel) -> f64| {
            quantiles(paths.iter().map(quantity).collect(), [0.05, 0.5, 0.95])
        };
        Self {
            gait: gait.to_owned(),
            times: paths.len(),
            forward: part(|path| path.forward),
            left: part(|path| path.left),
            turn: part(|path| path.turn),
            line,
        }
    }
}

fn print(spreads: &[Spread], times: u32, out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "\n{times} robots and floors: {SPREAD}, {PLAY_SPREAD}; a cycle, mm and deg:\n"
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
    writeln!(out, "  line      most")?;
    for spread in spreads {
        write!(out, "{:<12}", spread.gait)?;
        let parts = [spread.forward, spread.left, spread.turn];
        for value in parts.into_iter().flatten() {
            write!(out, "{:>11}", format_part(Some(value), 1))?;
        }
        let [line, most] = spread.line;
        writeln!(out, "{line:>6.2} {most:>9.2}")?;
    }
    writeln!(
        out,
        "\nline: the largest share of a servo's torque-speed line, on the robot's own floor and with the most friction.\n\
         Above {TIGHT} little is left; above 1 a servo falls behind: `lizard gaits --servos`"
    )
}
