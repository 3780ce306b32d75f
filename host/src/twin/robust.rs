//! How far a gait's way spreads over robots and floors that are not quite alike.

use std::io::{self, Write};

use fastrand::Rng;
use indicatif::{ProgressBar, ProgressStyle};
use lizard_robot::{Body, CheckedGait, Feet, Ground, Robot, Spring, Walker};
use serde::Serialize;

use super::replay::Replay;
use super::report::known;
use crate::Failure;

/// How far robots and floors differ: each value is uniform within these bounds around
/// robot.toml's.
const FRICTION: (f64, f64) = (0.5, 1.5);
const PADS: (f64, f64) = (0.9, 1.1);
const CENTRE: f64 = 8.0;
const MOUNT: f64 = 4.0;
const HIPS: f64 = 2.0;
const SPRING: (f64, f64) = (0.8, 1.2);

/// What is said of them, above the table.
const SAID: &str = "friction x 0.5 to 1.5, each pad's x 0.9 to 1.1, backward over forward x 0.9 to 1.1, mass centre +-8 mm,\n\
mounting +-4 deg, hips +-2 mm, springs x 0.8 to 1.2; a cycle, mm and deg:";

/// What a gait's ways come to.
#[derive(Debug, Serialize)]
struct Spread {
    gait: String,
    times: usize,
    /// 5 %, half and 95 % of the ways are below: mm ahead.
    forward: [f64; 3],
    /// mm left
    left: [f64; 3],
    /// deg counter-clockwise
    turn: [f64; 3],
}

/// Walks every gait of the run `times` times.
///
/// # Errors
/// Writing failed.
pub fn run(
    robot: &Robot,
    replay: &Replay,
    times: u32,
    json: bool,
    out: &mut impl Write,
) -> Result<(), Failure> {
    let gaits: Vec<&CheckedGait> = replay
        .stages
        .iter()
        .filter_map(|stage| robot.gait(&stage.command).filter(|gait| gait.moves()))
        .collect();
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} walks, {eta}")
        .expect("the template is well formed");
    let bar = ProgressBar::new(u64::from(times) * gaits.len() as u64).with_style(style);
    let mut spreads: Vec<Spread> = Vec::new();
    for gait in gaits {
        if spreads.iter().any(|spread| spread.gait == gait.name()) {
            continue;
        }
        let way = |seed: u64| {
            bar.inc(1);
            walked(gait, robot.ground(), &mut Rng::with_seed(seed))
        };
        let ways = (0..u64::from(times)).map(way).collect();
        spreads.push(Spread::of(gait.name(), ways));
    }
    bar.finish_and_clear();
    if json {
        for spread in &spreads {
            serde_json::to_writer(&mut *out, spread)?;
            writeln!(out)?;
        }
    } else {
        print(&spreads, times, out)?;
    }
    Ok(())
}

/// The second cycle of a gait on a robot and a floor of chance.
fn walked(gait: &CheckedGait, ground: &Ground, rng: &mut Rng) -> [f64; 3] {
    /// Frames of 10 ms in a cycle of a second: the spread needs no more.
    const STEPS: usize = 100;
    let mut within = |(low, high): (f64, f64)| low + (high - low) * rng.f64();
    let feet = ground.feet;
    let ground = Ground {
        feet: Feet {
            mount: feet.mount + within((-MOUNT, MOUNT)),
            hip_forward: feet.hip_forward + within((-HIPS, HIPS)),
            hip_side: feet.hip_side + within((-HIPS, HIPS)),
            ..feet
        },
        body: Body {
            centre: ground.body.centre.map(|at| at + within((-CENTRE, CENTRE))),
            ..ground.body
        },
        friction: ground.friction * within(FRICTION),
        spring: ground.spring.map(|spring| Spring {
            rate: spring.rate * within(SPRING),
            preload: spring.preload * within(SPRING),
        }),
        ..*ground
    };
    let pads = std::array::from_fn(|_| within(PADS));
    let ratio = within(PADS);
    let at = |step: usize| gait.sweeps(gait.phase(gait.period() * step as f64 / STEPS as f64));
    let mut walker = Walker::uneven(ground, at(0), pads, ratio);
    let mut begin = walker.place();
    for step in 1..=2 * STEPS {
        walker.step(at(step));
        if step == STEPS {
            begin = walker.place();
        }
    }
    let way = walker.place().seen_from(begin);
    [way.forward, way.left, way.turn]
}

impl Spread {
    fn of(gait: &str, ways: Vec<[f64; 3]>) -> Self {
        let part = |i: usize| -> [f64; 3] {
            let mut values: Vec<f64> = ways.iter().map(|way| way[i]).collect();
            values.sort_by(f64::total_cmp);
            let at = |share: f64| values[(share * (values.len() - 1) as f64).round() as usize];
            [0.05, 0.5, 0.95].map(at)
        };
        Self {
            gait: gait.to_owned(),
            times: ways.len(),
            forward: part(0),
            left: part(1),
            turn: part(2),
        }
    }
}

fn print(spreads: &[Spread], times: u32, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "\n{times} robots and floors: {SAID}\n")?;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walk_goes_ahead_on_nearly_every_robot_and_floor() {
        let robot = Robot::parse(include_str!("../../../robots/paper.toml")).expect("right");
        let walk = robot.gait("walk").expect("walk");
        let ways = (0..40).map(|seed| walked(walk, robot.ground(), &mut Rng::with_seed(seed)));
        let spread = Spread::of("walk", ways.collect());
        let [low, middle, high] = spread.forward;
        assert!(
            25.0 < low && low < middle && middle < high && high < 40.0,
            "{spread:?}"
        );
        assert!(spread.turn[0] < 0.0 && spread.turn[2] > 0.0, "{spread:?}");
    }

    #[test]
    fn a_share_is_below_each_quantile() {
        let ways = (0..=100)
            .map(|i| [f64::from(i), 0.0, -f64::from(i)])
            .collect();
        let spread = Spread::of("x", ways);
        assert_eq!(
            (spread.forward, spread.turn),
            ([5.0, 50.0, 95.0], [-95.0, -50.0, -5.0])
        );
    }
}
