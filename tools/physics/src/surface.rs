//! Floors that are not level, even and clean, and the walks on them.
//!
//! The contact model knows one floor. What a tile's edge, crumbs or a slope cost, only the engine
//! says: no foot is lifted, so each edge has to be climbed by a pad that is pushed against it.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

use lizard_parts::{Assembly, Block, Course, Floor, Scene};
use lizard_robot::Robot;

use crate::case::Case;
use crate::figures::{Displacement, Figures};
use crate::mujoco::scene_of;
use crate::table::Part;

/// The gaits of the paper's robot that are walked.
pub const GAITS: [&str; 8] = [
    "walk",
    "trot",
    "crawl",
    "back",
    "arc-left",
    "arc-right",
    "left",
    "right",
];

/// A kind of floor, or a fault of a foot on a level one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// A step up across the way, tenths of a mm high: the edge of a tile or of a thin carpet.
    Edge(u8),
    /// Blocks strewn over a quarter of the floor, tenths of a mm high.
    Blocks(u8),
    /// A slope that rises ahead, deg.
    Slope(u8),
    /// Friction of 0.4 for the left feet and 0.8 for the right ones.
    Uneven,
    /// The front left foot has lost its pad.
    NoPad,
}

impl Surface {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 8] = [
        Self::Edge(10),
        Self::Edge(20),
        Self::Blocks(5),
        Self::Blocks(10),
        Self::Slope(3),
        Self::Slope(8),
        Self::Uneven,
        Self::NoPad,
    ];

    /// True for edges and blocks, which a pad has to climb.
    pub fn is_climbed(self) -> bool {
        matches!(self, Self::Edge(_) | Self::Blocks(_))
    }

    /// The least share of its distance that a gait must keep here, if it goes ahead or back.
    pub fn least_way(self) -> Option<f64> {
        self.is_climbed().then_some(0.85)
    }

    /// The least share of its angle that a gait must keep here, if it turns. A lost pad is a fault
    /// to be mended: it halves some turns.
    pub fn least_turn(self) -> Option<f64> {
        (self != Self::NoPad).then_some(0.75)
    }

    /// The number of cycles to walk: with most gaits all four feet pass an edge in six.
    fn cycles(self) -> u32 {
        if self.is_climbed() { 6 } else { 1 }
    }

    /// The floor in front of the robot, or behind it for a gait that goes back.
    fn floor(self, assembly: &Assembly, direction: f64) -> Floor {
        let robot = assembly.robot();
        let mut floor = Floor::of(robot);
        match self {
            Self::Edge(tenths) => floor.blocks.push(edge(robot, direction, mm(tenths))),
            Self::Blocks(tenths) => floor.blocks = strewn_blocks(robot, mm(tenths)),
            Self::Slope(deg) => floor.rises = direction * f64::from(deg),
            Self::Uneven => {
                let side = |[_, left]: [f64; 2]| if left > 0.0 { 0.4 } else { 0.8 };
                floor.friction = robot.ground().feet.at([0.0; 4]).map(side);
            }
            // Steel on the floor.
            Self::NoPad => floor.friction[0] = 0.2,
        }
        floor
    }

    /// The scene of a gait on it; `level` is the gait's displacement on a level floor.
    ///
    /// # Panics
    /// If the robot has no such gait.
    pub fn scene(self, name: &str, assembly: &Assembly, gait: &str, level: Displacement) -> Scene {
        let robot = assembly.robot();
        let case = Case::ALL[0];
        let direction = if level.0[0] < -1.0 { -1.0 } else { 1.0 };
        let mut scene = scene_of(name, assembly, gait, case);
        let gait = robot.gait(gait).expect("it is the robot's");
        let cycles = self.cycles();
        scene.course = Some(Course::of(robot, gait, cycles.max(2), cycles));
        scene.floor = self.floor(assembly, direction);
        if self == Self::NoPad {
            // The foot stands on the head of its screw.
            scene.long[0] = -assembly.stack().under_head(robot.parts());
        }
        scene
    }
}

fn mm(tenths: u8) -> f64 {
    f64::from(tenths) / 10.0
}

/// A step up, beginning this far ahead of the feet, mm.
const AHEAD: f64 = 25.0;

fn edge(robot: &Robot, direction: f64, high: f64) -> Block {
    /// The length of the floor beyond the edge, mm.
    const STEP_LENGTH: f64 = 1000.0;
    let [forward, _] = robot.ground().feet.at([0.0; 4])[0];
    Block {
        at: [0.0, direction * (forward.abs() + AHEAD + STEP_LENGTH / 2.0)],
        size: [STEP_LENGTH, STEP_LENGTH, high],
    }
}

