//! Walks on sloping and uneven floors, on floors with unequal friction, and with a lost pad.
//!
//! The contact model knows only a level, even floor. Only MuJoCo predicts the effect of a tile's edge, crumbs
//! or a slope. No gait lifts a foot, so a pad that is pushed against an edge has to climb it.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

use lizard_parts::{Assembly, Block, Course, Floor, Scene};
use lizard_robot::Robot;

use crate::case::Case;
use crate::crossing::Crossing;
use crate::figures::{Displacement, Figures};
use crate::grains;
use crate::mujoco::scene_of;
use crate::table::Part;

/// The names of the robots that walk over edges and blocks: the paper's robot on every surface, the
/// others on the highest edge and blocks.
pub const ROBOTS: [&str; 5] = ["paper", "own-gaits", "large", "unequal", grains::ROBOT];

/// The least displacement in a cycle, mm and deg, of a gait that walks; other gaits look around or wag.
const MIN_DISPLACEMENT: (f64, f64) = (9.0, 3.0);

/// Returns the purpose of a gait with this displacement on a level floor: distance, turn, or both; empty for
/// a gait that does not walk.
pub(crate) fn gait_purposes(Displacement([ahead, _, turn]): Displacement) -> Vec<Part> {
    let purposes = [
        (Part::Ahead, ahead.abs() > MIN_DISPLACEMENT.0),
        (Part::Turn, turn.abs() > MIN_DISPLACEMENT.1),
    ];
    purposes
        .into_iter()
        .filter(|(_, is_for)| *is_for)
        .map(|(part, _)| part)
        .collect()
}

/// Returns the gaits of a robot that walk, each with its displacement on a level floor by MuJoCo.
///
/// # Panics
/// If no displacement of a gait is stored.
pub fn gaits(figures: &Figures, robot: &str) -> Vec<(String, Displacement)> {
    if robot == grains::ROBOT {
        let stored = grains::stored();
        return grains::GAITS
            .map(|(gait, _)| {
                (
                    gait.to_owned(),
                    grains::answers_at_own_ratio(&stored[gait]).mujoco,
                )
            })
            .into();
    }
    let loaded_robot = crate::robot(robot);
    let moving = loaded_robot
        .gaits()
        .iter()
        .filter(|gait| gait.has_movement());
    let level_answers = moving.map(|gait| {
        let answers = figures.get(robot, gait.name(), Case::ALL[0]);
        (
            gait.name().to_owned(),
            *answers.expect("figures.json has it"),
        )
    });
    // If two feet pull against the other two, the contact model has no answer and the gait has no definite path.
    level_answers
        .filter(|(_, answers)| answers.model.is_some())
        .map(|(gait, answers)| (gait, answers.mujoco))
        .filter(|(_, level)| !gait_purposes(*level).is_empty())
        .collect()
}

