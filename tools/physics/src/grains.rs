//! Comparison of the contact model and MuJoCo on pads with a grain, which have more friction backward than forward. It
//! gives the gaits' speeds in `robots/grain.toml` at five friction ratios.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use lizard_parts::{Assembly, Scene, Trajectory};
use lizard_robot::{CheckedGait, GroundContact, Robot, Stance};

use crate::mujoco::{MujocoError, WalkBatch};
use crate::results::{Displacement, DisplacementPair};
use crate::table::Component;

/// The name of the robot's file, without its extension.
pub const ROBOT: &str = "grain";
/// The compared ratios of backward to forward friction.
pub const FRICTION_RATIOS: [f64; 5] = [1.0, 1.1, 1.2, 1.5, 2.0];
/// The compared gaits, without mirror images. The flag is true if the gait pushes some pads against the grain.
pub const GAITS: [(&str, bool); 5] = [
    ("run", false),
    ("walk", false),
    ("back", true),
    ("left", true),
    ("arc-left", false),
];
/// The largest friction ratio at which the model and MuJoCo must agree on a gait against the grain. Above this ratio,
/// the pushing pads have hardly more friction than the returning pad. The result then depends on inertia, which the
/// model ignores.
const MAX_RATIO_AGAINST_GRAIN: f64 = 1.5;
/// The allowed difference between MuJoCo and the model in a cycle: mm or, if larger, a fraction of the model's
/// distance; and deg.
const TOLERANCE: (f64, f64, f64) = (3.0, 0.2, 2.0);
/// The time that a gait needs to accelerate the body from rest, s. Afterwards, the motion repeats from cycle to cycle.
const SETTLING_S: f64 = 1.5;

/// The results by gait, in the order of [`FRICTION_RATIOS`].
pub type GrainResults = BTreeMap<String, Vec<DisplacementPair>>;

/// Simulates a cycle in the model with level feet. Returns `None` if two feet pull against the other two: the model
/// then has no result.
pub fn simulate_contact_model(
    robot: &Robot,
    gait: &CheckedGait,
    ratio: f64,
) -> Option<Displacement> {
    let ground = GroundContact {
        stance: Stance {
            stiffness: robot.ground().stance.stiffness,
            ..Stance::LEVEL
        },
        friction_ratio: ratio,
        ..*robot.ground()
    };
    let is_determined = gait.predict(&ground).is_determined();
    is_determined.then(|| gait.simulate_cycle(&ground).travel.into())
}

/// Simulates every gait at every ratio in the model and in MuJoCo.
///
/// # Errors
/// Fails if MuJoCo gives no result.
///
/// # Panics
/// If the robot does not have the gaits.
pub fn simulate_all(robot: &Robot) -> Result<GrainResults, MujocoError> {
    let assembly = Assembly::new(robot);
    let make_name = |gait: &str, index: usize| format!("{gait}-{index}");
    let gaits = GAITS.map(|(name, _)| robot.gait(name).expect("the robot has this gait"));
    let mut batch = WalkBatch::new()?;
    let scenes = gaits.iter().flat_map(|gait| {
        let cycles = count_settling_cycles(gait) + 1;
        let scene = Scene {
            trajectory: Some(Trajectory::for_gait(robot, gait, cycles, 1)),
            has_shapes: false,
            ..Scene::for_assembly(&assembly)
        };
        let ratios = FRICTION_RATIOS.into_iter().enumerate();
        ratios.map(move |(index, ratio)| Scene {
            name: make_name(gait.name(), index),
            friction_ratio: ratio,
            ..scene.clone()
        })
    });
    batch.add(&assembly, scenes)?;
    let mujoco_displacements = batch.simulate()?;
    let results_by_gait = gaits.iter().map(|gait| {
        let ratios = FRICTION_RATIOS.into_iter().enumerate();
        let results = ratios.map(|(index, ratio)| DisplacementPair {
            model: simulate_contact_model(robot, gait, ratio),
            mujoco: mujoco_displacements[&make_name(gait.name(), index)],
        });
        (gait.name().to_owned(), results.collect())
    });
    Ok(results_by_gait.collect())
}

/// Returns the number of cycles until a gait's motion repeats from cycle to cycle.
pub(crate) fn count_settling_cycles(gait: &CheckedGait) -> u32 {
    (SETTLING_S / gait.period()).ceil() as u32
}

/// Returns the results of a gait at the ratio in the robot's file.
pub(crate) fn find_results_at_own_ratio(results: &[DisplacementPair]) -> DisplacementPair {
    let own_ratio = crate::load_robot(ROBOT).ground().friction_ratio;
    let index = FRICTION_RATIOS.iter().position(|ratio| *ratio == own_ratio);
    results[index.expect("the table has the file's ratio")]
}

/// Returns a message for each of MuJoCo's results that differs too much from the model's.
pub fn describe_disagreements(grain_results: &GrainResults) -> Vec<String> {
    let mut messages = Vec::new();
    for (gait, is_against_grain) in GAITS {
        for (ratio, results) in FRICTION_RATIOS.into_iter().zip(&grain_results[gait]) {
            let Some(model) = results.model else {
                continue;
            };
            let (distance_error, turn_error) = results.mujoco.compute_difference(model);
            let (mm, fraction, deg) = TOLERANCE;
            let max_distance_error = mm.max(fraction * model.0[0].hypot(model.0[1]));
            let is_too_far = distance_error > max_distance_error || turn_error > deg;
            if is_too_far && !(is_against_grain && ratio > MAX_RATIO_AGAINST_GRAIN) {
                messages.push(format!(
                    "{ROBOT}: {gait} (r {ratio}): MuJoCo differs from the model by {distance_error:.1} mm and \
                     {turn_error:.1} deg"
                ));
            }
        }
    }
    messages
}

/// Returns a table of the model's and MuJoCo's speeds, mm/s forward and deg/s counter-clockwise.
///
/// # Panics
/// If a gait is missing.
pub fn format_table(robot: &Robot, grain_results: &GrainResults) -> String {
    let mut text = format!("{:16}", "model, MuJoCo");
    for ratio in FRICTION_RATIOS {
        let heading = format!("r = {ratio:.1}");
        _ = write!(text, "  {heading:>13}");
    }
    text.push('\n');
    // Each gait with the component of the displacement that it is for.
    let rows = GAITS.into_iter().flat_map(|(gait, _)| match gait {
        "left" => vec![(gait, Component::Turn)],
        "arc-left" => vec![(gait, Component::Forward), (gait, Component::Turn)],
        _ => vec![(gait, Component::Forward)],
    });
    for (gait, component) in rows {
        let period = robot.gait(gait).expect("the robot has this gait").period();
        let unit = format!("{}/s", component.unit());
        _ = write!(text, "{gait:10}{unit:>6}");
        for results in &grain_results[gait] {
            let format_speed = |displacement: Displacement| {
                format!("{:+.1}", component.value(displacement) / period + 0.0)
            };
            let model = results.model.map_or_else(|| "-".to_owned(), format_speed);
            _ = write!(text, "  {model:>6} {:>6}", format_speed(results.mujoco));
        }
        text.push('\n');
    }
    text
}
