//! Drawings of parts to cut from a sheet: outlines to cut through, pockets to mill.
//!
//! A part can be cut if all of its layers have the same outer outline. If the layers of the plate or of the deck
//! differ, each layer is cut as a sheet of its own, and the sheets are glued together.

use lizard_kinematics::Vector;

use crate::layers::body::Prism;
use crate::layers::outline::{Loop, Outline, compute_bounds};
use crate::part::Part;

/// A drawing of one sheet, mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Name of the part, with the number of the sheet if the part has several.
    pub name: String,
    /// Thickness of the sheet, mm.
    pub thickness: f64,
    /// Layers of the drawing.
    pub layers: Vec<SheetLayer>,
}

/// A layer of a drawing: lines of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetLayer {
    /// Kind of the lines: `CUT`, or for example `POCKET_1.90_TOP` for pockets 1.9 mm deep from above.
    pub name: String,
    /// Closed lines of the layer.
    pub loops: Vec<Loop>,
}

impl SheetLayer {
    fn cut(loops: Vec<Loop>) -> Self {
        let name = "CUT".to_owned();
        Self { name, loops }
    }
}

/// Draws the sheets of a part; empty if the part cannot be cut.
pub fn draw_sheets(part: &Part) -> Vec<Sheet> {
    let outlines: Vec<_> = part.prisms.iter().map(Outline::from_prism).collect();
    let outer_loops = |outline: &Outline| -> Vec<Loop> {
        let islands = outline.islands.iter();
        islands.filter_map(|loops| loops.first().cloned()).collect()
    };
    let low = part.prisms.first().map_or(0.0, |prism| prism.z[0]);
    let high = part.prisms.last().map_or(0.0, |prism| prism.z[1]);
    let first_loops = outer_loops(&outlines[0]);
    let has_first_outline = |outline: &Outline| outer_loops(outline) == first_loops;
    if outlines.iter().all(has_first_outline) {
        return vec![Sheet {
            name: part.name.clone(),
            thickness: high - low,
            layers: draw_cut_and_pocket_layers(&part.prisms, &outlines, [low, high]),
        }];
    }
    if part.name != "plate" && part.name != "deck" {
        return Vec::new();
    }
    let layers = (1..).zip(part.prisms.iter().zip(&outlines));
    let sheets = layers.map(|(number, (prism, outline))| Sheet {
        name: format!("{} sheet {number}", part.name),
        thickness: prism.z[1] - prism.z[0],
        layers: vec![SheetLayer::cut(outline.loops().cloned().collect())],
    });
    sheets.collect()
}

/// Draws the outline, the holes and the pockets of a part whose layers all have the same outer outline.
fn draw_cut_and_pocket_layers(
    prisms: &[Prism],
    outlines: &[Outline],
    z: [f64; 2],
) -> Vec<SheetLayer> {
    let [low, high] = z;
    let outer_loops = outlines[0].islands.iter().filter_map(|loops| loops.first());
    let mut layers = vec![SheetLayer::cut(outer_loops.cloned().collect())];
    for (index, outline) in outlines.iter().enumerate() {
        let islands = outline.islands.iter();
        for hole in islands.flat_map(|loops| loops.iter().skip(1)) {
            // The layers are visited from the lowest up, so a hole that is already listed has its full depth.
            if layers.iter().any(|layer| layer.loops.contains(hole)) {
                continue;
            }
            let is_open_in = |layer_outline: &Outline| is_open(layer_outline, hole);
            let name = if outlines.iter().all(is_open_in) {
                "CUT".to_owned()
            } else if outlines[index..].iter().all(is_open_in) {
                format!("POCKET_{:.2}_TOP", high - prisms[index].z[0])
            } else {
                let open_layers = outlines.iter().take_while(|outline| is_open_in(outline));
                let depth = prisms[open_layers.count().max(index + 1) - 1].z[1] - low;
                format!("POCKET_{depth:.2}_BOTTOM")
            };
            match layers.iter_mut().find(|layer| layer.name == name) {
                Some(layer) => layer.loops.push(hole.clone()),
                None => layers.push(SheetLayer {
                    name,
                    loops: vec![hole.clone()],
                }),
            }
        }
    }
    layers
}

/// True if a layer has no material at the corners and at the sides' midpoints of a hole.
fn is_open(outline: &Outline, hole: &Loop) -> bool {
    let sides = hole.sides.iter();
    let sum = sides.fold(Vector::default(), |sum, side| sum + side.from);
    let middle = sum * (1.0 / hole.sides.len() as f64);
    // The probes lie slightly inside the hole, so that a hole of the same size in the layer counts as open.
    let shrink = |point: Vector| middle + (point - middle) * 0.999;
    let ends = hole.sides_with_end_points();
    let mut probes = ends.flat_map(|(side, to)| [side.from, side.midpoint(to)]);
    probes.all(|point| !outline.contains(shrink(point)))
}

/// Computes the smallest and the largest x and y of a sheet, mm; an arc counts as 17 points along it.
pub fn compute_sheet_bounds(sheet: &Sheet) -> [Vector; 2] {
    let loops = sheet.layers.iter().flat_map(|layer| &layer.loops);
    let sides = loops.flat_map(Loop::sides_with_end_points);
    compute_bounds(sides.flat_map(|(side, to)| {
        let arc = side.division_points(to, |_, _| 16);
        std::iter::once(side.from).chain(arc)
    }))
}
