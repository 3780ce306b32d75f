//! Walks on sloping and uneven floors, on floors with unequal friction, and with a lost pad.
//!
//! The contact model knows only a level, even floor, so only MuJoCo predicts the effect of a tile's edge, of crumbs
//! or of a slope. No gait lifts a foot, so a pad that is pushed against an edge must climb it.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

use lizard_parts::{Assembly, Block, Course, Floor, Scene};
use lizard_robot::Robot;

use crate::case::Case;
use crate::crossing::Crossing;
use crate::figures::{Displacement, Figures};
use crate::grains;
use crate::mujoco::scene_of;
use crate::table::Component;

/// The names of the robots that walk on other surfaces: the paper's robot on all of them, the others only on the
/// highest edge and blocks.
pub const ROBOT_NAMES: [&str; 5] = ["paper", "own-gaits", "large", "unequal", grains::ROBOT];

/// The smallest displacement in a cycle, mm and deg, of a gait that walks; other gaits only look around or wag the
/// tail.
const MIN_DISPLACEMENT: (f64, f64) = (9.0, 3.0);

/// Returns the purposes of a gait with this displacement on a level floor: distance, turn, or both; none for a gait
/// that does not walk.
pub(crate) fn gait_purposes(Displacement([ahead, _, turn]): Displacement) -> Vec<Component> {
    let purposes = [
        (Component::Ahead, ahead.abs() > MIN_DISPLACEMENT.0),
        (Component::Turn, turn.abs() > MIN_DISPLACEMENT.1),
    ];
    purposes
        .into_iter()
        .filter(|(_, is_purpose)| *is_purpose)
        .map(|(component, _)| component)
        .collect()
}

/// Returns the gaits of a robot that walk, each with MuJoCo's displacement on a level floor.
///
/// # Panics
/// If no displacement of a gait is stored.
pub fn walking_gaits(figures: &Figures, robot: &str) -> Vec<(String, Displacement)> {
    if robot == grains::ROBOT {
        let stored = grains::stored();
        return grains::GAITS
            .map(|(gait, _)| {
                (
                    gait.to_owned(),
                    grains::results_at_own_ratio(&stored[gait]).mujoco,
                )
            })
            .into();
    }
    let loaded_robot = crate::load_robot(robot);
    let moving = loaded_robot
        .gaits()
        .iter()
        .filter(|gait| gait.has_movement());
    let level_results = moving.map(|gait| {
        let results = figures.get(robot, gait.name(), Case::ALL[0]);
        (
            gait.name().to_owned(),
            *results.expect("figures.json has the result"),
        )
    });
    // If two feet pull against the other two, the contact model has no result and the gait has no definite path.
    level_results
        .filter(|(_, results)| results.model.is_some())
        .map(|(gait, results)| (gait, results.mujoco))
        .filter(|(_, level)| !gait_purposes(*level).is_empty())
        .collect()
}

/// A kind of floor, or a level floor on which a foot is damaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// A step up across the path, such as the edge of a tile or of a thin carpet; its height in tenths of a mm.
    Edge(u8),
    /// Blocks that cover a quarter of the floor; their height in tenths of a mm.
    Blocks(u8),
    /// A slope that rises ahead; its angle in deg.
    Slope(u8),
    /// Friction of 0.4 for the left feet and 0.8 for the right ones.
    UnequalFriction,
    /// The front left foot has lost its pad.
    NoPad,
}

impl Surface {
    /// All surfaces, in the order of the table.
    pub const ALL: [Self; 8] = [
        Self::Edge(10),
        Self::Edge(20),
        Self::Blocks(5),
        Self::Blocks(10),
        Self::Slope(3),
        Self::Slope(8),
        Self::UnequalFriction,
        Self::NoPad,
    ];

    /// Returns the surfaces that a robot walks on.
    pub fn of(robot: &str) -> Vec<Self> {
        match robot {
            "paper" => Self::ALL.into(),
            _ => vec![Self::Edge(20), Self::Blocks(10)],
        }
    }

    /// True for edges and blocks, which a pad must climb.
    pub fn is_climbed(self) -> bool {
        matches!(self, Self::Edge(_) | Self::Blocks(_))
    }

    /// Returns the smallest share of its distance that a gait must keep on this surface if its purpose is distance;
    /// `None` if any share is accepted.
    pub fn min_distance_share(self) -> Option<f64> {
        self.is_climbed().then_some(0.85)
    }

    /// Returns the smallest share of its turn that a gait must keep on this surface; `None` if any share is accepted. A
    /// lost pad halves some turns; that is accepted, since the user must repair the foot.
    pub fn min_turn_share(self) -> Option<f64> {
        (self != Self::NoPad).then_some(0.75)
    }

