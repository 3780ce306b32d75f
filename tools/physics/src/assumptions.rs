//! Assumptions that only MuJoCo can vary, not the contact model, and their effect: the floor, the
//! printed shape of pads, the drive of an analog servo, the distribution of mass.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use lizard_parts::{Assembly, Pads, Scene};
use lizard_robot::Robot;

use crate::case::Case;
use crate::crate_folder;
use crate::figures::{Displacement, Figures};
use crate::mujoco::scene_of;
use crate::surface::{self, Surface, Surfaces};
use crate::table::Part;

/// The gaits that are walked, as in `lizard gaits --assumptions`.
pub const GAITS: [&str; 5] = ["walk", "trot", "crawl", "left", "arc-left"];
/// The least change that matters, percent.
const MIN_CHANGE_PERCENT: f64 = 10.0;

/// A changed assumption about the paper's robot or its floor.
#[derive(Clone, Copy)]
pub struct Assumption {
    /// The changed assumption in words.
    pub description: &'static str,
    /// A line of robot.toml, and the lines that replace it.
    keys: Option<(&'static str, &'static str)>,
    /// The floor, if it is not level and even.
    surface: Option<Surface>,
    change: fn(&mut Scene),
}

const UNCHANGED: Assumption = Assumption {
    description: "",
    keys: None,
    surface: None,
    change: |_| {},
};

impl Assumption {
    /// All changed assumptions except the surfaces, which have a table of their own.
    pub const ALL: [Self; 6] = [
        Self {
            description: "analog servos that drive in bursts",
            change: |scene| scene.drives_in_bursts = true,
            ..UNCHANGED
        },
        Self {
            description: "bursts, and a rotor of 5 ms",
            keys: Some(("[servo.A1]", "[servo]\nspin_up_ms = 5.0\n[servo.A1]")),
            change: |scene| scene.drives_in_bursts = true,
            ..UNCHANGED
        },
        Self {
            description: "legs and links of a fifth of their mass",
            change: |scene| scene.limb_mass_factor = 0.2,
            ..UNCHANGED
        },
        Self {
            description: "mass centre 25 mm ahead",
            keys: Some(("[body]", "[body]\ncentre = [25.0, 0.0]")),
            ..UNCHANGED
        },
        Self {
            description: "mass centre 25 mm behind",
            keys: Some(("[body]", "[body]\ncentre = [-25.0, 0.0]")),
            ..UNCHANGED
        },
        Self {
            description: "edge of 1 mm, pads with terraces of 0.1 mm",
            surface: Some(Surface::Edge(10)),
            change: |scene| scene.pads = Pads::Terraces(0.1),
            ..UNCHANGED
        },
    ];

    /// Returns the paper's robot with this change.
    ///
    /// # Panics
    /// If robots/paper.toml does not have the table that is changed.
    pub fn robot(&self) -> Robot {
        match self.keys {
            Some((table, keys)) => paper_with(table, keys),
            None => crate::robot("paper"),
        }
    }

    /// Returns the scene of a gait's walk; `level` is the gait's displacement with the unchanged robot.
    ///
    /// # Panics
    /// If the robot has no such gait.
    pub fn scene(&self, name: &str, assembly: &Assembly, gait: &str, level: Displacement) -> Scene {
        let mut scene = match self.surface {
            Some(surface) => surface.scene(name, assembly, gait, level),
            None => scene_of(name, assembly, gait, Case::ALL[0]),
        };
        (self.change)(&mut scene);
        scene
    }
}

/// Returns the paper's robot with a line of its file replaced.
fn paper_with(old: &str, new: &str) -> Robot {
    let text = std::fs::read_to_string(crate_folder().join("../../robots/paper.toml"));
    let text = text.expect("robots/paper.toml");
    let line = format!("\n{old}");
    assert!(text.contains(&line), "{old}");
    Robot::parse(&text.replacen(&line, &format!("\n{new}"), 1)).expect(new)
}

/// MuJoCo's displacements by assumption and gait.
pub type Assumptions = BTreeMap<String, BTreeMap<String, Displacement>>;

/// Returns the displacements stored in `assumptions.json`.
///
/// # Panics
/// If `assumptions.json` is not a table of displacements.
pub fn stored() -> Assumptions {
    serde_json::from_str(include_str!("../assumptions.json")).expect("assumptions.json")
}

/// Returns a table of how the assumptions and the surfaces change each gait, in percent of MuJoCo's
/// displacement on a level floor, from the largest change to the smallest.
///
/// # Panics
/// If a displacement is missing.
pub fn table(figures: &Figures, surfaces: &Surfaces, assumptions: &Assumptions) -> String {
    let surface_rows = Surface::ALL.map(|surface| {
        let description = surface.to_string();
        let displacements = GAITS.map(|gait| surfaces["paper"][gait][&description]);
        (description, displacements)
    });
    let assumption_rows = Assumption::ALL.map(|Assumption { description, .. }| {
        let displacements = GAITS.map(|gait| assumptions[description][gait]);
        (description.to_owned(), displacements)
    });
    let percent_changes = |displacements: [Displacement; GAITS.len()]| {
        let mut changes = displacements
            .into_iter()
            .zip(GAITS)
            .map(|(displacement, gait)| {
                let level = surface::level_displacement(figures, gait);
                let part = match level.0[0].abs() > level.0[2].abs() {
                    true => Part::Ahead,
                    false => Part::Turn,
                };
                100.0 * (part.value(displacement) / part.value(level) - 1.0)
            });
        std::array::from_fn(|_| changes.next().expect("one of each gait"))
    };
    let largest_change = |changes: &[f64; GAITS.len()]| {
        changes
            .iter()
            .fold(0.0, |largest: f64, change| largest.max(change.abs()))
    };
    let mut rows: Vec<(String, [f64; GAITS.len()])> = surface_rows
        .into_iter()
        .chain(assumption_rows)
        .map(|(description, displacements)| (description, percent_changes(displacements)))
        .collect();
    rows.sort_by(|(_, a), (_, b)| largest_change(b).total_cmp(&largest_change(a)));
    let width = rows
        .iter()
        .map(|(description, _)| description.len())
        .fold(0, usize::max);
    let mut text = format!("{:width$}", "");
    for gait in GAITS {
        _ = write!(text, "{gait:>10}");
    }
    text.push('\n');
    let (large, small): (Vec<_>, Vec<_>) = rows
        .into_iter()
        .partition(|(_, changes)| largest_change(changes) >= MIN_CHANGE_PERCENT);
    for (description, changes) in large {
        _ = write!(text, "{description:width$}");
        for change in changes {
            // Adding positive zero turns a negative one positive.
            _ = write!(text, "{:>+10.0}", change.round() + 0.0);
        }
        text.push('\n');
    }
    if !small.is_empty() {
        _ = write!(text, "\nLess than {MIN_CHANGE_PERCENT:.0} %:\n");
        for (description, _) in small {
            _ = writeln!(text, "  {description}");
        }
    }
    text
}
