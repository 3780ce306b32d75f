//! `make physics`: compares each gait's displacement in the contact model and in MuJoCo, for the robots in robots/.
//! Only MuJoCo simulates walks over edges and blocks, and walks of the paper's robot on other floors. With `--write`,
//! the new results replace the stored ones; with `--one-in N`, only every N-th walk is simulated.

use std::collections::BTreeMap;
use std::ops::RangeFrom;
use std::process::ExitCode;

use lizard_parts::Assembly;
use lizard_physics::assumptions::{self, Assumption};
use lizard_physics::grains::{self, GrainResults};
use lizard_physics::mujoco::{MujocoError, WalkBatch};
use lizard_physics::pads::{self, PadShape, SURFACES};
use lizard_physics::servos::{self, ServoResults, Variant, format_servos_table};
use lizard_physics::surface::{self, Surface, SurfaceDisplacements, format_surfaces_table};
use lizard_physics::text::{format_stored, load_stored};
use lizard_physics::{
    Displacement, DisplacementPair, GroupedDisplacements, ROBOT_NAMES, WalkResults, crate_dir,
    format_comparison_table, list_walks, load_robot,
};

/// The largest difference from a stored displacement that does not count as a change.
const TOLERANCE_MM: f64 = 0.6;
const TOLERANCE_DEG: f64 = 0.4;
/// The message for a walk without a stored result.
const NOT_STORED: &str = "no result is stored; `make physics WRITE=1` stores the new one";

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

