//! Comparison of flat and domed pads on walks over edges and blocks.

use std::fmt::Write as _;

use lizard_parts::{Assembly, Pads, Scene};

use crate::results::{Displacement, GroupedDisplacements};
use crate::surface::Surface;

/// The gait of the comparison.
pub const GAIT: &str = "walk";
/// The surfaces of the table.
pub const SURFACES: [Surface; 4] = [
    Surface::Edge(10),
    Surface::Edge(20),
    Surface::Blocks(5),
    Surface::Blocks(10),
];

/// A shape of the pads; each shape is a row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PadShape {
    /// A flat disc, 8 mm wide.
    Flat,
    /// A dome of this radius, mm.
    Dome(u8),
}

impl PadShape {
    /// All shapes, in the order of the table.
    pub const ALL: [Self; 7] = [
        Self::Flat,
        Self::Dome(5),
        Self::Dome(10),
        Self::Dome(15),
        Self::Dome(20),
        Self::Dome(25),
        Self::Dome(30),
    ];

    /// Returns the shape's name in the table.
    pub fn name(self) -> String {
        match self {
            Self::Flat => "flat, 8 mm wide".to_owned(),
            Self::Dome(radius) => radius.to_string(),
        }
    }

    /// Returns the scene of a walk on a surface; `level_displacement` is the gait's displacement on a level floor.
    pub fn make_scene(
        self,
        name: &str,
        paper: &Assembly,
        surface: Surface,
        level_displacement: Displacement,
    ) -> Scene {
        let mut scene = surface.make_scene(name, paper, GAIT, level_displacement);
        scene.pads = match self {
            Self::Flat => Pads::Flat(8.0),
            Self::Dome(radius) => Pads::Domes(f64::from(radius)),
        };
        scene
    }
}

/// Returns the table in Markdown: mm forward per cycle, or a dash if a walk is missing.
pub fn format_table(shapes: &GroupedDisplacements) -> String {
    let headings = SURFACES.map(|surface| format!(" {surface} |")).concat();
    let separators = "---|".repeat(SURFACES.len());
    let mut text = format!("| radius, mm |{headings}\n|---|{separators}\n");
    for shape in PadShape::ALL {
        let by_surface = shapes.get(&shape.name());
        let cells = SURFACES.map(|surface| {
            let find_displacement = || by_surface?.get(&surface.to_string());
            // Adding 0 turns -0 into 0.
            let forward_mm =
                find_displacement().map(|displacement| displacement.0[0].round() + 0.0);
            forward_mm.map_or(" - |".to_owned(), |forward_mm| format!(" {forward_mm} |"))
        });
        _ = writeln!(text, "| {} |{}", shape.name(), cells.concat());
    }
    text
}
