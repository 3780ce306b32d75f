//! What is cut from a sheet: outlines to be cut through, and pockets to be milled.
//!
//! A part can be cut where all of its layers have the same outer outline. Plate and
//! deck cannot, but are each two sheets that are glued together.

use lizard_kinematics::Vector;

use crate::layers::body::Prism;
use crate::layers::outline::{Loop, Outline};
use crate::part::Part;

/// A drawing of one sheet, mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// What is drawn.
    pub name: String,
    /// As thick is the sheet, mm.
    pub thickness: f64,
    /// Lines by layers of the drawing.
    pub layers: Vec<Layer>,
}

/// Lines of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// `CUT`, or `POCKET_1.90_TOP` for a pocket of a depth from above.
    pub name: String,
    /// Its closed lines.
    pub loops: Vec<Loop>,
}

/// The sheets of a part; none where it cannot be cut.
#[must_use]
pub fn sheets(part: &Part) -> Vec<Sheet> {
    let outlines: Vec<_> = part.prisms.iter().map(Outline::of).collect();
    let outer = |outline: &Outline| -> Vec<Loop> {
        let pieces = outline.pieces.iter();
        pieces.filter_map(|piece| piece.first().cloned()).collect()
    };
    let [low, high] = [
        part.prisms.first().map_or(0.0, |prism| prism.z[0]),
        part.prisms.last().map_or(0.0, |prism| prism.z[1]),
    ];
    let first = outer(&outlines[0]);
    if outlines.iter().all(|outline| outer(outline) == first) {
        return vec![Sheet {
            name: part.name.clone(),
            thickness: high - low,
            layers: pockets(&part.prisms, &outlines, [low, high]),
        }];
    }
    if part.name != "plate" && part.name != "deck" {
        return Vec::new();
    }
    let sheets = part.prisms.iter().zip(&outlines).enumerate();
    sheets
        .map(|(number, (prism, outline))| Sheet {
            name: format!("{} sheet {}", part.name, number + 1),
            thickness: prism.z[1] - prism.z[0],
            layers: vec![Layer {
                name: "CUT".to_owned(),
                loops: outline.loops().cloned().collect(),
            }],
        })
        .collect()
}

/// The lines of a part whose layers have one outline.
fn pockets(prisms: &[Prism], outlines: &[Outline], [low, high]: [f64; 2]) -> Vec<Layer> {
    let mut layers = vec![Layer {
        name: "CUT".to_owned(),
        loops: Vec::new(),
    }];
    let holes = |outline: &Outline| -> Vec<Loop> {
        let pieces = outline.pieces.iter();
        pieces
            .flat_map(|piece| piece.iter().skip(1).cloned())
            .collect()
    };
    let mut add = |name: String, line: Loop| {
        // From below to above, a pocket that is known already is deeper there.
        if layers.iter().any(|layer| layer.loops.contains(&line)) {
            return;
        }
        if let Some(layer) = layers.iter_mut().find(|layer| layer.name == name) {
            layer.loops.push(line);
        } else {
            layers.push(Layer {
                name,
                loops: vec![line],
            });
        }
    };
    for piece in &outlines[0].pieces {
        if let Some(outer) = piece.first() {
            add("CUT".to_owned(), outer.clone());
        }
    }
    for (index, outline) in outlines.iter().enumerate() {
        for hole in holes(outline) {
            let open = |other: &Outline| is_open(other, &hole);
            if outlines.iter().all(open) {
                add("CUT".to_owned(), hole);
            } else if outlines[index..].iter().all(open) {
                let depth = high - prisms[index].z[0];
                add(format!("POCKET_{depth:.2}_TOP"), hole);
            } else {
                let from_below = outlines.iter().take_while(|other| open(other)).count();
                let depth = prisms[from_below.max(index + 1) - 1].z[1] - low;
                add(format!("POCKET_{depth:.2}_BOTTOM"), hole);
            }
        }
    }
    layers
}

/// Whether there is nothing of a layer within a hole.
fn is_open(outline: &Outline, hole: &Loop) -> bool {
    let n = hole.sides.len() as f64;
    let sum = hole
        .sides
        .iter()
        .fold(Vector::default(), |sum, side| sum + side.from);
    let middle = sum * (1.0 / n);
    // A little within the line, so that a hole of the same size counts as open.
    let within = |point: Vector| middle + (point - middle) * 0.999;
    let ends = hole.ends();
    let mut probes = ends.flat_map(|(side, to)| [side.from, side.middle(to)]);
    probes.all(|point| !outline.holds(within(point)))
}

/// The smallest and the largest x and y of a sheet, arcs at their full size, mm.
#[must_use]
pub fn extent(sheet: &Sheet) -> [Vector; 2] {
    let mut low = Vector::new(f64::INFINITY, f64::INFINITY);
    let mut high = Vector::new(f64::NEG_INFINITY, f64::NEG_INFINITY);
    let mut grow = |x: f64, y: f64| {
        low = Vector::new(low.x.min(x), low.y.min(y));
        high = Vector::new(high.x.max(x), high.y.max(y));
    };
    for line in sheet.layers.iter().flat_map(|layer| &layer.loops) {
        for (side, to) in line.ends() {
            let points = 16;
            grow(side.from.x, side.from.y);
            if let Some((centre, _)) = side.arc(to) {
                let arm = side.from - centre;
                let whole = 4.0 * libm::atan(side.bulge);
                for i in 1..points {
                    let angle = whole * f64::from(i) / f64::from(points);
                    let at = centre + arm * libm::cos(angle) + arm.left() * libm::sin(angle);
                    grow(at.x, at.y);
                }
            }
        }
    }
    [low, high]
}
