//! Comparison of the contact model and MuJoCo on pads with a grain, which have more friction backward than forward: the
//! speeds of the gaits of `robots/grain.toml` at five friction ratios.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use lizard_parts::{Assembly, Course, Scene};
use lizard_robot::{CheckedGait, Ground, Robot, Stance};

use crate::case::Legs;
use crate::crate_folder;
use crate::figures::{Displacement, Results};
use crate::mujoco::{Jobs, MujocoError};

/// The name of the robot's file.
pub const ROBOT: &str = "grain";
/// The ratios of backward to forward friction that are compared.
pub const RATIOS: [f64; 5] = [1.0, 1.1, 1.2, 1.5, 2.0];
/// The gaits that are compared, without mirror images. The flag is true if the gait pushes some pads against the grain.
pub const GAITS: [(&str, bool); 5] = [
    ("run", false),
    ("walk", false),
    ("back", true),
    ("left", true),
    ("arc-left", false),
];
/// The largest friction ratio at which the model and MuJoCo must agree on a gait against the grain. Above this ratio,
/// the pads that push have hardly more friction than the pad that returns, so the result depends on inertia, which the
/// model ignores.
const MAX_RATIO_AGAINST: f64 = 1.5;
/// An allowed difference between MuJoCo and the model in a cycle. The larger of `mm` and `share` is the bound of the
/// distance.
struct Bound {
    mm: f64,
    /// A share of the model's distance.
    share: f64,
    deg: f64,
}

const BOUND: Bound = Bound {
    mm: 3.0,
    share: 0.2,
    deg: 2.0,
};
/// The time that a gait needs to accelerate the body from rest, s. Then the motion repeats from cycle to cycle.
const SETTLING_S: f64 = 1.5;

/// The results by gait, in the order of [`RATIOS`].
pub type GrainResults = BTreeMap<String, Vec<Results>>;

/// Returns the results stored in `grains.json`.
///
/// # Panics
/// If `grains.json` does not have the format of [`to_json`].
pub fn stored() -> GrainResults {
    serde_json::from_str(include_str!("../grains.json"))
        .expect("grains.json has the expected format")
}

/// Returns the text of `grains.json`, with a line for each walk.
///
/// # Panics
/// Never: names and numbers can always be written as JSON.
pub fn to_json(grains: &GrainResults) -> String {
    let gaits = grains.iter().map(|(gait, results)| {
        let lines = results
            .iter()
            .map(|results| serde_json::to_string(results).expect("numbers can be written as JSON"));
        format!("{gait:?}: [\n{}\n]", lines.collect::<Vec<_>>().join(",\n"))
    });
    format!("{{\n{}\n}}\n", gaits.collect::<Vec<_>>().join(",\n"))
}

/// Returns the model's displacement with level feet; `None` if two feet pull against the other two, so that the model
/// has no result.
pub fn model_displacement(robot: &Robot, gait: &CheckedGait, ratio: f64) -> Option<Displacement> {
    let ground = Ground {
        stance: Stance {
            stiffness: robot.ground().stance.stiffness,
            ..Stance::LEVEL
        },
        friction_ratio: ratio,
        ..*robot.ground()
    };
    let is_decided = gait.predict(&ground).is_decided();
    is_decided.then(|| gait.simulate_cycle(&ground).travel.into())
}

/// Computes the results of the model and MuJoCo for every gait and ratio.
///
/// # Errors
/// Fails if MuJoCo gives no result.
///
/// # Panics
/// If the robot does not have the gaits.
pub fn measure(robot: &Robot) -> Result<GrainResults, MujocoError> {
    let assembly = Assembly::new(robot);
    let walk_name = |gait: &str, index: usize| format!("{gait}-{index}");
    let gaits = GAITS.map(|(name, _)| robot.gait(name).expect("the robot has this gait"));
    let mut jobs = Jobs::new()?;
    let scenes = gaits.iter().flat_map(|gait| {
        let ratios = RATIOS.into_iter().enumerate();
        ratios.map(|(index, ratio)| scene(walk_name(gait.name(), index), &assembly, gait, ratio))
    });
    jobs.add(&assembly, scenes.map(|scene| (Legs::Rigid, scene)))?;
    let by_mujoco = jobs.start()?.wait()?;
    let grains = gaits.iter().map(|gait| {
        let results = RATIOS
            .into_iter()
            .enumerate()
            .map(|(index, ratio)| Results {
                model: model_displacement(robot, gait, ratio),
                mujoco: by_mujoco[&walk_name(gait.name(), index)],
            });
        (gait.name().to_owned(), results.collect())
    });
    Ok(grains.collect())
}

