//! `make physics`: compares each gait's displacement in the contact model and in MuJoCo, for the robots in robots/.
//! Only MuJoCo simulates walks over edges and blocks, and walks of the paper's robot on other floors. With `--write`,
//! the new results replace the stored ones; with `--one-in N`, only every N-th walk is simulated.

use std::collections::BTreeMap;
use std::ops::RangeFrom;
use std::process::ExitCode;

use lizard_parts::Assembly;
use lizard_physics::assumptions::{self, Assumption, AssumptionDisplacements};
use lizard_physics::grains::{self, GrainResults};
use lizard_physics::mujoco::{MujocoError, WalkBatch};
use lizard_physics::pads::{self, PadShape, SURFACES, ShapeDisplacements};
use lizard_physics::servos::{self, ServoResults, Variant, format_servos_table};
use lizard_physics::surface::{self, Surface, SurfaceDisplacements, format_surfaces_table};
use lizard_physics::text::{map_to_json, nested_map_to_json};
use lizard_physics::{
    Displacement, DisplacementPair, LegDrive, ROBOT_NAMES, Walk, WalkResults, crate_dir,
    format_table, list_walks, load_robot,
};
use lizard_robot::Robot;

/// The largest difference from a stored displacement that does not count as a change.
const TOLERANCE_MM: f64 = 0.6;
const TOLERANCE_DEG: f64 = 0.4;
/// The message for a walk without a stored result.
const NOT_STORED: &str = "no result is stored; `make physics WRITE=1` stores the new one";
/// Prefixes of the walks' names: walks on other floors, with other servos, under other assumptions, and on other pads.
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
                "usage: physics [--write | --one-in N], where N is at least 1; got {arguments:?}"
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
fn make_walk_name(prefix: &str, index: usize) -> String {
    format!("{prefix}-{index}")
}