/// Blocks of 10 to 20 mm in places that look random and are the same each time: one in each
/// square of 30 mm, so that they cover a quarter of the floor. None is under a foot at the start.
fn strewn_blocks(robot: &Robot, high: f64) -> Vec<Block> {
    const SQUARE: f64 = 30.0;
    const REACH: i32 = 12;
    let feet = robot.ground().feet.at([0.0; 4]);
    let mut seed: u32 = 1;
    let mut random = |low: f64, max: f64| {
        // The constants of Numerical Recipes; the upper half of the bits is random enough.
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        low + (max - low) * f64::from(seed >> 16) / 65536.0
    };
    let mut blocks = Vec::new();
    for row in -REACH..REACH {
        for column in -REACH / 2..REACH / 2 {
            let [wide, long] = [random(10.0, 20.0), random(10.0, 20.0)];
            let mut place = |square: i32| SQUARE * f64::from(square) + random(0.0, SQUARE);
            let at = [place(column), place(row)];
            let away = |[forward, left]: [f64; 2]| (at[0] + left).hypot(at[1] - forward);
            if feet.into_iter().map(away).fold(f64::INFINITY, f64::min) > SQUARE {
                let size = [wide, long, high];
                blocks.push(Block { at, size });
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
            Self::Uneven => f.write_str("friction .4, .8"),
            Self::NoPad => f.write_str("a pad lost"),
        }
    }
}

/// MuJoCo's displacements on each surface, by gait and surface.
pub type Surfaces = BTreeMap<String, BTreeMap<String, Displacement>>;

/// The displacements stored in `surfaces.json`.
///
/// # Panics
/// If `surfaces.json` is not a table of displacements.
pub fn stored() -> Surfaces {
    serde_json::from_str(include_str!("../surfaces.json")).expect("surfaces.json")
}

/// The text of `surfaces.json`: a line for each gait.
///
/// # Panics
/// Never: they are names and numbers.
pub fn text(surfaces: &Surfaces) -> String {
    let line = |(gait, of): (&String, &BTreeMap<String, Displacement>)| {
        format!("{gait:?}: {}", serde_json::to_string(of).expect("numbers"))
    };
    let lines: Vec<String> = surfaces.iter().map(line).collect();
    format!("{{\n{}\n}}\n", lines.join(",\n"))
}

/// A gait's displacement on a level floor by MuJoCo.
///
/// # Panics
/// If none is stored.
pub fn level(figures: &Figures, gait: &str) -> Displacement {
    let answers = figures.get("paper", gait, Case::ALL[0]);
    answers.expect("figures.json has it").mujoco
}

/// The least share of a displacement's part that a gait must keep on a surface.
fn least(surface: Surface, part: Part) -> Option<f64> {
    match part {
        Part::Ahead => surface.least_way(),
        Part::Turn => surface.least_turn(),
    }
}

/// The messages for a gait that loses more of its distance or its turn than a surface allows.
pub fn excess_losses(
    surface: Surface,
    level: Displacement,
    displacement: Displacement,
) -> Vec<String> {
    let loss = |part: Part| {
        let [was, is] = [level, displacement].map(|displacement| part.value(displacement));
        let unit = part.unit();
        let least = least(surface, part)?;
        (is / was < least).then(|| {
            format!("{is:.1} {unit} a cycle of {was:.1} on a level floor; {least:.2} must be kept")
        })
    };
    Part::of(level).into_iter().filter_map(loss).collect()
}

/// The table of all surfaces, as Markdown.
pub fn surfaces_table(figures: &Figures, surfaces: &Surfaces) -> String {
    let heads = Surface::ALL.map(|surface| format!(" {surface} |")).concat();
    let lines = "---|".repeat(Surface::ALL.len());
    let mut text = format!("| gait | level |{heads}\n|---|---|{lines}\n");
    for gait in GAITS {
        let flat = level(figures, gait);
        for part in Part::of(flat) {
            let cell = |displacement| format!(" {:+.1} |", part.value(displacement));
            let displacements = Surface::ALL.map(|surface| {
                let displacement = surfaces
                    .get(gait)
                    .and_then(|of| of.get(&surface.to_string()));
                displacement.map_or(" - |".to_owned(), |displacement| cell(*displacement))
            });
            let (flat, displacements) = (cell(flat), displacements.concat());
            _ = writeln!(text, "| {gait}, {} |{flat}{displacements}", part.unit());
        }
    }
    for (name, part) in [("a way", Part::Ahead), ("a turn", Part::Turn)] {
        let bars = Surface::ALL.map(|surface| match least(surface, part) {
            Some(share) => format!(" {:.0} % |", 100.0 * share),
            None => " - |".to_owned(),
        });
        _ = writeln!(text, "| at least, of {name} | 100 % |{}", bars.concat());
    }
    text
}
