//! The pads: domes under the feet, each on the head of the screw that sets its foot's height.
//!
//! No foot is lifted, so a flat pad stops at the edge of a tile or a carpet. A dome slides up:
//! where an edge touches it, it is hardly steeper than friction lets it climb. It is printed of
//! a rubbery filament with its flat side on the bed. Below is a hole for the hex key; the head
//! snaps in from above, through a mouth that is narrower than the head.

use lizard_kinematics::Vector;
use lizard_robot::Parts;

use crate::layers::body::Prism;
use crate::layers::shape::Shape;
use crate::layers::stack::PAD_LIP;

/// Radius of the hole for a 2 mm hex key, which is 2.3 mm over its corners, mm.
const KEY_HOLE: f64 = 1.6;
/// Two lines of a printer around this hole, mm.
const RIM: f64 = 0.8;
/// By how much the mouth above the head is narrower than the head all around, mm.
const SNAP: f64 = 0.65;
/// Height of the cones that make the dome, mm: their slopes are within 0.02 mm of the ball.
const CONE: f64 = 0.1;
/// Least material under the head, mm.
const UNDER_HEAD: f64 = 1.0;

/// The least height of a pad, mm.
pub(crate) fn least_height(parts: &Parts) -> f64 {
    UNDER_HEAD + parts.screw.head_height + PAD_LIP
}

/// The least width of a pad, mm.
pub(crate) fn least_width(parts: &Parts) -> f64 {
    parts.screw.head + parts.fit + 2.0 * parts.wall
}

/// The layers of a pad from the floor up.
pub(crate) fn layers(parts: &Parts, point: Vector, floor: f64) -> Vec<Prism> {
    let (pad, screw) = (parts.pad, parts.screw);
    let half = pad.width / 2.0;
    let top = floor + pad.height;
    let seat = top - PAD_LIP - screw.head_height;
    let dome = pad.dome().unwrap_or(half).min(pad.height);
    let hole = |z: f64| {
        let radius = if z < seat {
            KEY_HOLE
        } else if z < top - PAD_LIP {
            (screw.head + parts.fit) / 2.0
        } else {
            screw.head / 2.0 - SNAP
        };
        Shape::disc(point, radius)
    };
    let outline = |z: f64| {
        let high = (z - floor).min(pad.radius);
        let ball = (high * (2.0 * pad.radius - high)).sqrt();
        ball.max(KEY_HOLE + RIM).min(half)
    };
    // The height at which the ball is as wide as the rim.
    let rim = pad.radius - (pad.radius.powi(2) - (KEY_HOLE + RIM).powi(2)).sqrt();
    let count = (dome / CONE).ceil() as u32;
    let heights = (0..=count).map(|number| (f64::from(number) * CONE).min(dome));
    let cones = heights.filter(|height| *height > rim + CONE / 2.0);
    let mut levels: Vec<f64> = cones
        .map(|height| floor + height)
        .chain([floor, floor + rim, seat, top - PAD_LIP, top])
        .collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let layer = |pair: &[f64]| {
        let z = [pair[0], pair[1]];
        Prism::cone(point, z.map(outline), hole(f64::midpoint(z[0], z[1])), z)
    };
    levels.windows(2).map(layer).collect()
}
