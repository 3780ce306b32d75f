//! Rectangles, seen from above, that the bodies do not leave at any accepted pose.
//!
//! Most pairs of bodies, such as the couplers of head and tail, are never close to each other. If their rectangles are
//! apart, the proof omits the pair.

use lizard_kinematics::Vector;

use super::guard::{Region, RelaxedGuard};
use super::interval::Interval;
use crate::bodies::assembly::Assembly;
use crate::layers::body::{Body, Mount};

/// Half width below which a region is not halved, deg.
const MIN_HALF_WIDTH_DEG: f64 = 2.0;

/// Bounds of x and y, mm, chassis frame.
pub type Rectangle = [Interval; 2];

/// Computes the rectangle of each body, in the order of [`Assembly::bodies`].
pub fn compute_bounding_rectangles(assembly: &Assembly, guard: &RelaxedGuard) -> Vec<Rectangle> {
    const EMPTY: Interval = Interval::new(f64::INFINITY, f64::NEG_INFINITY);
    let mut rectangles = vec![[EMPTY; 2]; assembly.bodies().len()];
    let mut mounts: Vec<Mount> = Vec::new();
    for body in assembly.bodies() {
        if mounts.contains(&body.mount) {
            continue;
        }
        mounts.push(body.mount);
        match body.mount.servos()[..] {
            [] => extend_rectangles(assembly, guard, body.mount, [], &mut rectangles),
            [a] => extend_rectangles(assembly, guard, body.mount, [a], &mut rectangles),
            [a, b] => extend_rectangles(assembly, guard, body.mount, [a, b], &mut rectangles),
            _ => extend_rectangles(assembly, guard, body.mount, [0, 1, 2, 3], &mut rectangles),
        }
    }
    rectangles
}

/// True if two rectangles are at least `min_mm` apart.
pub fn are_apart(a: &Rectangle, b: &Rectangle, min_mm: f64) -> bool {
    let mut sides = a.iter().zip(b);
    sides.any(|(a, b)| a.low - b.high >= min_mm || b.low - a.high >= min_mm)
}

/// Extends the rectangles of the bodies on a mount that depends on these servos to enclose the bounds of their points.
fn extend_rectangles<const N: usize>(
    assembly: &Assembly,
    guard: &RelaxedGuard,
    mount: Mount,
    servos: [usize; N],
    rectangles: &mut [Rectangle],
) {
    let ranges = servos.map(|servo| guard.ranges[servo]);
    let mut regions = vec![Region::from_bounds(ranges)];
    while let Some(region) = regions.pop() {
        let Some((bounds, _)) = guard.bound_cranks(&servos, &region) else {
            continue;
        };
        if let Some(index) = region.widest_servo()
            && region.half_widths[index] > MIN_HALF_WIDTH_DEG
        {
            regions.extend(region.halves(index));
            continue;
        }
        let placement = assembly.placement_for_cranks(mount, bounds);
        let bodies = assembly.bodies().iter().zip(rectangles.iter_mut());
        for (body, rectangle) in bodies.filter(|(body, _)| body.mount == mount) {
            for (point, radius) in list_points(body) {
                let position = placement.map(point);
                let coordinates = [position.x.value, position.y.value];
                for (side, bounds) in rectangle.iter_mut().zip(coordinates) {
                    side.low = side.low.min(bounds.low - radius);
                    side.high = side.high.max(bounds.high + radius);
                }
            }
        }
    }
}

/// Lists the points of a body's shapes, each with the shape's radius.
fn list_points(body: &Body) -> impl Iterator<Item = (Vector, f64)> {
    let shapes = body.prisms.iter().flat_map(|prism| &prism.filled_shapes);
    shapes.flat_map(|shape| shape.points.iter().map(|&point| (point, shape.radius)))
}