/// Simulates every `one_in`-th walk and compares the results with the stored ones. If `one_in` is `None`, simulates all
/// walks and stores their results. Returns a message for each fault.
fn run(one_in: Option<usize>) -> Result<Vec<String>, MujocoError> {
    let (is_writing, one_in) = (one_in.is_none(), one_in.unwrap_or(1));
    let robots: Vec<(&str, Robot)> = ROBOT_NAMES.map(|name| (name, load_robot(name))).into();
    let mut choice = WalkChoice {
        one_in,
        walk_numbers: 0..,
    };
    let choose_robot_walks = |(_, robot): &(&str, Robot)| choice.choose(list_walks(robot));
    let walks_by_robot: Vec<Vec<Walk>> = robots.iter().map(choose_robot_walks).collect();
    let stored_results = WalkResults::load_stored();
    let surface_walks = choice.choose(SurfaceWalk::list_all(&stored_results));
    let mut batch = WalkBatch::new()?;
    for ((robot_name, robot), walks) in robots.iter().zip(&walks_by_robot) {
        let assembly = Assembly::new(robot);
        let indexed_walks = walks.iter().enumerate();
        let scenes = indexed_walks
            .map(|(index, walk)| walk.make_scene(&make_walk_name(robot_name, index), &assembly));
        batch.add(&assembly, scenes)?;
    }
    for (index, walk) in surface_walks.iter().enumerate() {
        let assembly = Assembly::new(&load_robot(walk.robot));
        let name = make_walk_name(SURFACE_PREFIX, index);
        let (surface, level) = (walk.surface, walk.level_displacement);
        let scene = surface.make_scene(&name, &assembly, &walk.gait, level);
        batch.add(&assembly, [(LegDrive::Rigid, scene)])?;
    }
    let servo_walks = Variant::ALL.map(|variant| servos::GAITS.map(|(gait, _)| (variant, gait)));
    let servo_walks = choice.choose(servo_walks.concat());
    for (index, (variant, gait)) in servo_walks.iter().enumerate() {
        let assembly = Assembly::new(&variant.load_robot());
        let scene = variant.make_scene(&make_walk_name(SERVOS_PREFIX, index), &assembly, gait);
        batch.add(&assembly, [(LegDrive::Rigid, scene)])?;
    }
    let assumption_walks =
        Assumption::ALL.map(|assumption| assumptions::GAITS.map(|gait| (assumption, gait)));
    let assumption_walks = choice.choose(assumption_walks.concat());
    for (index, (assumption, gait)) in assumption_walks.iter().enumerate() {
        let assembly = Assembly::new(&assumption.load_robot());
        let level = surface::find_level_displacement(&stored_results, gait);
        let name = make_walk_name(ASSUMPTIONS_PREFIX, index);
        let scene = assumption.make_scene(&name, &assembly, gait, level);
        batch.add(&assembly, [(LegDrive::Rigid, scene)])?;
    }
    let pad_walks = PadShape::ALL.map(|shape| SURFACES.map(|surface| (shape, surface)));
    let pad_walks = choice.choose(pad_walks.concat());
    let paper = Assembly::new(&load_robot("paper"));
    let level = surface::find_level_displacement(&stored_results, pads::GAIT);
    let indexed_pad_walks = pad_walks.iter().enumerate();
    let scenes = indexed_pad_walks.map(|(index, (shape, surface))| {
        let name = make_walk_name(PADS_PREFIX, index);
        let scene = shape.make_scene(&name, &paper, *surface, level);
        (LegDrive::Rigid, scene)
    });
    batch.add(&paper, scenes)?;
    let walk_count = batch.walk_count();
    println!("physics: MuJoCo simulates {walk_count} walks, which takes some minutes");
    let mujoco_displacements = batch.start()?.wait()?;

    let (mut walk_results, mut faults) = (WalkResults::default(), Vec::new());
    for ((robot_name, robot), walks) in robots.iter().zip(&walks_by_robot) {
        for (index, walk) in walks.iter().enumerate() {
            let results = DisplacementPair {
                model: walk.simulate_model(robot),
                mujoco: mujoco_displacements[&make_walk_name(robot_name, index)],
            };
            let mut messages = Vec::from_iter(results.describe_disagreement(walk.case));
            if !is_writing {
                let stored = stored_results.get(robot_name, &walk.gait, walk.case);
                messages.extend(describe_changes(stored, &results));
            }
            let describe =
                |message| format!("{robot_name}: {} ({}): {message}", walk.gait, walk.case);
            faults.extend(messages.into_iter().map(describe));
            walk_results.store(robot_name, &walk.gait, walk.case, results);
        }
        println!("\n{}", format_table(robot_name, robot, &walk_results));
    }
    let (stored_surfaces, mut surfaces) = (surface::load_stored(), SurfaceDisplacements::new());
    for (index, walk) in surface_walks.iter().enumerate() {
        let (robot, gait, surface) = (walk.robot, &walk.gait, walk.surface);
        let displacement = mujoco_displacements[&make_walk_name(SURFACE_PREFIX, index)];
        let level = walk.level_displacement;
        let mut messages = surface::describe_excess_losses(surface, level, displacement);
        if surface::is_known_shortfall(robot, gait, surface) {
            messages.clear();
        }
        let surface_name = surface.to_string();
        if !is_writing {
            let find_stored = || stored_surfaces.get(robot)?.get(gait)?.get(&surface_name);
            messages.extend(describe_mujoco_change(find_stored(), displacement));
        }
        let describe = |message| format!("{robot}: {gait} ({surface}): {message}");
        faults.extend(messages.into_iter().map(describe));
        let by_gait = surfaces.entry(robot.to_owned()).or_default();
        let by_surface = by_gait.entry(gait.clone()).or_default();
        by_surface.insert(surface_name, displacement);
    }
    for robot in surface::ROBOT_NAMES {
        let table = format_surfaces_table(robot, &stored_results, &surfaces);
        println!("\nrobots/{robot}.toml\n{table}");
    }
    let (stored_servos, mut servo_results) = (servos::load_stored(), ServoResults::new());
    for (index, (variant, gait)) in servo_walks.iter().enumerate() {
        let results = DisplacementPair {
            model: Some(variant.simulate_model(gait)),
            mujoco: mujoco_displacements[&make_walk_name(SERVOS_PREFIX, index)],
        };
        let mut messages = Vec::from_iter(variant.describe_disagreement(gait, &results));
        if !is_writing {
            let find_stored = || stored_servos.get(variant.name)?.get(*gait);
            messages.extend(describe_changes(find_stored(), &results));
        }
        let describe = |message| format!("paper, {}: {gait}: {message}", variant.name);
        faults.extend(messages.into_iter().map(describe));
        let by_gait = servo_results.entry(variant.name.to_owned()).or_default();
        by_gait.insert((*gait).to_owned(), results);
    }
    println!("\n{}", format_servos_table(&servo_results));
    let mut by_assumption = AssumptionDisplacements::new();
    for (index, (assumption, gait)) in assumption_walks.iter().enumerate() {
        let displacement = mujoco_displacements[&make_walk_name(ASSUMPTIONS_PREFIX, index)];
        let description = assumption.description.to_owned();
        let by_gait = by_assumption.entry(description).or_default();
        by_gait.insert((*gait).to_owned(), displacement);
    }
    let mut by_shape = ShapeDisplacements::new();
    for (index, (shape, surface)) in pad_walks.iter().enumerate() {
        let by_surface = by_shape.entry(shape.name()).or_default();
        let displacement = mujoco_displacements[&make_walk_name(PADS_PREFIX, index)];
        by_surface.insert(surface.to_string(), displacement);
    }
    println!("\n{}", pads::format_table(&by_shape));
    if !is_writing {
        for (stored, current) in [
            (assumptions::load_stored(), &by_assumption),
            (pads::load_stored(), &by_shape),
        ] {
            faults.extend(describe_displacement_changes(&stored, current));
        }
    }
    let grain_robot = load_robot(grains::ROBOT);
    // A shortened run (`--one-in`) omits the pads with a grain.
    if one_in == 1 {
        let grain_results = grains::simulate_all(&grain_robot)?;
        let table = grains::format_table(&grain_robot, &grain_results);
        println!("\nrobots/grain.toml\n{table}");
        faults.extend(grains::describe_disagreements(&grain_results));
        match is_writing {
            true => grains::store(&grain_results)?,
            false => faults.extend(describe_grain_changes(
                &grains::load_stored(),
                &grain_results,
            )),
        }
    }
    if is_writing {
        for (file, text) in [
            ("figures.json", walk_results.to_json()),
            ("surfaces.json", nested_map_to_json(&surfaces)),
            ("assumptions.json", map_to_json(&by_assumption)),
            ("pads.json", map_to_json(&by_shape)),
            ("servos.json", nested_map_to_json(&servo_results)),
        ] {
            std::fs::write(crate_dir().join(file), text)?;
        }
        println!("physics: results stored in tools/physics; `make docs` updates the pages");
    } else if one_in == 1 && stored_results.walk_count() != walk_results.walk_count() {
        faults.push(format!(
            "{} results are stored, expected {}; `make physics WRITE=1` stores the new ones",
            stored_results.walk_count(),
            walk_results.walk_count()
        ));
    }
    Ok(faults)
}

