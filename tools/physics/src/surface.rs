//! Walks on sloping and uneven floors, on floors with unequal friction, and with a lost pad.
//!
//! The contact model assumes a level, even floor. Therefore only MuJoCo predicts the effect of a tile's edge, of crumbs
//! or of a slope. No gait lifts a foot; a pad that is pushed against an edge must climb the edge.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

use lizard_parts::{Assembly, Block, Floor, Scene, Trajectory};
use lizard_robot::Robot;

use crate::case::Case;
use crate::crossing::Crossing;
use crate::grains::{self, GrainResults};
use crate::mujoco::make_two_cycle_scene;
use crate::results::{Displacement, GroupedDisplacements, WalkResults};
use crate::table::Component;
use crate::text::load_stored;

/// The names of the robots that walk on other surfaces: `paper` walks on all surfaces, and the other robots walk only
/// on the highest edge and blocks.
pub const ROBOT_NAMES: [&str; 5] = ["paper", "own-gaits", "large", "unequal", grains::ROBOT];

/// The smallest distance or turn per cycle of a gait that walks; other gaits only look around or wag the tail.
const MIN_DISTANCE_MM: f64 = 9.0;
const MIN_TURN_DEG: f64 = 3.0;

/// Returns the purposes of a gait with this displacement on a level floor: distance, turn, or both. A gait that does
/// not walk has no purpose.
pub(crate) fn list_gait_purposes(displacement: Displacement) -> Vec<Component> {
    Component::list_above(displacement, MIN_DISTANCE_MM, MIN_TURN_DEG)
}

/// Returns a robot's walking gaits, each with MuJoCo's displacement on a level floor.
///
/// # Panics
/// If no displacement of a gait is stored.
pub fn list_walking_gaits(walk_results: &WalkResults, robot: &str) -> Vec<(String, Displacement)> {
    if robot == grains::ROBOT {
        let stored: GrainResults = load_stored("grains.json");
        let with_displacement = |(gait, _): (&str, bool)| {
            let results = grains::find_results_at_own_ratio(&stored[gait]);
            (gait.to_owned(), results.mujoco)
        };
        return grains::GAITS.map(with_displacement).into();
    }
    let loaded_robot = crate::load_robot(robot);
    let gaits = loaded_robot.gaits().iter();
    let moving = gaits.filter(|gait| gait.has_movement());
    let level_results = moving.map(|gait| {
        let results = walk_results.get(robot, gait.name(), Case::ALL[0]);
        let results = results.expect("walks.json has the result");
        (gait.name().to_owned(), *results)
    });
    // If two feet pull against the other two, the contact model has no result, and the gait has no definite path.
    level_results
        .filter(|(_, results)| results.model.is_some())
        .map(|(gait, results)| (gait, results.mujoco))
        .filter(|(_, displacement)| !list_gait_purposes(*displacement).is_empty())
        .collect()
}

