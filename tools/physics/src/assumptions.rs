//! Assumptions that `lizard gaits --assumptions` does not vary, or varies less, and their effect on the gaits in
//! MuJoCo: the floor, the pads' printed shape, the drive of analogue servos, and the mass distribution.

use std::fmt::Write as _;

use lizard_parts::{Assembly, Pads, Scene};
use lizard_robot::Robot;

use crate::case::Case;
use crate::mujoco::make_two_cycle_scene;
use crate::results::{Displacement, GroupedDisplacements, WalkResults};
use crate::surface::{self, Surface, SurfaceDisplacements};
use crate::table::Component;

/// The simulated gaits, as in `lizard gaits --assumptions`.
pub const GAITS: [&str; 5] = ["walk", "trot", "crawl", "left", "arc-left"];
/// A row has numbers only if a gait changes by at least this much, percent.
const MIN_CHANGE_PERCENT: f64 = 10.0;

/// A changed assumption about the paper's robot or its floor.
#[derive(Clone, Copy)]
pub struct Assumption {
    /// The label of the assumption's row in the table.
    pub description: &'static str,
    /// Texts of robots/paper.toml, each with its replacement.
    replacements: &'static [(&'static str, &'static str)],
    /// The surface, unless the floor is level and even.
    surface: Option<Surface>,
    /// A function that changes MuJoCo's scene.
    change_scene: fn(&mut Scene),
}

const UNCHANGED: Assumption = Assumption {
    description: "",
    replacements: &[],
    surface: None,
    change_scene: |_| {},
};

impl Assumption {
    /// All changed assumptions except those that change only the surface, which `Surface::ALL` lists.
    pub const ALL: [Self; 6] = [
        Self {
            description: "analogue servos that drive in bursts",
            change_scene: |scene| scene.drives_in_bursts = true,
            ..UNCHANGED
        },
        Self {
            description: "bursts, and a rotor of 5 ms",
            replacements: &[("\n[servo.A1]", "\n[servo]\nspin_up_ms = 5.0\n[servo.A1]")],
            change_scene: |scene| scene.drives_in_bursts = true,
            ..UNCHANGED
        },
        Self {
            description: "legs and links of a fifth of their mass",
            change_scene: |scene| scene.limb_mass_factor = 0.2,
            ..UNCHANGED
        },
        Self {
            description: "centre of mass 25 mm ahead",
            replacements: &[("\n[body]", "\n[body]\ncentre = [25.0, 0.0]")],
            ..UNCHANGED
        },
        Self {
            description: "centre of mass 25 mm behind",
            replacements: &[("\n[body]", "\n[body]\ncentre = [-25.0, 0.0]")],
            ..UNCHANGED
        },
        Self {
            description: "edge of 1 mm, pads with terraces of 0.1 mm",
            surface: Some(Surface::Edge(10)),
            change_scene: |scene| scene.pads = Pads::Terraces(0.1),
            ..UNCHANGED
        },
    ];

    /// Loads the paper's robot with this change.
    ///
    /// # Panics
    /// If a text to replace is not in robots/paper.toml, or if the changed robot is invalid.
    pub fn load_robot(&self) -> Robot {
        crate::load_changed_paper(self.description, self.replacements)
    }

    /// Returns the scene of a gait's walk. `level_displacement` is the gait's displacement on a level floor with the
    /// unchanged robot.
    ///
    /// # Panics
    /// If the robot has no such gait.
    pub fn make_scene(
        &self,
        name: &str,
        assembly: &Assembly,
        gait: &str,
        level_displacement: Displacement,
    ) -> Scene {
        let mut scene = match self.surface {
            Some(surface) => surface.make_scene(name, assembly, gait, level_displacement),
            None => make_two_cycle_scene(name, assembly, gait, Case::ALL[0]),
        };
        (self.change_scene)(&mut scene);
        scene
    }
}

/// Returns a table of each gait's change under each assumption and surface, from the largest change to the smallest,
/// in percent of MuJoCo's displacement on a level floor.
///
/// # Panics
/// If a displacement is missing.
pub fn format_table(
    walk_results: &WalkResults,
    surfaces: &SurfaceDisplacements,
    assumptions: &GroupedDisplacements,
) -> String {
    let percent_change = |gait: &str, displacement: Displacement| {
        let level_displacement = surface::find_level_displacement(walk_results, gait);
        let component = match level_displacement.0[0].abs() > level_displacement.0[2].abs() {
            true => Component::Forward,
            false => Component::Turn,
        };
        100.0 * (component.value(displacement) / component.value(level_displacement) - 1.0)
    };
    let surface_rows = Surface::ALL.map(|surface| {
        let name = surface.to_string();
        let changes = GAITS.map(|gait| percent_change(gait, surfaces["paper"][gait][&name]));
        (name, changes)
    });
    let assumption_rows = Assumption::ALL.map(|Assumption { description, .. }| {
        let changes = GAITS.map(|gait| percent_change(gait, assumptions[description][gait]));
        (description.to_owned(), changes)
    });
    let find_largest_change =
        |changes: &[f64; GAITS.len()]| changes.map(f64::abs).into_iter().fold(0.0, f64::max);
    let mut rows = [&surface_rows[..], &assumption_rows].concat();
    rows.sort_by(|(_, a), (_, b)| find_largest_change(b).total_cmp(&find_largest_change(a)));
    let widths = rows.iter().map(|(description, _)| description.len());
    let width = widths.max().unwrap_or(0);
    let mut text = format!("{:width$}", "");
    for gait in GAITS {
        _ = write!(text, "{gait:>10}");
    }
    text.push('\n');
    let (large, small): (Vec<_>, Vec<_>) = rows
        .into_iter()
        .partition(|(_, changes)| find_largest_change(changes) >= MIN_CHANGE_PERCENT);
    for (description, changes) in large {
        _ = write!(text, "{description:width$}");
        for change in changes {
            // Adding 0 turns -0 into 0.
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