/// Returns the number of cycles until a gait's motion repeats from cycle to cycle.
pub(crate) fn settling_cycle_count(gait: &CheckedGait) -> u32 {
    (SETTLING_S / gait.period()).ceil() as u32
}

/// Returns the results of a gait at the ratio in the robot's file.
pub(crate) fn results_at_own_ratio(results: &[Results]) -> Results {
    let own_ratio = crate::load_robot(ROBOT).ground().friction_ratio;
    let index = RATIOS.iter().position(|ratio| *ratio == own_ratio);
    results[index.expect("the file's ratio is one of the table's")]
}

fn scene(name: String, assembly: &Assembly, gait: &CheckedGait, ratio: f64) -> Scene {
    let robot = assembly.robot();
    let cycles = settling_cycle_count(gait) + 1;
    Scene {
        name,
        friction_ratio: ratio,
        course: Some(Course::of(robot, gait, cycles, 1)),
        has_shapes: false,
        ..Scene::of(assembly)
    }
}

/// Returns a message for each result of MuJoCo that is too far from the model's.
pub fn disagreements(grains: &GrainResults) -> Vec<String> {
    let mut messages = Vec::new();
    for (gait, is_against_grain) in GAITS {
        for (ratio, results) in RATIOS.into_iter().zip(&grains[gait]) {
            let Some(model) = results.model else {
                continue;
            };
            let (distance_error, turn_error) = results.mujoco.distance_to(&model);
            let displacement = model.0[0].hypot(model.0[1]);
            let max_distance_error = BOUND.mm.max(BOUND.share * displacement);
            let is_too_far = distance_error > max_distance_error || turn_error > BOUND.deg;
            if is_too_far && !(is_against_grain && ratio > MAX_RATIO_AGAINST) {
                messages.push(format!(
                    "{ROBOT}: {gait} (r {ratio}): MuJoCo is {distance_error:.1} mm and {turn_error:.1} deg from the model"
                ));
            }
        }
    }
    messages
}

/// Returns a table of the model's and MuJoCo's speeds, mm/s ahead and deg/s counter-clockwise.
///
/// # Panics
/// If a gait is missing.
pub fn table(robot: &Robot, grains: &GrainResults) -> String {
    let mut text = format!("{:16}", "model, MuJoCo");
    for ratio in RATIOS {
        let heading = format!("r = {ratio:.1}");
        _ = write!(text, "  {heading:>13}");
    }
    text.push('\n');
    // The component of the displacement that is the gait's purpose: 0 is the distance ahead, 2 is the turn.
    let rows = GAITS.into_iter().flat_map(|(gait, _)| match gait {
        "left" => vec![(gait, 2)],
        "arc-left" => vec![(gait, 0), (gait, 2)],
        _ => vec![(gait, 0)],
    });
    for (gait, component) in rows {
        let period = robot.gait(gait).expect("the robot has this gait").period();
        let unit = if component == 0 { "mm/s" } else { "deg/s" };
        _ = write!(text, "{gait:10}{unit:>6}");
        for results in &grains[gait] {
            let speed_text = |displacement: Displacement| {
                format!("{:+.1}", displacement.0[component] / period + 0.0)
            };
            let model = results.model.map_or_else(|| "-".to_owned(), speed_text);
            _ = write!(text, "  {model:>6} {:>6}", speed_text(results.mujoco));
        }
        text.push('\n');
    }
    text
}

/// Writes the results to `grains.json`.
///
/// # Errors
/// Fails if the file cannot be written.
pub fn store(grains: &GrainResults) -> std::io::Result<()> {
    std::fs::write(crate_folder().join("grains.json"), to_json(grains))
}
