//! The replay as one page: what happened as numbers, and the script that draws them.

use lizard_kinematics::Vector;
use lizard_robot::Plate;
use serde::Serialize;

use super::replay::Replay;
use super::report::Report;
use crate::Failure;

const PAGE: &str = include_str!("replay.html");
const HERE: &str = "/*RUN*/null";

/// What the page is given. Lengths in tenths of a mm, whole numbers, so that it stays
/// small.
#[derive(Serialize)]
struct Run {
    /// Seconds from power-on to the first frame.
    first: f64,
    shafts: Vec<i32>,
    /// Both pivots of each leg, the driven one first.
    pivots: Vec<i32>,
    plate: Chassis,
    /// For each frame: forward, left; heading in 1/1000 rad.
    place: Vec<[i32; 3]>,
    /// Joints of each frame in the chassis frame, x then y: four crank tips, four arm
    /// tips, head, tail; each leg's two joints, foot, both anchors of its strut.
    joints: Vec<Vec<i32>>,
    /// Servo angles less neutral, 1/100 deg.
    servos: Vec<[i32; 4]>,
    /// Lags, 1/100 deg.
    lag: Vec<[i32; 4]>,
    /// How far each foot slid, 1/1000 mm.
    slip: Vec<[i32; 4]>,
    /// Of each frame 1/1000: the least type-2, type-1 and leg margin.
    margins: Vec<[i32; 3]>,
    limits: [f64; 3],
    /// Half of each slider, mm: the tubes.
    tubes: [f64; 2],
    stages: Vec<Stage>,
    springs: bool,
    lags: bool,
}

/// The plate with its arms and the servos in it, as [`lizard_robot::Plate`].
#[derive(Serialize)]
struct Chassis {
    half: Vec<i32>,
    corner: i32,
    /// From, to; from, to.
    arms: Vec<i32>,
    arm: i32,
    cases: Vec<i32>,
    case: Vec<i32>,
}

impl Chassis {
    fn of(plate: &Plate) -> Self {
        Self {
            half: tenths([plate.half]),
            corner: tenth(plate.corner),
            arms: tenths(plate.arms.into_iter().flatten().flatten()),
            arm: tenth(plate.arm),
            cases: tenths(plate.cases),
            case: tenths([plate.case]),
        }
    }
}

#[derive(Serialize)]
struct Stage {
    command: String,
    from: usize,
    to: usize,
    /// What it came to, in words.
    text: String,
}

/// The page.
///
/// # Errors
/// None that a value of ours can cause.
pub fn page(replay: &Replay, report: &Report) -> Result<String, Failure> {
    // "</" would end the script that holds the text.
    let run = serde_json::to_string(&run(replay, report))?.replace("</", "<\\/");
    Ok(PAGE.replacen(HERE, &run, 1))
}

fn tenth(length: f64) -> i32 {
    (length * 10.0).round() as i32
}

fn tenths(points: impl IntoIterator<Item = Vector>) -> Vec<i32> {
    points
        .into_iter()
        .flat_map(|point| [tenth(point.x), tenth(point.y)])
        .collect()
}

fn run(replay: &Replay, report: &Report) -> Run {
    let thousandths = |value: f64| (value * 1000.0).round() as i32;
    let hundredths = |values: [f64; 4]| values.map(|value| (value * 100.0).round() as i32);
    let neutral: [f64; 4] = replay.robot.neutral().into();
    let links = replay.robot.lizard().links;
    let limits = replay.robot.limits();
    let first = replay.shapes.iter().flatten().next();
    let mut latest = Vec::new();
    let joints = replay.shapes.iter().map(|shape| {
        // Where a loop does not close, the picture stays as it was.
        if let Some(shape) = shape {
            let legs = shape.legs.iter().flat_map(|leg| {
                let [a, b] = leg.joints;
                [a, b, leg.foot, leg.strut[0], leg.strut[1]]
            });
            let body = shape.tips.into_iter().chain(shape.arms).chain(shape.ends);
            latest = tenths(body.chain(legs));
        }
        latest.clone()
    });
    let joints = joints.collect();
    let states = &replay.states;
    let least = |values: &[f64]| thousandths(values.iter().copied().fold(1.0, f64::min));
    let stages = replay
        .stages
        .iter()
        .filter(|stage| !stage.frames.is_empty());
    Run {
        first: replay.first,
        shafts: first.map_or_else(Vec::new, |shape| tenths(shape.shafts)),
        pivots: first.map_or_else(Vec::new, |shape| {
            tenths(shape.legs.iter().flat_map(|leg| leg.pivots))
        }),
        plate: Chassis::of(&replay.robot.plate()),
        place: states
            .iter()
            .map(|state| {
                let place = state.place;
                [
                    tenth(place.forward),
                    tenth(place.left),
                    thousandths(place.heading),
                ]
            })
            .collect(),
        joints,
        servos: states
            .iter()
            .map(|state| hundredths(std::array::from_fn(|i| state.angles[i] - neutral[i])))
            .collect(),
        lag: states.iter().map(|state| hundredths(state.lag)).collect(),
        slip: states
            .iter()
            .map(|state| state.slip.map(thousandths))
            .collect(),
        margins: states
            .iter()
            .map(|state| {
                state.margins.map_or([0; 3], |margins| {
                    [
                        least(&margins.type2),
                        least(&margins.type1),
                        least(&margins.leg),
                    ]
                })
            })
            .collect(),
        limits: [limits.type2, limits.type1, limits.leg],
        tubes: [links.l12, links.l17],
        stages: stages
            .zip(&report.rows)
            .map(|(stage, row)| Stage {
                command: stage.command.clone(),
                from: stage.frames.start,
                to: stage.frames.end,
                text: row.sentence(),
            })
            .collect(),
        springs: replay.robot.drive().kind != lizard_robot::Kind::Rigid,
        lags: replay.robot.drive().lags(),
    }
}
