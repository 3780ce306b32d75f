//! The pads: domes under the feet, each on the head of the screw that sets its foot's height.
//!
//! No foot is lifted, so a flat pad would stop at the edge of a tile or a carpet. A dome slides over such an edge if it
//! is not too steep where the edge touches it. The pad is printed from a flexible filament with its flat side on the
//! bed. The underside has a hole for the hex key. The screw's head snaps in from above, through a mouth that is
//! narrower than the head.
//!
//! A strip with a grain, for example of ski climbing skin, can be glued along the dome from head to tail. The strip's
//! front end is folded up into a notch of the rim, so that it does not catch on an edge of the floor. The notch also
//! marks the direction of the pad. Around the notch, the dome has terraces.

use lizard_kinematics::Vector;
use lizard_robot::Parts;

use crate::layers::body::Prism;
use crate::layers::shape::Shape;
use crate::layers::stack::PAD_LIP_HEIGHT;

/// Radius of the hole for a 2 mm hex key, which is 2.3 mm across corners, mm.
const KEY_HOLE_RADIUS: f64 = 1.6;
/// Width of the rim around the key hole, mm: two printed lines.
const RIM_WIDTH: f64 = 0.8;
/// Difference between the radii of the screw's head and of the narrower mouth above it, mm.
const SNAP_INTERFERENCE: f64 = 0.65;
/// Height of the cones that approximate the dome, mm: their surfaces are within 0.02 mm of the sphere.
const CONE_HEIGHT: f64 = 0.1;
/// Depth of the notch for a strip's end, mm: the largest thickness of a strip.
pub(crate) const NOTCH_DEPTH: f64 = 1.5;
/// Smallest width of a strip, mm: wider than the key hole.
const MIN_STRIP_WIDTH: f64 = 5.0;
/// Smallest thickness of material under the screw's head, mm.
const MIN_THICKNESS_UNDER_HEAD: f64 = 1.0;

/// Smallest height of a pad, mm.
pub(crate) fn min_height(parts: &Parts) -> f64 {
    MIN_THICKNESS_UNDER_HEAD + parts.screw.head_height + PAD_LIP_HEIGHT
}

/// Smallest width of a pad, mm.
pub(crate) fn min_width(parts: &Parts) -> f64 {
    let notch_depth = if parts.strip > 0.0 { NOTCH_DEPTH } else { 0.0 };
    parts.screw.head + parts.fit + 2.0 * parts.wall + 2.0 * notch_depth
}

/// Smallest and largest width of a strip along a pad, mm.
pub(crate) fn strip_width_range(parts: &Parts) -> [f64; 2] {
    [MIN_STRIP_WIDTH, 0.7 * parts.pad.width - 2.0 * parts.fit]
}

/// Makes the notch in the rim of a pad with its middle at `middle`. `forward` is the unit vector towards the robot's
/// head. The first side of the shape runs to the robot's right.
fn make_notch(parts: &Parts, middle: Vector, forward: Vector) -> Shape {
    let right = Vector::new(forward.y, -forward.x);
    let half_width = parts.strip / 2.0 + parts.fit;
    let pad_radius = parts.pad.width / 2.0;
    let corner_at = |x: f64, y: f64| middle + right * x + forward * y;
    let (inner, outer) = (pad_radius - NOTCH_DEPTH, pad_radius + 1.0);
    Shape {
        points: vec![
            corner_at(-half_width, inner),
            corner_at(half_width, inner),
            corner_at(half_width, outer),
            corner_at(-half_width, outer),
        ],
        radius: 0.0,
    }
}

/// Makes the layers of a pad from the height `floor` (mm) up, centred on `middle`. `forward` is the unit vector towards
/// the robot's head.
pub(crate) fn make_pad_layers(
    parts: &Parts,
    middle: Vector,
    floor: f64,
    forward: Vector,
) -> Vec<Prism> {
    let (pad, screw) = (parts.pad, parts.screw);
    let pad_radius = pad.width / 2.0;
    let top = floor + pad.height;
    let seat = top - PAD_LIP_HEIGHT - screw.head_height;
    let dome_height = pad.dome_height().unwrap_or(pad_radius).min(pad.height);
    let hole_at = |z: f64| {
        let radius = if z < seat {
            KEY_HOLE_RADIUS
        } else if z < top - PAD_LIP_HEIGHT {
            (screw.head + parts.fit) / 2.0
        } else {
            screw.head / 2.0 - SNAP_INTERFERENCE
        };
        Shape::disc(middle, radius)
    };
    let rim_radius = KEY_HOLE_RADIUS + RIM_WIDTH;
    let radius_at = |z: f64| {
        let height = (z - floor).min(pad.radius);
        let section_radius = (height * (2.0 * pad.radius - height)).sqrt();
        section_radius.max(rim_radius).min(pad_radius)
    };
    // At this height the sphere is as wide as the rim.
    let rim_height = pad.radius - (pad.radius.powi(2) - rim_radius.powi(2)).sqrt();
    let cone_count = (dome_height / CONE_HEIGHT).ceil() as u32;
    let heights = (0..=cone_count).map(|index| (f64::from(index) * CONE_HEIGHT).min(dome_height));
    let cone_heights = heights.filter(|height| *height > rim_height + CONE_HEIGHT / 2.0);
    let mut levels: Vec<f64> = cone_heights
        .map(|height| floor + height)
        .chain([floor, floor + rim_height, seat, top - PAD_LIP_HEIGHT, top])
        .collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let notch = (parts.strip > 0.0).then(|| make_notch(parts, middle, forward));
    let layer_between = |heights: &[f64]| {
        let z = [heights[0], heights[1]];
        let (radii, hole) = (z.map(radius_at), hole_at(f64::midpoint(z[0], z[1])));
        match &notch {
            // A cone with a vertical cut has an edge that is not an arc, so this layer has vertical walls.
            Some(notch) if radii[0] > pad_radius - NOTCH_DEPTH => {
                let disc = Shape::disc(middle, radii[0]);
                Prism::new([disc], [hole, notch.clone()], z)
            }
            _ => Prism::cone(middle, radii, hole, z),
        }
    };
    levels.windows(2).map(layer_between).collect()
}