    /// Returns the floor on the path of a gait. `direction` is -1 for a gait that walks back, so that it also walks
    /// up a slope; otherwise it is 1.
    fn floor(self, assembly: &Assembly, crossing: &Crossing, direction: f64) -> Floor {
        let robot = assembly.robot();
        let mut floor = Floor::of(robot);
        match self {
            Self::Edge(tenths) => floor.blocks.push(crossing.block(mm_of_tenths(tenths))),
            Self::Blocks(tenths) => floor.blocks = strewn_blocks(robot, mm_of_tenths(tenths)),
            Self::Slope(deg) => floor.slope = direction * f64::from(deg),
            Self::UnequalFriction => {
                let friction_of = |[_, left]: [f64; 2]| if left > 0.0 { 0.4 } else { 0.8 };
                floor.friction_coefficients =
                    robot.ground().feet.positions([0.0; 4]).map(friction_of);
            }
            // The foot slides on the steel head of its screw.
            Self::NoPad => floor.friction_coefficients[0] = 0.2,
        }
        floor
    }

    /// Returns the scene of a gait on this surface; `level_displacement` is the gait's displacement on a level floor.
    ///
    /// # Panics
    /// If the robot has no such gait.
    pub fn scene(
        self,
        name: &str,
        assembly: &Assembly,
        gait: &str,
        level_displacement: Displacement,
    ) -> Scene {
        let robot = assembly.robot();
        let direction = if level_displacement.0[0] < -MIN_DISPLACEMENT.0 {
            -1.0
        } else {
            1.0
        };
        let mut scene = scene_of(name, assembly, gait, Case::ALL[0]);
        scene.friction_ratio = robot.ground().friction_ratio;
        let gait = robot.gait(gait).expect("the robot has this gait");
        // On pads without a grain, a gait has its full speed from the first cycle on.
        let settling_cycles = match scene.friction_ratio == 1.0 {
            true => 0,
            false => grains::settling_cycle_count(gait),
        };
        let crossing = Crossing::of(robot, level_displacement, settling_cycles);
        let [cycles, measured_cycles] = match self.is_climbed() {
            true => [settling_cycles + crossing.cycle_count, crossing.cycle_count],
            false => [2, 1],
        };
        scene.course = Some(Course::of(robot, gait, cycles, measured_cycles));
        scene.floor = self.floor(assembly, &crossing, direction);
        if self == Self::NoPad {
            // The foot stands on the head of its screw.
            scene.excess_lengths[0] = -assembly.stack().pad_head_height(robot.parts());
        }
        scene
    }
}

/// Converts tenths of a mm to mm.
fn mm_of_tenths(tenths: u8) -> f64 {
    f64::from(tenths) / 10.0
}

/// Returns blocks of 10 to 20 mm at pseudo-random places, the same in each call: one block in each square of
/// 30 mm, so that they cover a quarter of the floor. No block is under a foot at the start.
fn strewn_blocks(robot: &Robot, height_mm: f64) -> Vec<Block> {
    const SQUARE_MM: f64 = 30.0;
    const REACH_SQUARES: i32 = 12;
    let feet = robot.ground().feet.positions([0.0; 4]);
    let mut seed: u32 = 1;
    let mut random_between = |min: f64, max: f64| {
        // The generator of Numerical Recipes; only the upper 16 bits are random enough.
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        min + (max - min) * f64::from(seed >> 16) / 65536.0
    };
    let mut blocks = Vec::new();
    for row in -REACH_SQUARES..REACH_SQUARES {
        for column in -REACH_SQUARES / 2..REACH_SQUARES / 2 {
            let [width, length] = [random_between(10.0, 20.0), random_between(10.0, 20.0)];
            let mut random_place =
                |square: i32| SQUARE_MM * f64::from(square) + random_between(0.0, SQUARE_MM);
            let centre = [random_place(column), random_place(row)];
            let distance =
                |[forward, left]: [f64; 2]| (centre[0] + left).hypot(centre[1] - forward);
            if feet.into_iter().map(distance).fold(f64::INFINITY, f64::min) > SQUARE_MM {
                let size = [width, length, height_mm];
                let rotation = 0.0;
                blocks.push(Block {
                    centre,
                    size,
                    rotation,
                });
            }
        }
    }
    blocks
}

impl fmt::Display for Surface {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Edge(tenths) => write!(f, "edge of {} mm", mm_of_tenths(*tenths)),
            Self::Blocks(tenths) => write!(f, "blocks of {} mm", mm_of_tenths(*tenths)),
            Self::Slope(deg) => write!(f, "rises {deg} deg"),
            Self::UnequalFriction => f.write_str("friction .4, .8"),
            Self::NoPad => f.write_str("a pad lost"),
        }
    }
}

