//! Roofs that a printer can make without supports.
//!
//! A sunk pocket that lies below when a part is printed has a roof, and in its middle a
//! hole. A printer can span the pocket with straight lines from edge to edge, but not
//! draw a ring in the air. So the hole is closed there by one layer, which is drilled
//! through when the part is done.

use lizard_kinematics::Vector;

use crate::body::Prism;
use crate::outline::{Loop, Outline};
use crate::shape::Shape;

/// Thickness of what closes a hole: one layer, mm.
pub const SKIN: f64 = 0.2;
/// How far beside a hole is looked for what it stands on, mm.
const BESIDE: f64 = 0.3;

/// Layers with the holes closed that would begin in the air, and how many holes are.
#[must_use]
pub fn closed(prisms: &[Prism]) -> (Vec<Prism>, usize) {
    let mut layers: Vec<Prism> = Vec::new();
    let mut count = 0;
    for (number, prism) in prisms.iter().enumerate() {
        let below = number
            .checked_sub(1)
            .map(|below| Outline::of(&prisms[below]));
        let (in_air, rest): (Vec<_>, Vec<_>) = prism.cut.iter().cloned().partition(|hole| {
            below
                .as_ref()
                .is_some_and(|below| begins_in_air(hole, prism, below))
        });
        if in_air.is_empty() {
            layers.push(prism.clone());
            continue;
        }
        count += in_air.len();
        let [low, high] = prism.z;
        layers.push(Prism {
            cut: rest,
            z: [low, low + SKIN],
            ..prism.clone()
        });
        layers.push(Prism {
            z: [low + SKIN, high],
            ..prism.clone()
        });
    }
    (layers, count)
}

/// The middles of those holes.
pub fn in_air(prisms: &[Prism]) -> Vec<Vector> {
    let mut middles = Vec::new();
    for pair in prisms.windows(2) {
        let below = Outline::of(&pair[0]);
        let holes = pair[1].cut.iter();
        let in_air = holes.filter(|hole| begins_in_air(hole, &pair[1], &below));
        middles.extend(in_air.map(Shape::middle));
    }
    middles
}

/// Whether nothing is below the edge of a hole, though it is in the material.
fn begins_in_air(hole: &Shape, prism: &Prism, below: &Outline) -> bool {
    let own = Outline::of(prism);
    let edge = Shape {
        points: hole.points.clone(),
        radius: hole.radius + BESIDE,
    };
    let alone = Outline::of(&Prism {
        add: vec![edge],
        cut: Vec::new(),
        z: prism.z,
    });
    let mut points = alone.loops().flat_map(Loop::ends);
    points.all(|(side, to)| {
        [side.from, side.middle(to)]
            .into_iter()
            .all(|point| own.holds(point) && !below.holds(point))
    })
}