/// A kind of floor, or a fault of a foot on a level floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// A step up across the path, tenths of a mm high: the edge of a tile or of a thin carpet.
    Edge(u8),
    /// Blocks strewn over a quarter of the floor, tenths of a mm high.
    Blocks(u8),
    /// A slope that rises ahead, deg.
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

    /// True for edges and blocks, which a pad has to climb.
    pub fn is_climbed(self) -> bool {
        matches!(self, Self::Edge(_) | Self::Blocks(_))
    }

    /// Returns the least share of its distance that a gait must keep on this surface, if it walks ahead or
    /// back; `None` if any share is accepted.
    pub fn least_distance(self) -> Option<f64> {
        self.is_climbed().then_some(0.85)
    }

    /// Returns the least share of its turn that a gait must keep on this surface; `None` if any share is accepted. A
    /// lost pad halves some turns; that is accepted, since the user has to repair it.
    pub fn least_turn(self) -> Option<f64> {
        (self != Self::NoPad).then_some(0.75)
    }

    /// Returns the floor on the path of a gait. `direction` is -1 for a gait that walks back, so that it, too,
    /// walks up a slope.
    fn floor(self, assembly: &Assembly, crossing: &Crossing, direction: f64) -> Floor {
        let robot = assembly.robot();
        let mut floor = Floor::of(robot);
        match self {
            Self::Edge(tenths) => floor.blocks.push(crossing.block(mm(tenths))),
            Self::Blocks(tenths) => floor.blocks = strewn_blocks(robot, mm(tenths)),
            Self::Slope(deg) => floor.slope = direction * f64::from(deg),
            Self::UnequalFriction => {
                let friction_of = |[_, left]: [f64; 2]| if left > 0.0 { 0.4 } else { 0.8 };
                floor.friction_coefficients =
                    robot.ground().feet.positions([0.0; 4]).map(friction_of);
            }
            // The screw's steel head rubs on the floor.
            Self::NoPad => floor.friction_coefficients[0] = 0.2,
        }
        floor
    }

    /// Returns the scene of a gait on this surface; `level` is the gait's displacement on a level floor.
    ///
    /// # Panics
    /// If the robot has no such gait.
    pub fn scene(self, name: &str, assembly: &Assembly, gait: &str, level: Displacement) -> Scene {
        let robot = assembly.robot();
        let direction = if level.0[0] < -MIN_DISPLACEMENT.0 {
            -1.0
        } else {
            1.0
        };
        let mut scene = scene_of(name, assembly, gait, Case::ALL[0]);
        scene.friction_ratio = robot.ground().friction_ratio;
        let gait = robot.gait(gait).expect("it is the robot's");
        // On pads without a grain, a gait has its full speed from the first cycle on.
        let settling_cycles = match scene.friction_ratio == 1.0 {
            true => 0,
            false => grains::settling_cycles(gait),
        };
        let crossing = Crossing::of(robot, level, settling_cycles);
        let [cycles, measured_cycles] = match self.is_climbed() {
            true => [settling_cycles + crossing.cycles, crossing.cycles],
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

fn mm(tenths: u8) -> f64 {
    f64::from(tenths) / 10.0
}

/// Returns blocks of 10 to 20 mm at pseudo-random places, the same in each call: one block in each square of
/// 30 mm, so that they cover a quarter of the floor. No block is under a foot at the start.
fn strewn_blocks(robot: &Robot, height_mm: f64) -> Vec<Block> {
    const SQUARE_MM: f64 = 30.0;
    const REACH_SQUARES: i32 = 12;
    let feet = robot.ground().feet.positions([0.0; 4]);
    let mut seed: u32 = 1;
    let mut random_between = |low: f64, max: f64| {
        // The constants of Numerical Recipes; the upper half of the bits is random enough.
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        low + (max - low) * f64::from(seed >> 16) / 65536.0
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
            Self::Edge(tenths) => write!(f, "edge of {} mm", mm(*tenths)),
            Self::Blocks(tenths) => write!(f, "blocks of {} mm", mm(*tenths)),
            Self::Slope(deg) => write!(f, "rises {deg} deg"),
            Self::UnequalFriction => f.write_str("friction .4, .8"),
            Self::NoPad => f.write_str("a pad lost"),
        }
    }
}

/// MuJoCo's displacements by robot, gait and surface.
pub type Surfaces = BTreeMap<String, BTreeMap<String, BTreeMap<String, Displacement>>>;

/// Returns the displacements stored in `surfaces.json`.
///
/// # Panics
/// If `surfaces.json` is not a table of displacements.
pub fn stored() -> Surfaces {
    serde_json::from_str(include_str!("../surfaces.json")).expect("surfaces.json")
}

/// Returns the displacement of a gait of the paper's robot on a level floor by MuJoCo.
///
/// # Panics
/// If no displacement of the gait is stored.
pub fn level_displacement(figures: &Figures, gait: &str) -> Displacement {
    let answers = figures.get("paper", gait, Case::ALL[0]);
    answers.expect("figures.json has it").mujoco
}

/// The gaits that are known to keep less of their displacement than required, each with its robot and
/// surface. On pads with a grain, `back` pushes against the grain.
pub const KNOWN_SHORTFALLS: [(&str, &str, Surface); 2] = [
    (grains::ROBOT, "back", Surface::Edge(20)),
    (grains::ROBOT, "back", Surface::Blocks(10)),
];

/// True for a gait in [`KNOWN_SHORTFALLS`].
pub fn is_known_shortfall(robot: &str, gait: &str, surface: Surface) -> bool {
    KNOWN_SHORTFALLS.contains(&(robot, gait, surface))
}

/// Returns the least share of its distance or turn that a gait must keep on a surface; `None` if any share
/// is accepted.
fn min_share(surface: Surface, part: Part) -> Option<f64> {
    match part {
        Part::Ahead => surface.least_distance(),
        Part::Turn => surface.least_turn(),
    }
}

/// Returns one message for each of the gait's purposes (distance, turn) of which it loses more than the surface
/// allows.
pub fn excess_losses(
    surface: Surface,
    level: Displacement,
    displacement: Displacement,
) -> Vec<String> {
    let loss_message = |part: Part| {
        let [level_value, value] =
            [level, displacement].map(|displacement| part.value(displacement));
        let unit = part.unit();
        let least_share = min_share(surface, part)?;
        (value / level_value < least_share).then(|| {
            format!("{value:.1} {unit} a cycle of {level_value:.1} on a level floor; {least_share:.2} must be kept")
        })
    };
    gait_purposes(level)
        .into_iter()
        .filter_map(loss_message)
        .collect()
}

/// Returns the table of a robot's gaits on its surfaces in Markdown.
pub fn surfaces_table(robot: &str, figures: &Figures, surfaces: &Surfaces) -> String {
    let robot_surfaces = Surface::of(robot);
    let heads = robot_surfaces.iter().map(|surface| format!(" {surface} |"));
    let lines = "---|".repeat(robot_surfaces.len());
    let mut text = format!(
        "| gait | level |{}\n|---|---|{lines}\n",
        heads.collect::<String>()
    );
    for (gait, level) in gaits(figures, robot) {
        let stored = surfaces.get(robot).and_then(|by_gait| by_gait.get(&gait));
        for part in gait_purposes(level) {
            let cell_of = |displacement| format!(" {:+.1}", part.value(displacement));
            let displacements = robot_surfaces.iter().map(|surface| {
                let displacement =
                    stored.and_then(|by_surface| by_surface.get(&surface.to_string()));
                let Some(displacement) = displacement else {
                    return " - |".to_owned();
                };
                let share = part.value(*displacement) / part.value(level);
                let is_less =
                    min_share(*surface, part).is_some_and(|least_share| share < least_share);
                let mark = if is_less { "!" } else { "" };
                format!("{}{mark} |", cell_of(*displacement))
            });
            let (level_cell, displacements) = (cell_of(level), displacements.collect::<String>());
            _ = writeln!(
                text,
                "| {gait}, {} |{level_cell} |{displacements}",
                part.unit()
            );
        }
    }
    for (name, part) in [("a displacement", Part::Ahead), ("a turn", Part::Turn)] {
        let cells = robot_surfaces
            .iter()
            .map(|surface| match min_share(*surface, part) {
                Some(share) => format!(" {:.0} % |", 100.0 * share),
                None => " - |".to_owned(),
            });
        let cells = cells.collect::<String>();
        _ = writeln!(text, "| at least, of {name} | 100 % |{cells}");
    }
    text
}