/// Simulates every `one_in`-th walk and compares the results with the stored ones. If `one_in` is `None`, simulates all
/// walks and stores their results. Returns a message for each fault.
fn run(one_in: Option<usize>) -> Result<Vec<String>, MujocoError> {
    let (is_writing, one_in) = (one_in.is_none(), one_in.unwrap_or(1));
    let stored_results = WalkResults::load_stored();
    let mut choice = WalkChoice {
        one_in,
        walk_numbers: 0..,
    };
    let robot_walks = ROBOT_NAMES.map(|name| {
        let robot = load_robot(name);
        let walks = choice.choose(name, list_walks(&robot));
        (name, robot, walks)
    });
    let surface_walks = choice.choose("surface", SurfaceWalk::list_all(&stored_results));
    let servo_walks = Variant::ALL.map(|variant| servos::GAITS.map(|(gait, _)| (variant, gait)));
    let servo_walks = choice.choose("servos", servo_walks.concat());
    let assumption_walks =
        Assumption::ALL.map(|assumption| assumptions::GAITS.map(|gait| (assumption, gait)));
    let assumption_walks = choice.choose("assumptions", assumption_walks.concat());
    let pad_walks = PadShape::ALL.map(|shape| SURFACES.map(|surface| (shape, surface)));
    let pad_walks = choice.choose("pads", pad_walks.concat());

    let mut batch = WalkBatch::new()?;
    for (_, robot, walks) in &robot_walks {
        let assembly = Assembly::new(robot);
        let walks = walks.iter();
        let scenes = walks.map(|(name, walk)| walk.make_scene(name, &assembly));
        batch.add(&assembly, scenes)?;
    }
    for (name, walk) in &surface_walks {
        let assembly = Assembly::new(&load_robot(walk.robot));
        let (surface, displacement) = (walk.surface, walk.level_displacement);
        let scene = surface.make_scene(name, &assembly, &walk.gait, displacement);
        batch.add(&assembly, [scene])?;
    }
    for (name, (variant, gait)) in &servo_walks {
        let assembly = Assembly::new(&variant.load_robot());
        batch.add(&assembly, [variant.make_scene(name, &assembly, gait)])?;
    }
    for (name, (assumption, gait)) in &assumption_walks {
        let assembly = Assembly::new(&assumption.load_robot());
        let displacement = surface::find_level_displacement(&stored_results, gait);
        let scene = assumption.make_scene(name, &assembly, gait, displacement);
        batch.add(&assembly, [scene])?;
    }
    let paper = Assembly::new(&load_robot("paper"));
    let displacement = surface::find_level_displacement(&stored_results, pads::GAIT);
    let named_pad_walks = pad_walks.iter();
    let scenes = named_pad_walks
        .map(|(name, (shape, surface))| shape.make_scene(name, &paper, *surface, displacement));
    batch.add(&paper, scenes)?;
    let walk_count = batch.walk_count();
    println!("physics: MuJoCo simulates {walk_count} walks, which takes some minutes");
    let mujoco_displacements = batch.simulate()?;

    let (mut walk_results, mut faults) = (WalkResults::default(), Vec::new());
    for (robot_name, robot, walks) in &robot_walks {
        for (name, walk) in walks {
            let results = DisplacementPair {
                model: walk.simulate_contact_model(robot),
                mujoco: mujoco_displacements[name],
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
        let table = format_comparison_table(robot_name, robot, &walk_results);
        println!("\n{table}");
    }
    let stored_surfaces: SurfaceDisplacements = load_stored("surfaces.json");
    let mut surfaces = SurfaceDisplacements::new();
    for (name, walk) in &surface_walks {
        let (robot, gait, surface) = (walk.robot, &walk.gait, walk.surface);
        let displacement = mujoco_displacements[name];
        let mut messages =
            surface::describe_shortfalls(surface, walk.level_displacement, displacement);
        if surface::KNOWN_SHORTFALLS.contains(&(robot, gait.as_str(), surface)) {
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
        insert(by_gait, gait, &surface_name, displacement);
    }
    for robot in surface::ROBOT_NAMES {
        let table = format_surfaces_table(robot, &stored_results, &surfaces);
        println!("\nrobots/{robot}.toml\n{table}");
    }
    let stored_servos: ServoResults = load_stored("servos.json");
    let mut servo_results = ServoResults::new();
    for (name, (variant, gait)) in &servo_walks {
        let results = DisplacementPair {
            model: Some(variant.simulate_contact_model(gait)),
            mujoco: mujoco_displacements[name],
        };
        let mut messages = Vec::from_iter(variant.describe_disagreement(gait, &results));
        if !is_writing {
            let find_stored = || stored_servos.get(variant.name)?.get(*gait);
            messages.extend(describe_changes(find_stored(), &results));
        }
        let describe = |message| format!("paper, {}: {gait}: {message}", variant.name);
        faults.extend(messages.into_iter().map(describe));
        insert(&mut servo_results, variant.name, gait, results);
    }
    println!("\n{}", format_servos_table(&servo_results));
    let mut by_assumption = GroupedDisplacements::new();
    for (name, (assumption, gait)) in &assumption_walks {
        let (group, displacement) = (assumption.description, mujoco_displacements[name]);
        insert(&mut by_assumption, group, gait, displacement);
    }
    let mut by_shape = GroupedDisplacements::new();
    for (name, (shape, surface)) in &pad_walks {
        let (shape, surface) = (shape.name(), surface.to_string());
        insert(&mut by_shape, &shape, &surface, mujoco_displacements[name]);
    }
    println!("\n{}", pads::format_table(&by_shape));
    if !is_writing {
        for (file, current) in [
            ("assumptions.json", &by_assumption),
            ("pads.json", &by_shape),
        ] {
            faults.extend(describe_displacement_changes(&load_stored(file), current));
        }
    }
    let write = |file: &str, text: String| std::fs::write(crate_dir().join(file), text);
    let grain_robot = load_robot(grains::ROBOT);
    // A shortened run (`--one-in`) omits the pads with a grain.
    if one_in == 1 {
        let grain_results = grains::simulate_all(&grain_robot)?;
        let table = grains::format_table(&grain_robot, &grain_results);
        println!("\nrobots/grain.toml\n{table}");
        faults.extend(grains::describe_disagreements(&grain_results));
        if is_writing {
            write("grains.json", format_stored(&grain_results, 2))?;
        } else {
            let stored = load_stored("grains.json");
            faults.extend(describe_grain_changes(&stored, &grain_results));
        }
    }
    if is_writing {
        for (file, text) in [
            ("walks.json", format_stored(&walk_results, 3)),
            ("surfaces.json", format_stored(&surfaces, 2)),
            ("assumptions.json", format_stored(&by_assumption, 1)),
            ("pads.json", format_stored(&by_shape, 1)),
            ("servos.json", format_stored(&servo_results, 2)),
        ] {
            write(file, text)?;
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

/// Inserts a result into a table by group and name.
fn insert<T>(
    table: &mut BTreeMap<String, BTreeMap<String, T>>,
    group: &str,
    name: &str,
    result: T,
) {
    let by_name = table.entry(group.to_owned()).or_default();
    by_name.insert(name.to_owned(), result);
}

/// A choice of every `one_in`-th walk.
struct WalkChoice {
    one_in: usize,
    /// The numbers of the walks that follow.
    walk_numbers: RangeFrom<usize>,
}

impl WalkChoice {
    /// Chooses from these walks, and names each chosen walk and its file `prefix-0`, `prefix-1` and so on.
    fn choose<T>(&mut self, prefix: &str, walks: Vec<T>) -> Vec<(String, T)> {
        let numbered_walks = walks.into_iter().zip(&mut self.walk_numbers);
        let chosen_walks = numbered_walks.filter(|(_, number)| number.is_multiple_of(self.one_in));
        let names = (0..).map(|index: usize| format!("{prefix}-{index}"));
        names.zip(chosen_walks.map(|(walk, _)| walk)).collect()
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
        let pairs = results.iter().zip(grains::FRICTION_RATIOS).enumerate();
        pairs.flat_map(move |(index, (results, ratio))| {
            let changes = describe_changes(stored.get(index), results);
            let describe = move |change| format!("grain: {gait} (r {ratio}): {change}");
            changes.into_iter().map(describe)
        })
    });
    messages.collect()
}

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