/// A choice of every `one_in`-th walk.
struct WalkChoice {
    one_in: usize,
    /// The numbers of the walks that follow.
    walk_numbers: RangeFrom<usize>,
}

impl WalkChoice {
    fn choose<T>(&mut self, walks: Vec<T>) -> Vec<T> {
        let numbered_walks = walks.into_iter().zip(&mut self.walk_numbers);
        let chosen_walks = numbered_walks.filter(|(_, number)| number.is_multiple_of(self.one_in));
        chosen_walks.map(|(walk, _)| walk).collect()
    }
}

/// A walk on a floor that is not level and even.
struct SurfaceWalk {
    robot: &'static str,
    gait: String,
    /// The gait's displacement on a level floor.
    level_displacement: Displacement,
    surface: Surface,
}

impl SurfaceWalk {
    fn list_all(walk_results: &WalkResults) -> Vec<Self> {
        let mut walks = Vec::new();
        for robot in surface::ROBOT_NAMES {
            for (gait, level_displacement) in surface::list_walking_gaits(walk_results, robot) {
                let walk_on = |surface| Self {
                    robot,
                    gait: gait.clone(),
                    level_displacement,
                    surface,
                };
                walks.extend(Surface::for_robot(robot).into_iter().map(walk_on));
            }
        }
        walks
    }
}

/// Returns a message for each result on pads with a grain that differs from the stored result.
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

/// Returns a message for each displacement that differs from the stored displacement.
fn describe_displacement_changes(
    stored: &GroupedDisplacements,
    current: &GroupedDisplacements,
) -> Vec<String> {
    let mut messages = Vec::new();
    for (group, by_name) in current {
        for (name, displacement) in by_name {
            let find_stored = || stored.get(group)?.get(name);
            let change = describe_mujoco_change(find_stored(), *displacement);
            messages.extend(change.map(|change| format!("paper, {group}: {name}: {change}")));
        }
    }
    messages
}

/// Returns a message if MuJoCo's displacement differs from the stored one, or if none is stored.
fn describe_mujoco_change(stored: Option<&Displacement>, current: Displacement) -> Option<String> {
    match stored {
        Some(stored) => describe_difference("MuJoCo", *stored, current),
        None => Some(NOT_STORED.to_owned()),
    }
}

/// Returns a message for each of the model's and MuJoCo's displacements that differs from the stored one.
fn describe_changes(stored: Option<&DisplacementPair>, current: &DisplacementPair) -> Vec<String> {
    let Some(stored) = stored else {
        return vec![NOT_STORED.to_owned()];
    };
    // If two feet pull against the other two, the model has no result, and MuJoCo's result differs between machines.
    let (Some(stored_model), Some(current_model)) = (stored.model, current.model) else {
        return Vec::new();
    };
    let model_change = describe_difference("the model", stored_model, current_model);
    let mujoco_change = describe_difference("MuJoCo", stored.mujoco, current.mujoco);
    model_change.into_iter().chain(mujoco_change).collect()
}

/// Returns a message if a displacement differs from the stored one by more than the tolerance.
fn describe_difference(
    source: &str,
    stored: Displacement,
    current: Displacement,
) -> Option<String> {
    let (mm, deg) = stored.compute_difference(current);
    (mm > TOLERANCE_MM || deg > TOLERANCE_DEG).then(|| {
        format!(
            "{source} differs from the stored displacement by {mm:.1} mm and {deg:.1} deg; \
             if this is intended, run `make physics WRITE=1`"
        )
    })
}
