//! `make physics`: walks every gait of the robots of robots/ by the contact model and by MuJoCo.
//! MuJoCo alone also walks the robots over edges and blocks, and the paper's robot on slopes and other
//! floors. With `--write` the new results replace the stored ones; with `--one-in N` only every N-th
//! walk is done.

use std::collections::BTreeMap;
use std::process::ExitCode;

use lizard_parts::Assembly;
use lizard_physics::assumptions::{self, Assumption, Assumptions};
use lizard_physics::grains::{self, Grains};
use lizard_physics::mujoco::{Jobs, MujocoError};
use lizard_physics::pads::{self, SURFACES, Shape, Shapes};
use lizard_physics::servos::{self, Servos, Variant, servos_table};
use lizard_physics::surface::{self, Surface, Surfaces, surfaces_table};
use lizard_physics::text::{blocks, lines};
use lizard_physics::{
    Answers, Displacement, Figures, Legs, ROBOTS, Row, crate_folder, robot, rows, table,
};
use lizard_robot::Robot;

/// Largest difference from the stored displacement, mm and deg, without a change of the model, MuJoCo or the
/// robot.
const TOLERANCES: (f64, f64) = (0.6, 0.4);
/// The message for an answer that cannot be compared because none is stored for its walk.
const NOT_KEPT: &str = "no figures are kept; `make physics WRITE=1` keeps these";
/// The prefixes of the names of walks on other floors, with other servos, assumptions and pads.
const SURFACE: &str = "surface";
const SERVOS: &str = "servos";
const ASSUMPTIONS: &str = "assumptions";
const PADS: &str = "pads";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let one_in = match &words[..] {
        [] => Some(1),
        [write] if write == "--write" => None,
        [flag, n] if flag == "--one-in" && n.parse().is_ok_and(|n: usize| n > 0) => n.parse().ok(),
        _ => {
            eprintln!("physics: --write, or --one-in and a number from 1 on, not {words:?}");
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

/// Returns the name of a walk, by which its file is written and its answer is found.
fn name(robot: &str, index: usize) -> String {
    format!("{robot}-{index}")
}

/// Does every `one_in`-th walk and compares the answers with the stored ones; with `None`, does all walks
/// and stores their answers. Returns a message for each fault.
fn run(one_in: Option<usize>) -> Result<Vec<String>, MujocoError> {
    let (write, one_in) = (one_in.is_none(), one_in.unwrap_or(1));
    let robots: Vec<(&str, Robot)> = ROBOTS.map(|name| (name, robot(name))).into();
    let mut number = 0..;
    let mut is_one = || {
        number
            .next()
            .is_some_and(|n: usize| n.is_multiple_of(one_in))
    };
    let all: Vec<Vec<Row>> = robots
        .iter()
        .map(|(_, robot)| rows(robot).into_iter().filter(|_| is_one()).collect())
        .collect();
    let kept = Figures::stored();
    let uneven: Vec<UnevenWalk> = UnevenWalk::all(&kept)
        .into_iter()
        .filter(|_| is_one())
        .collect();
    let mut jobs = Jobs::new()?;
    for ((of, robot), rows) in robots.iter().zip(&all) {
        let assembly = Assembly::new(robot);
        let named = rows.iter().enumerate();
        let walks = named.map(|(index, row)| row.scene(&name(of, index), &assembly));
        jobs.add(&assembly, walks)?;
    }
    for (index, walk) in uneven.iter().enumerate() {
        let assembly = Assembly::new(&robot(walk.robot));
        let scene = walk
            .surface
            .scene(&name(SURFACE, index), &assembly, &walk.gait, walk.level);
        jobs.add(&assembly, std::iter::once((Legs::Rigid, scene)))?;
    }
    let driven = Variant::ALL.map(|variant| servos::GAITS.map(|(gait, _)| (variant, gait)));
    let driven: Vec<(Variant, &str)> = driven.concat().into_iter().filter(|_| is_one()).collect();
    for (index, (variant, gait)) in driven.iter().enumerate() {
        let assembly = Assembly::new(&variant.robot());
        let scene = variant.scene(&name(SERVOS, index), &assembly, gait);
        jobs.add(&assembly, std::iter::once((Legs::Rigid, scene)))?;
    }
    let assumed =
        Assumption::ALL.map(|assumption| assumptions::GAITS.map(|gait| (assumption, gait)));
    let assumed: Vec<(Assumption, &str)> =
        assumed.concat().into_iter().filter(|_| is_one()).collect();
    for (index, (assumption, gait)) in assumed.iter().enumerate() {
        let assembly = Assembly::new(&assumption.robot());
        let level = surface::level_displacement(&kept, gait);
        let scene = assumption.scene(&name(ASSUMPTIONS, index), &assembly, gait, level);
        jobs.add(&assembly, std::iter::once((Legs::Rigid, scene)))?;
    }
    let shapes = Shape::ALL.map(|shape| SURFACES.map(|surface| (shape, surface)));
    let shapes: Vec<(Shape, Surface)> = shapes.concat().into_iter().filter(|_| is_one()).collect();
    let paper = Assembly::new(&robot("paper"));
    let walks = shapes.iter().enumerate().map(|(index, (shape, surface))| {
        let level = surface::level_displacement(&kept, pads::GAIT);
        (
            Legs::Rigid,
            shape.scene(&name(PADS, index), &paper, *surface, level),
        )
    });
    jobs.add(&paper, walks)?;
    println!(
        "physics: {} walks by MuJoCo take some minutes",
        jobs.count()
    );
    let by_mujoco = jobs.start()?.wait()?;

    let (mut found, mut faults) = (Figures::default(), Vec::new());
    for ((of, robot), rows) in robots.iter().zip(&all) {
        for (index, row) in rows.iter().enumerate() {
            let answers = Answers {
                model: row.model(robot),
                mujoco: by_mujoco[&name(of, index)],
            };
            let mut words: Vec<String> = answers.disagreement(row.case).into_iter().collect();
            if !write {
                words.extend(describe_changes(
                    kept.get(of, &row.gait, row.case),
                    &answers,
                ));
            }
            let describe = |words| format!("{of}: {} ({}): {words}", row.gait, row.case);
            faults.extend(words.into_iter().map(describe));
            found.store(of, &row.gait, row.case, answers);
        }
        println!("\n{}", table(of, robot, &found));
    }
    let (before, mut surfaces) = (surface::stored(), Surfaces::new());
    for (index, walk) in uneven.iter().enumerate() {
        let UnevenWalk {
            robot,
            gait,
            level,
            surface,
        } = walk;
        let displacement = by_mujoco[&name(SURFACE, index)];
        let mut words = surface::excess_losses(*surface, *level, displacement);
        if surface::is_known_shortfall(robot, gait, *surface) {
            words.clear();
        }
        if !write {
            let of = before.get(*robot).and_then(|of| of.get(gait));
            let was = of.and_then(|of| of.get(&surface.to_string()));
            words.extend(match was {
                Some(was) => describe_difference("MuJoCo", *was, displacement),
                None => Some(NOT_KEPT.to_owned()),
            });
        }
        let describe = |words| format!("{robot}: {gait} ({surface}): {words}");
        faults.extend(words.into_iter().map(describe));
        let of = surfaces.entry((*robot).to_owned()).or_default();
        let of = of.entry(gait.clone()).or_default();
        of.insert(surface.to_string(), displacement);
    }
    for robot in surface::ROBOTS {
        println!(
            "\nrobots/{robot}.toml\n{}",
            surfaces_table(robot, &kept, &surfaces)
        );
    }
    let (before, mut by_servos) = (servos::stored(), Servos::new());
    for (index, (variant, gait)) in driven.iter().enumerate() {
        let answers = Answers {
            model: Some(variant.model(gait)),
            mujoco: by_mujoco[&name(SERVOS, index)],
        };
        let mut words: Vec<String> = variant.disagreement(gait, &answers).into_iter().collect();
        if !write {
            let was = before.get(variant.name).and_then(|of| of.get(*gait));
            words.extend(describe_changes(was, &answers));
        }
        let describe = |words| format!("paper, {}: {gait}: {words}", variant.name);
        faults.extend(words.into_iter().map(describe));
        let of = by_servos.entry(variant.name.to_owned()).or_default();
        of.insert((*gait).to_owned(), answers);
    }
    println!("\n{}", servos_table(&by_servos));
    let mut by_assumption = Assumptions::new();
    for (index, (assumption, gait)) in assumed.iter().enumerate() {
        let displacement = by_mujoco[&name(ASSUMPTIONS, index)];
        let of = by_assumption
            .entry(assumption.description.to_owned())
            .or_default();
        of.insert((*gait).to_owned(), displacement);
    }
    let mut by_shape = Shapes::new();
    for (index, (shape, surface)) in shapes.iter().enumerate() {
        let of = by_shape.entry(shape.name()).or_default();
        of.insert(surface.to_string(), by_mujoco[&name(PADS, index)]);
    }
    println!("\n{}", pads::table(&by_shape));
    if !write {
        faults.extend(describe_displacement_changes(
            &assumptions::stored(),
            &by_assumption,
        ));
        faults.extend(describe_displacement_changes(&pads::stored(), &by_shape));
    }
    let pads = robot(grains::ROBOT);
    // With `--one-in`, which saves time, the pads with a grain are left out.
    if one_in == 1 {
        let walked = grains::measure(&pads)?;
        println!("\nrobots/grain.toml\n{}", grains::table(&pads, &walked));
        faults.extend(grains::disagreements(&walked));
        match write {
            true => grains::store(&walked)?,
            false => faults.extend(describe_grain_changes(&grains::stored(), &walked)),
        }
    }
    if write {
        std::fs::write(crate_folder().join("figures.json"), found.text())?;
        std::fs::write(crate_folder().join("surfaces.json"), blocks(&surfaces))?;
        std::fs::write(
            crate_folder().join("assumptions.json"),
            lines(&by_assumption),
        )?;
        std::fs::write(crate_folder().join("pads.json"), lines(&by_shape))?;
        std::fs::write(crate_folder().join("servos.json"), servos::text(&by_servos))?;
        println!("physics: written to tools/physics; `make docs` puts it into the pages");
    } else if one_in == 1 && kept.count() != found.count() {
        faults.push(format!(
            "{} figures are kept, and there are {}; `make physics WRITE=1` keeps these",
            kept.count(),
            found.count()
        ));
    }
    Ok(faults)
}

/// A walk on a floor that is not level and even.
struct UnevenWalk {
    robot: &'static str,
    gait: String,
    /// The gait's displacement on a level floor.
    level: Displacement,
    surface: Surface,
}

impl UnevenWalk {
    fn all(figures: &Figures) -> Vec<Self> {
        let mut all = Vec::new();
        for robot in surface::ROBOTS {
            for (gait, level) in surface::gaits(figures, robot) {
                let of = |surface| Self {
                    robot,
                    gait: gait.clone(),
                    level,
                    surface,
                };
                all.extend(Surface::of(robot).into_iter().map(of));
            }
        }
        all
    }
}

/// Returns a message for each answer on pads with a grain that differs from the stored one.
fn describe_grain_changes(kept: &Grains, now: &Grains) -> Vec<String> {
    let each = now.iter().flat_map(|(gait, answers)| {
        let kept = kept.get(gait).map_or(&[][..], Vec::as_slice);
        let pairs = answers.iter().zip(grains::RATIOS).enumerate();
        pairs.flat_map(move |(index, (answers, ratio))| {
            let words = describe_changes(kept.get(index), answers);
            let describe = move |words| format!("grain: {gait} (r {ratio}): {words}");
            words.into_iter().map(describe)
        })
    });
    each.collect()
}

/// Displacements by group and name: by assumption and gait, or by pad shape and surface.
type StoredDisplacements = BTreeMap<String, BTreeMap<String, Displacement>>;

/// Returns a message for each displacement that differs from the stored one.
fn describe_displacement_changes(
    stored: &StoredDisplacements,
    now: &StoredDisplacements,
) -> Vec<String> {
    let all = now
        .iter()
        .flat_map(|(group, of)| of.iter().map(move |(name, is)| (group, name, is)));
    let words = all.filter_map(|(group, name, is)| {
        let words = match stored.get(group).and_then(|of| of.get(name)) {
            Some(was) => describe_difference("MuJoCo", *was, *is)?,
            None => NOT_KEPT.to_owned(),
        };
        Some(format!("paper, {group}: {name}: {words}"))
    });
    words.collect()
}

/// Returns a message for each answer that differs from the stored one, the model's and MuJoCo's.
fn describe_changes(kept: Option<&Answers>, now: &Answers) -> Vec<String> {
    let Some(before) = kept else {
        return vec![NOT_KEPT.to_owned()];
    };
    // If two feet pull against two, the model has no answer, and MuJoCo's differs between machines.
    let (Some(was), Some(is)) = (before.model, now.model) else {
        return Vec::new();
    };
    let all = [
        ("the model", was, is),
        ("MuJoCo", before.mujoco, now.mujoco),
    ];
    let changed = all.into_iter();
    changed
        .filter_map(|(who, before, now)| describe_difference(who, before, now))
        .collect()
}

/// Returns a message if a displacement differs from the stored one by more than [`TOLERANCES`].
fn describe_difference(who: &str, before: Displacement, now: Displacement) -> Option<String> {
    let (mm, deg) = before.distance_to(&now);
    (mm > TOLERANCES.0 || deg > TOLERANCES.1).then(|| {
        format!("{who} differs by {mm:.1} mm and {deg:.1} deg from what is kept; if that is meant, `make physics WRITE=1`")
    })
}