/// A kind of floor, or a level floor on which a foot is damaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// A step up of this height across the path, such as the edge of a tile or of a thin carpet; tenths of a mm.
    Edge(u8),
    /// Blocks of this height that cover a quarter of the floor; tenths of a mm.
    Blocks(u8),
    /// A slope of this angle, deg, which rises forward, or backward for a gait that walks backward.
    Slope(u8),
    /// A floor with a friction of 0.4 for the left feet and 0.8 for the right feet.
    UnequalFriction,
    /// A level floor for a robot whose front left foot has lost its pad.
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

    /// Returns the surfaces on which a robot walks.
    pub fn for_robot(robot: &str) -> Vec<Self> {
        match robot {
            "paper" => Self::ALL.into(),
            _ => vec![Self::Edge(20), Self::Blocks(10)],
        }
    }

    /// Returns true for edges and blocks, which a pad must climb.
    pub fn is_climbed(self) -> bool {
        matches!(self, Self::Edge(_) | Self::Blocks(_))
    }

    /// Returns the smallest fraction of a displacement component that a gait must keep on this surface; `None` if any
    /// fraction is accepted. A lost pad halves some turns; this is accepted because the user must repair the foot.
    fn min_fraction(self, component: Component) -> Option<f64> {
        match component {
            Component::Forward => self.is_climbed().then_some(0.85),
            Component::Turn => (self != Self::NoPad).then_some(0.75),
        }
    }

    /// Returns the floor on the path of a gait. `direction` is -1 for a gait that walks backward, so that this gait
    /// also walks up a slope; otherwise `direction` is 1.
    fn make_floor(self, assembly: &Assembly, crossing: &Crossing, direction: f64) -> Floor {
        let robot = assembly.robot();
        let mut floor = Floor::for_robot(robot);
        match self {
            Self::Edge(tenths) => floor.blocks.push(crossing.make_block(tenths_to_mm(tenths))),
            Self::Blocks(tenths) => floor.blocks = scatter_blocks(robot, tenths_to_mm(tenths)),
            Self::Slope(deg) => floor.slope = direction * f64::from(deg),
            Self::UnequalFriction => {
                let choose_friction = |[_, left]: [f64; 2]| if left > 0.0 { 0.4 } else { 0.8 };
                floor.friction_coefficients = robot
                    .ground()
                    .legs
                    .foot_positions([0.0; 4])
                    .map(choose_friction);
            }
            // The foot slides on the steel head of its screw.
            Self::NoPad => floor.friction_coefficients[0] = 0.2,
        }
        floor
    }

    /// Returns the scene of a gait's walk on this surface; `level_displacement` is the displacement on a level floor.
    ///
    /// # Panics
    /// If the robot has no such gait.
    pub fn make_scene(
        self,
        name: &str,
        assembly: &Assembly,
        gait: &str,
        level_displacement: Displacement,
    ) -> Scene {
        let robot = assembly.robot();
        let is_backward = level_displacement.0[0] < -MIN_DISTANCE_MM;
        let direction = if is_backward { -1.0 } else { 1.0 };
        let mut scene = make_two_cycle_scene(name, assembly, gait, Case::ALL[0]);
        scene.friction_ratio = robot.ground().friction_ratio;
        let gait = robot.gait(gait).expect("the robot has this gait");
        // On pads without a grain, a gait has its full speed from the beginning.
        let settling_cycles = match scene.friction_ratio == 1.0 {
            true => 0,
            false => grains::count_settling_cycles(gait),
        };
        let crossing = Crossing::find(robot, level_displacement, settling_cycles);
        let [cycles, measured_cycles] = match self.is_climbed() {
            true => [settling_cycles + crossing.cycle_count, crossing.cycle_count],
            false => [2, 1],
        };
        scene.trajectory = Some(Trajectory::for_gait(robot, gait, cycles, measured_cycles));
        scene.floor = self.make_floor(assembly, &crossing, direction);
        if self == Self::NoPad {
            // The foot stands on the head of its screw.
            scene.excess_lengths[0] = -assembly.stack().pad_head_height(robot.parts());
        }
        scene
    }
}

/// Converts tenths of a mm to mm.
fn tenths_to_mm(tenths: u8) -> f64 {
    f64::from(tenths) / 10.0
}

/// Returns blocks of 10 to 20 mm at pseudo-random positions, the same in each call. One block lies in each square of 30
/// mm; the blocks therefore cover a quarter of the floor. No block is under a foot at the start.
fn scatter_blocks(robot: &Robot, height_mm: f64) -> Vec<Block> {
    const SQUARE_MM: f64 = 30.0;
    const REACH_SQUARES: i32 = 12;
    let feet = robot.ground().legs.foot_positions([0.0; 4]);
    let mut seed: u32 = 1;
    let mut random_between = |min: f64, max: f64| {
        // The generator is from Numerical Recipes; only the upper 16 bits are random enough.
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        min + (max - min) * f64::from(seed >> 16) / 65536.0
    };
    let mut blocks = Vec::new();
    for row in -REACH_SQUARES..REACH_SQUARES {
        for column in -REACH_SQUARES / 2..REACH_SQUARES / 2 {
            let [width, length] = [random_between(10.0, 20.0), random_between(10.0, 20.0)];
            let mut random_position =
                |square: i32| SQUARE_MM * f64::from(square) + random_between(0.0, SQUARE_MM);
            let centre = [random_position(column), random_position(row)];
            let distance =
                |[forward, left]: [f64; 2]| (centre[0] + left).hypot(centre[1] - forward);
            if feet.into_iter().map(distance).fold(f64::INFINITY, f64::min) > SQUARE_MM {
                blocks.push(Block {
                    centre,
                    size: [width, length, height_mm],
                    rotation: 0.0,
                });
            }
        }
    }
    blocks
}