/// MuJoCo's displacements by robot, gait and surface.
pub type SurfaceDisplacements = BTreeMap<String, BTreeMap<String, BTreeMap<String, Displacement>>>;

/// Returns the displacements stored in `surfaces.json`.
///
/// # Panics
/// If `surfaces.json` is not a table of displacements.
pub fn stored() -> SurfaceDisplacements {
    serde_json::from_str(include_str!("../surfaces.json"))
        .expect("surfaces.json has the expected format")
}

/// Returns MuJoCo's displacement of a gait of the paper's robot on a level floor.
///
/// # Panics
/// If no displacement of the gait is stored.
pub fn level_displacement(figures: &Figures, gait: &str) -> Displacement {
    let results = figures.get("paper", gait, Case::ALL[0]);
    results.expect("figures.json has the result").mujoco
}

/// Gaits that are known to keep less of their displacement than required, each with its robot and surface. On pads with
/// a grain, `back` pushes against the grain.
pub const KNOWN_SHORTFALLS: [(&str, &str, Surface); 2] = [
    (grains::ROBOT, "back", Surface::Edge(20)),
    (grains::ROBOT, "back", Surface::Blocks(10)),
];

/// True for a gait in [`KNOWN_SHORTFALLS`].
pub fn is_known_shortfall(robot: &str, gait: &str, surface: Surface) -> bool {
    KNOWN_SHORTFALLS.contains(&(robot, gait, surface))
}

/// Returns the smallest share of a component that a gait must keep on a surface; `None` if any share is accepted.
fn min_share(surface: Surface, component: Component) -> Option<f64> {
    match component {
        Component::Ahead => surface.min_distance_share(),
        Component::Turn => surface.min_turn_share(),
    }
}

/// Returns a message for each of the gait's purposes (distance, turn) of which the gait loses more than is allowed on
/// the surface.
pub fn excess_losses(
    surface: Surface,
    level_displacement: Displacement,
    displacement: Displacement,
) -> Vec<String> {
    let loss_message = |component: Component| {
        let [level_value, value] =
            [level_displacement, displacement].map(|displacement| component.value(displacement));
        let unit = component.unit();
        let least_share = min_share(surface, component)?;
        (value / level_value < least_share).then(|| {
            format!("{value:.1} {unit} a cycle of {level_value:.1} on a level floor; {least_share:.2} must be kept")
        })
    };
    gait_purposes(level_displacement)
        .into_iter()
        .filter_map(loss_message)
        .collect()
}

/// Returns the table of a robot's gaits on its surfaces in Markdown.
pub fn surfaces_table(robot: &str, figures: &Figures, surfaces: &SurfaceDisplacements) -> String {
    let robot_surfaces = Surface::of(robot);
    let headings = robot_surfaces.iter().map(|surface| format!(" {surface} |"));
    let lines = "---|".repeat(robot_surfaces.len());
    let mut text = format!(
        "| gait | level |{}\n|---|---|{lines}\n",
        headings.collect::<String>()
    );
    for (gait, level) in walking_gaits(figures, robot) {
        let stored = surfaces.get(robot).and_then(|by_gait| by_gait.get(&gait));
        for component in gait_purposes(level) {
            let cell_of = |displacement| format!(" {:+.1}", component.value(displacement));
            let displacements = robot_surfaces.iter().map(|surface| {
                let displacement =
                    stored.and_then(|by_surface| by_surface.get(&surface.to_string()));
                let Some(displacement) = displacement else {
                    return " - |".to_owned();
                };
                let share = component.value(*displacement) / component.value(level);
                let is_shortfall =
                    min_share(*surface, component).is_some_and(|least_share| share < least_share);
                let mark = if is_shortfall { "!" } else { "" };
                format!("{}{mark} |", cell_of(*displacement))
            });
            let (level_cell, displacements) = (cell_of(level), displacements.collect::<String>());
            _ = writeln!(
                text,
                "| {gait}, {} |{level_cell} |{displacements}",
                component.unit()
            );
        }
    }
    for (name, component) in [
        ("a displacement", Component::Ahead),
        ("a turn", Component::Turn),
    ] {
        let cells = robot_surfaces
            .iter()
            .map(|surface| match min_share(*surface, component) {
                Some(share) => format!(" {:.0} % |", 100.0 * share),
                None => " - |".to_owned(),
            });
        let cells = cells.collect::<String>();
        _ = writeln!(text, "| at least, of {name} | 100 % |{cells}");
    }
    text
}
