//! The pads: domes under the feet, each on the head of the screw that sets its foot's height.
//!
//! No foot is lifted, so a flat pad would stop at the edge of a tile or a carpet. A dome slides over it, since its
//! slope at the edge is hardly steeper than friction allows. The pad is printed of a rubbery filament with its flat
//! side on the bed. Its underside has a hole for the hex key. The screw's head snaps in from above, through a mouth
//! that is narrower than the head.
//!
//! A strip with a grain, for example of climbing skin, can be glued along the dome from head to tail. Its front end
//! is folded up into a notch of the rim, so that it does not catch on an edge of the floor, and the notch shows how
//! the pad has to be turned. At the notch the dome has terraces.

use lizard_kinematics::Vector;
use lizard_robot::Parts;

use crate::layers::body::Prism;
use crate::layers::shape::Shape;
use crate::layers::stack::PAD_LIP;

/// Radius of the hole for a 2 mm hex key, which is 2.3 mm over its corners, mm.
const KEY_HOLE_RADIUS: f64 = 1.6;
/// Width of the rim around the key's hole, two printed lines, mm.
const RIM_WIDTH: f64 = 0.8;
/// Difference in radius between the screw's head and the narrower mouth above it, mm.
const SNAP: f64 = 0.65;
/// Height of the cones that approximate the dome, mm: their slopes are within 0.02 mm of the sphere.
const CONE_HEIGHT: f64 = 0.1;
/// Depth of the notch for the end of a strip, mm: as thick as a strip may be.
pub(crate) const NOTCH: f64 = 1.5;
/// Least width of a strip, mm: wider than the key's hole.
const MIN_STRIP_WIDTH: f64 = 5.0;
/// Least thickness of material under the screw's head, mm.
const MIN_UNDER_HEAD: f64 = 1.0;

/// The least height of a pad, mm.
pub(crate) fn least_height(parts: &Parts) -> f64 {
    MIN_UNDER_HEAD + parts.screw.head_height + PAD_LIP
}

/// The least width of a pad, mm.
pub(crate) fn least_width(parts: &Parts) -> f64 {
    let notches = if parts.strip > 0.0 { 2.0 * NOTCH } else { 0.0 };
    parts.screw.head + parts.fit + 2.0 * parts.wall + notches
}

/// The least and the greatest width of a strip along a pad, mm.
pub(crate) fn strip_widths(parts: &Parts) -> [f64; 2] {
    [MIN_STRIP_WIDTH, 0.7 * parts.pad.width - 2.0 * parts.fit]
}

/// The notch in the rim of a pad. `head` is the direction of the robot's head, of length one. The first side of the
/// shape runs to the robot's right.
fn notch_shape(parts: &Parts, point: Vector, head: Vector) -> Shape {
    let right = Vector::new(head.y, -head.x);
    let (half_width, half) = (parts.strip / 2.0 + parts.fit, parts.pad.width / 2.0);
    let corner_at = |x: f64, y: f64| point + right * x + head * y;
    let (low, high) = (half - NOTCH, half + 1.0);
    Shape {
        points: vec![
            corner_at(-half_width, low),
            corner_at(half_width, low),
            corner_at(half_width, high),
            corner_at(-half_width, high),
        ],
        radius: 0.0,
    }
}

/// The layers of a pad from the floor up. `head` is the direction of the robot's head, of length one.
pub(crate) fn layers(parts: &Parts, point: Vector, floor: f64, head: Vector) -> Vec<Prism> {
    let (pad, screw) = (parts.pad, parts.screw);
    let half = pad.width / 2.0;
    let top = floor + pad.height;
    let seat = top - PAD_LIP - screw.head_height;
    let dome = pad.dome().unwrap_or(half).min(pad.height);
    let hole_at = |z: f64| {
        let radius = if z < seat {
            KEY_HOLE_RADIUS
        } else if z < top - PAD_LIP {
            (screw.head + parts.fit) / 2.0
        } else {
            screw.head / 2.0 - SNAP
        };
        Shape::disc(point, radius)
    };
    let radius_at = |z: f64| {
        let height = (z - floor).min(pad.radius);
        let sphere_radius = (height * (2.0 * pad.radius - height)).sqrt();
        sphere_radius.max(KEY_HOLE_RADIUS + RIM_WIDTH).min(half)
    };
    // The height at which the sphere is as wide as the rim.
    let rim = pad.radius - (pad.radius.powi(2) - (KEY_HOLE_RADIUS + RIM_WIDTH).powi(2)).sqrt();
    let count = (dome / CONE_HEIGHT).ceil() as u32;
    let heights = (0..=count).map(|number| (f64::from(number) * CONE_HEIGHT).min(dome));
    let cones = heights.filter(|height| *height > rim + CONE_HEIGHT / 2.0);
    let mut levels: Vec<f64> = cones
        .map(|height| floor + height)
        .chain([floor, floor + rim, seat, top - PAD_LIP, top])
        .collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let notch = (parts.strip > 0.0).then(|| notch_shape(parts, point, head));
    let layer_of = |pair: &[f64]| {
        let z = [pair[0], pair[1]];
        let (radii, hole) = (z.map(radius_at), hole_at(f64::midpoint(z[0], z[1])));
        match &notch {
            // A cone with an upright cut has an edge that is not an arc, so this layer has upright walls.
            Some(notch) if radii[0] > half - NOTCH => {
                let disc = Shape::disc(point, radii[0]);
                Prism::new([disc], [hole, notch.clone()], z)
            }
            _ => Prism::cone(point, radii, hole, z),
        }
    };
    levels.windows(2).map(layer_of).collect()
}