impl fmt::Display for Surface {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Edge(tenths) => write!(f, "edge of {} mm", tenths_to_mm(*tenths)),
            Self::Blocks(tenths) => write!(f, "blocks of {} mm", tenths_to_mm(*tenths)),
            Self::Slope(deg) => write!(f, "rises {deg} deg"),
            Self::UnequalFriction => f.write_str("friction .4, .8"),
            Self::NoPad => f.write_str("a pad lost"),
        }
    }
}

/// MuJoCo's displacements by robot, gait and surface.
pub type SurfaceDisplacements = BTreeMap<String, GroupedDisplacements>;

/// Returns MuJoCo's displacement of a gait of the paper's robot on a level floor.
///
/// # Panics
/// If no displacement of the gait is stored.
pub fn find_level_displacement(walk_results: &WalkResults, gait: &str) -> Displacement {
    let results = walk_results.get("paper", gait, Case::ALL[0]);
    results.expect("walks.json has the result").mujoco
}

/// Gaits that keep less of their displacement than required, each with its robot and surface. On pads with a grain,
/// `back` pushes against the grain.
pub const KNOWN_SHORTFALLS: [(&str, &str, Surface); 2] = [
    (grains::ROBOT, "back", Surface::Edge(20)),
    (grains::ROBOT, "back", Surface::Blocks(10)),
];

/// Returns a message for each purpose (distance, turn) of which the gait keeps less than required on the surface.
pub fn describe_shortfalls(
    surface: Surface,
    level_displacement: Displacement,
    displacement: Displacement,
) -> Vec<String> {
    let describe_shortfall = |component: Component| {
        let [level_value, value] =
            [level_displacement, displacement].map(|displacement| component.value(displacement));
        let unit = component.unit();
        let min_fraction = surface.min_fraction(component)?;
        let fraction = value / level_value;
        (fraction < min_fraction).then(|| {
            format!(
                "{value:.1} {unit} per cycle, {level_value:.1} {unit} on a level floor; \
                 the fraction {fraction:.2} must be at least {min_fraction:.2}"
            )
        })
    };
    let purposes = list_gait_purposes(level_displacement).into_iter();
    purposes.filter_map(describe_shortfall).collect()
}

/// Returns the table of a robot's gaits on its surfaces in Markdown.
pub fn format_surfaces_table(
    robot: &str,
    walk_results: &WalkResults,
    surfaces: &SurfaceDisplacements,
) -> String {
    let robot_surfaces = Surface::for_robot(robot);
    let headings = robot_surfaces.iter().map(|surface| format!(" {surface} |"));
    let headings = headings.collect::<String>();
    let separators = "---|".repeat(robot_surfaces.len());
    let mut text = format!("| gait | level |{headings}\n|---|---|{separators}\n");
    for (gait, level_displacement) in list_walking_gaits(walk_results, robot) {
        let stored = surfaces.get(robot).and_then(|by_gait| by_gait.get(&gait));
        for component in list_gait_purposes(level_displacement) {
            let format_cell = |displacement| format!(" {:+.1}", component.value(displacement));
            let displacements = robot_surfaces.iter().map(|surface| {
                let find_displacement = || stored?.get(&surface.to_string());
                let Some(displacement) = find_displacement() else {
                    return " - |".to_owned();
                };
                let fraction = component.value(*displacement) / component.value(level_displacement);
                let min_fraction = surface.min_fraction(component);
                let is_shortfall = min_fraction.is_some_and(|min_fraction| fraction < min_fraction);
                let mark = if is_shortfall { "!" } else { "" };
                format!("{}{mark} |", format_cell(*displacement))
            });
            let displacements = displacements.collect::<String>();
            let (unit, level_cell) = (component.unit(), format_cell(level_displacement));
            _ = writeln!(text, "| {gait}, {unit} |{level_cell} |{displacements}");
        }
    }
    for (name, component) in [
        ("a displacement", Component::Forward),
        ("a turn", Component::Turn),
    ] {
        let format_cell = |surface: &Surface| match surface.min_fraction(component) {
            Some(fraction) => format!(" {:.0} % |", 100.0 * fraction),
            None => " - |".to_owned(),
        };
        let cells: String = robot_surfaces.iter().map(format_cell).collect();
        _ = writeln!(text, "| at least, of {name} | 100 % |{cells}");
    }
    text
}
