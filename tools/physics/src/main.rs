//! `make physics`: compares the displacement of every gait of the robots of robots/ in the contact model and in
//! MuJoCo. Only MuJoCo simulates walks over edges and blocks, and walks of the paper's robot on other floors.
//! With `--write` the new results replace the stored ones; with `--one-in N` only every N-th walk is simulated.

use std::collections::BTreeMap;
use std::process::ExitCode;

use lizard_parts::Assembly;
use lizard_physics::assumptions::{self, Assumption, AssumptionDisplacements};
use lizard_physics::grains::{self, GrainResults};
use lizard_physics::mujoco::{Jobs, MujocoError};
use lizard_physics::pads::{self, PadShape, SURFACES, ShapeDisplacements};
use lizard_physics::servos::{self, ServoResults, Variant, servos_table};
use lizard_physics::surface::{self, Surface, SurfaceDisplacements, surfaces_table};
use lizard_physics::text::{format_blocks, format_lines};
use lizard_physics::{
    Displacement, Figures, Legs, ROBOT_NAMES, Results, Walk, crate_folder, load_robot, table,
    walks_of,
};
use lizard_robot::Robot;

/// The largest difference from a stored displacement, mm and deg, that is not reported as a change.
const TOLERANCES: (f64, f64) = (0.6, 0.4);
/// The message for a walk without a stored result.
const NOT_STORED: &str = "no figures are stored; `make physics WRITE=1` stores these";
/// Prefixes of the names of walks: on other floors, with other servos, with other assumptions, with other pads.
const SURFACE_PREFIX: &str = "surface";
const SERVOS_PREFIX: &str = "servos";
const ASSUMPTIONS_PREFIX: &str = "assumptions";
const PADS_PREFIX: &str = "pads";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let one_in = match &arguments[..] {
        [] => Some(1),
        [write] if write == "--write" => None,
        [flag, number]
            if flag == "--one-in" && number.parse().is_ok_and(|number: usize| number > 0) =>
        {
            number.parse().ok()
        }
        _ => {
            eprintln!(
                "usage: physics [--write | --one-in N], with N of at least 1; not {arguments:?}"
            );
            return ExitCode::from(2);
        }
    };
    match run(one_in) {
        Ok(faults) if faults.is_empty() => {
            println!("physics: model and MuJoCo agree");
            ExitCode::SUCCESS
        }
        Ok(faults) => {
            for fault in &faults {
                println!("FAULT {fault}");
            }
            println!("physics: {} faults", faults.len());
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("physics: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Returns the name of a walk, which is also the name of its file.
fn walk_name(prefix: &str, index: usize) -> String {
    format!("{prefix}-{index}")
}

/// Simulates every `one_in`-th walk and compares the results with the stored ones; with `None`, simulates all walks and
/// stores their results. Returns a message for each fault.
fn run(one_in: Option<usize>) -> Result<Vec<String>, MujocoError> {
    let (is_writing, one_in) = (one_in.is_none(), one_in.unwrap_or(1));
    let robots: Vec<(&str, Robot)> = ROBOT_NAMES.map(|name| (name, load_robot(name))).into();
    let mut walk_numbers = 0..;
    let mut is_chosen = || {
        walk_numbers
            .next()
            .is_some_and(|n: usize| n.is_multiple_of(one_in))
    };
    let walks_by_robot: Vec<Vec<Walk>> = robots
        .iter()
        .map(|(_, robot)| {
            walks_of(robot)
                .into_iter()
                .filter(|_| is_chosen())
                .collect()
        })
        .collect();
    let stored_figures = Figures::stored();
    let uneven_walks: Vec<UnevenWalk> = UnevenWalk::all(&stored_figures)
        .into_iter()
        .filter(|_| is_chosen())
        .collect();
    let mut jobs = Jobs::new()?;
    for ((robot_name, robot), walks) in robots.iter().zip(&walks_by_robot) {
        let assembly = Assembly::new(robot);
        let indexed_walks = walks.iter().enumerate();
        let scenes =
            indexed_walks.map(|(index, walk)| walk.scene(&walk_name(robot_name, index), &assembly));
        jobs.add(&assembly, scenes)?;
    }
    for (index, walk) in uneven_walks.iter().enumerate() {
        let assembly = Assembly::new(&load_robot(walk.robot));
        let scene = walk.surface.scene(
            &walk_name(SURFACE_PREFIX, index),
            &assembly,
            &walk.gait,
            walk.level_displacement,
        );
        jobs.add(&assembly, std::iter::once((Legs::Rigid, scene)))?;
    }
    let servo_walks = Variant::ALL.map(|variant| servos::GAITS.map(|(gait, _)| (variant, gait)));
    let servo_walks: Vec<(Variant, &str)> = servo_walks
        .concat()
        .into_iter()
        .filter(|_| is_chosen())
        .collect();
    for (index, (variant, gait)) in servo_walks.iter().enumerate() {
        let assembly = Assembly::new(&variant.robot());
        let scene = variant.scene(&walk_name(SERVOS_PREFIX, index), &assembly, gait);
        jobs.add(&assembly, std::iter::once((Legs::Rigid, scene)))?;
    }
    let assumption_walks =
        Assumption::ALL.map(|assumption| assumptions::GAITS.map(|gait| (assumption, gait)));
    let assumption_walks: Vec<(Assumption, &str)> = assumption_walks
        .concat()
        .into_iter()
        .filter(|_| is_chosen())
        .collect();
    for (index, (assumption, gait)) in assumption_walks.iter().enumerate() {
        let assembly = Assembly::new(&assumption.robot());
        let level = surface::level_displacement(&stored_figures, gait);
        let scene = assumption.scene(
            &walk_name(ASSUMPTIONS_PREFIX, index),
            &assembly,
            gait,
            level,
        );
        jobs.add(&assembly, std::iter::once((Legs::Rigid, scene)))?;
    }
    let pad_walks = PadShape::ALL.map(|shape| SURFACES.map(|surface| (shape, surface)));
    let pad_walks: Vec<(PadShape, Surface)> = pad_walks
        .concat()
        .into_iter()
        .filter(|_| is_chosen())
        .collect();
    let paper = Assembly::new(&load_robot("paper"));
    let scenes = pad_walks
        .iter()
        .enumerate()
        .map(|(index, (shape, surface))| {
            let level = surface::level_displacement(&stored_figures, pads::GAIT);
            (
                Legs::Rigid,
                shape.scene(&walk_name(PADS_PREFIX, index), &paper, *surface, level),
            )
        });
    jobs.add(&paper, scenes)?;
    println!(
        "physics: {} walks by MuJoCo take some minutes",
        jobs.walk_count()
    );
    let by_mujoco = jobs.start()?.wait()?;

    let (mut figures, mut faults) = (Figures::default(), Vec::new());
    for ((robot_name, robot), walks) in robots.iter().zip(&walks_by_robot) {
        for (index, walk) in walks.iter().enumerate() {
            let results = Results {
                model: walk.model_displacement(robot),
                mujoco: by_mujoco[&walk_name(robot_name, index)],
            };
            let mut messages: Vec<String> = results.disagreement(walk.case).into_iter().collect();
            if !is_writing {
                messages.extend(describe_changes(
                    stored_figures.get(robot_name, &walk.gait, walk.case),
                    &results,
                ));
            }
            let describe =
                |message| format!("{robot_name}: {} ({}): {message}", walk.gait, walk.case);
            faults.extend(messages.into_iter().map(describe));
            figures.store(robot_name, &walk.gait, walk.case, results);
        }
        println!("\n{}", table(robot_name, robot, &figures));
    }
    let (stored_surfaces, mut surfaces) = (surface::stored(), SurfaceDisplacements::new());
    for (index, walk) in uneven_walks.iter().enumerate() {
        let UnevenWalk {
            robot,
            gait,
            level_displacement,
            surface,
        } = walk;
        let displacement = by_mujoco[&walk_name(SURFACE_PREFIX, index)];
        let mut messages = surface::excess_losses(*surface, *level_displacement, displacement);
        if surface::is_known_shortfall(robot, gait, *surface) {
            messages.clear();
        }
        if !is_writing {
            let stored_by_gait = stored_surfaces
                .get(*robot)
                .and_then(|by_gait| by_gait.get(gait));
            let stored_displacement =
                stored_by_gait.and_then(|by_surface| by_surface.get(&surface.to_string()));
            messages.extend(match stored_displacement {
                Some(stored_displacement) => {
                    describe_difference("MuJoCo", *stored_displacement, displacement)
                }
                None => Some(NOT_STORED.to_owned()),
            });
        }
        let describe = |message| format!("{robot}: {gait} ({surface}): {message}");
        faults.extend(messages.into_iter().map(describe));
        let by_gait = surfaces.entry((*robot).to_owned()).or_default();
        let by_surface = by_gait.entry(gait.clone()).or_default();
        by_surface.insert(surface.to_string(), displacement);
    }
    for robot in surface::ROBOT_NAMES {
        println!(
            "\nrobots/{robot}.toml\n{}",
            surfaces_table(robot, &stored_figures, &surfaces)
        );
    }
    let (stored_servos, mut by_servos) = (servos::stored(), ServoResults::new());
    for (index, (variant, gait)) in servo_walks.iter().enumerate() {
        let results = Results {
            model: Some(variant.model_displacement(gait)),
            mujoco: by_mujoco[&walk_name(SERVOS_PREFIX, index)],
        };
        let mut messages: Vec<String> = variant.disagreement(gait, &results).into_iter().collect();
        if !is_writing {
            let stored_results = stored_servos
                .get(variant.name)
                .and_then(|by_gait| by_gait.get(*gait));
            messages.extend(describe_changes(stored_results, &results));
        }
        let describe = |message| format!("paper, {}: {gait}: {message}", variant.name);
        faults.extend(messages.into_iter().map(describe));
        let by_gait = by_servos.entry(variant.name.to_owned()).or_default();
        by_gait.insert((*gait).to_owned(), results);
    }
    println!("\n{}", servos_table(&by_servos));
    let mut by_assumption = AssumptionDisplacements::new();
    for (index, (assumption, gait)) in assumption_walks.iter().enumerate() {
        let displacement = by_mujoco[&walk_name(ASSUMPTIONS_PREFIX, index)];
        let by_gait = by_assumption
            .entry(assumption.description.to_owned())
            .or_default();
        by_gait.insert((*gait).to_owned(), displacement);
    }
    let mut by_shape = ShapeDisplacements::new();
    for (index, (shape, surface)) in pad_walks.iter().enumerate() {
        let by_surface = by_shape.entry(shape.name()).or_default();
        by_surface.insert(
            surface.to_string(),
            by_mujoco[&walk_name(PADS_PREFIX, index)],
        );
    }
    println!("\n{}", pads::table(&by_shape));
    if !is_writing {
        faults.extend(describe_displacement_changes(
            &assumptions::stored(),
            &by_assumption,
        ));
        faults.extend(describe_displacement_changes(&pads::stored(), &by_shape));
    }
    let grain_robot = load_robot(grains::ROBOT);
    // A shortened run (`--one-in`) leaves out the pads with a grain.
    if one_in == 1 {
        let grain_results = grains::measure(&grain_robot)?;
        println!(
            "\nrobots/grain.toml\n{}",
            grains::table(&grain_robot, &grain_results)
        );
        faults.extend(grains::disagreements(&grain_results));
        match is_writing {
            true => grains::store(&grain_results)?,
            false => faults.extend(describe_grain_changes(&grains::stored(), &grain_results)),
        }
    }
    if is_writing {
        for (file, text) in [
            ("figures.json", figures.to_json()),
            ("surfaces.json", format_blocks(&surfaces)),
            ("assumptions.json", format_lines(&by_assumption)),
            ("pads.json", format_lines(&by_shape)),
            ("servos.json", format_blocks(&by_servos)),
        ] {
            std::fs::write(crate_folder().join(file), text)?;
        }
        println!("physics: written to tools/physics; `make docs` updates the pages");
    } else if one_in == 1 && stored_figures.walk_count() != figures.walk_count() {
        faults.push(format!(
            "{} figures are stored, but there are {}; `make physics WRITE=1` stores these",
            stored_figures.walk_count(),
            figures.walk_count()
        ));
    }
    Ok(faults)
}

/// A walk on a floor that is not level and even.
struct UnevenWalk {
    robot: &'static str,
    gait: String,
    /// The gait's displacement on a level floor.
    level_displacement: Displacement,
    surface: Surface,
}

impl UnevenWalk {
    fn all(figures: &Figures) -> Vec<Self> {
        let mut walks = Vec::new();
        for robot in surface::ROBOT_NAMES {
            for (gait, level_displacement) in surface::walking_gaits(figures, robot) {
                let walk_on = |surface| Self {
                    robot,
                    gait: gait.clone(),
                    level_displacement,
                    surface,
                };
                walks.extend(Surface::of(robot).into_iter().map(walk_on));
            }
        }
        walks
    }
}

/// Returns a message for each result on pads with a grain that differs from the stored one.
fn describe_grain_changes(stored: &GrainResults, current: &GrainResults) -> Vec<String> {
    let messages = current.iter().flat_map(|(gait, results)| {
        let stored = stored.get(gait).map_or(&[][..], Vec::as_slice);
        let pairs = results.iter().zip(grains::RATIOS).enumerate();
        pairs.flat_map(move |(index, (results, ratio))| {
            let changes = describe_changes(stored.get(index), results);
            let describe = move |change| format!("grain: {gait} (r {ratio}): {change}");
            changes.into_iter().map(describe)
        })
    });
    messages.collect()
}

/// Displacements by group and name: by assumption and gait, or by pad shape and surface.
type GroupedDisplacements = BTreeMap<String, BTreeMap<String, Displacement>>;

/// Returns a message for each displacement that differs from the stored one.
fn describe_displacement_changes(
    stored: &GroupedDisplacements,
    current: &GroupedDisplacements,
) -> Vec<String> {
    let displacements = current.iter().flat_map(|(group, by_name)| {
        by_name
            .iter()
            .map(move |(name, displacement)| (group, name, displacement))
    });
    let messages = displacements.filter_map(|(group, name, displacement)| {
        let message = match stored.get(group).and_then(|by_name| by_name.get(name)) {
            Some(stored_displacement) => {
                describe_difference("MuJoCo", *stored_displacement, *displacement)?
            }
            None => NOT_STORED.to_owned(),
        };
        Some(format!("paper, {group}: {name}: {message}"))
    });
    messages.collect()
}

/// Returns a message for each of the two results, the model's and MuJoCo's, that differs from the stored one.
fn describe_changes(stored: Option<&Results>, current: &Results) -> Vec<String> {
    let Some(stored) = stored else {
        return vec![NOT_STORED.to_owned()];
    };
    // If two feet pull against two, the model has no result, and MuJoCo's result differs between machines.
    let (Some(stored_model), Some(current_model)) = (stored.model, current.model) else {
        return Vec::new();
    };
    let pairs = [
        ("the model", stored_model, current_model),
        ("MuJoCo", stored.mujoco, current.mujoco),
    ];
    let pairs = pairs.into_iter();
    pairs
        .filter_map(|(source, stored, current)| describe_difference(source, stored, current))
        .collect()
}

/// Returns a message if a displacement differs from the stored one by more than [`TOLERANCES`].
fn describe_difference(
    source: &str,
    stored: Displacement,
    current: Displacement,
) -> Option<String> {
    let (mm, deg) = stored.distance_to(&current);
    (mm > TOLERANCES.0 || deg > TOLERANCES.1).then(|| {
        format!("{source} differs by {mm:.1} mm and {deg:.1} deg from the stored displacement; if that is intended, `make physics WRITE=1`")
    })
}
