//! Rectangles, seen from above, that the bodies do not leave at any accepted pose.
//!
//! Most pairs of bodies, such as the couplers of head and tail, are never close to each other. If their rectangles are
//! apart, the proof omits the pair.

use lizard_kinematics::Vector;

use super::guard::{Guard, Region};
use super::interval::Interval;
use crate::bodies::assembly::Assembly;
use crate::layers::body::{Body, Mount};

/// Half width below which a region is not halved, deg.
const MIN_HALF_WIDTH_DEG: f64 = 2.0;

/// Bounds of x and y, mm, chassis frame.
pub type Rectangle = [Interval; 2];

/// Computes the rectangle of each body, in the order of [`Assembly::bodies`].
pub fn compute_bounding_rectangles(assembly: &Assembly, guard: &Guard) -> Vec<Rectangle> {
    const EMPTY: Interval = Interval::new(f64::INFINITY, f64::NEG_INFINITY);
    let mut rectangles = vec![[EMPTY; 2]; assembly.bodies().len()];
    let mut mounts: Vec<Mount> = Vec::new();
    for body in assembly.bodies() {
        if mounts.contains(&body.mount) {
            continue;
        }
        mounts.push(body.mount);
        let mut bounding = MountBounding {
            assembly,
            guard,
            mount: body.mount,
            rectangles: &mut rectangles,
        };
        match body.mount.servos()[..] {
            [] => bounding.run([]),
            [a] => bounding.run([a]),
            [a, b] => bounding.run([a, b]),
            _ => bounding.run([0, 1, 2, 3]),
        }
    }
    rectangles
}

/// True if two rectangles are at least `min_mm` apart.
pub fn are_apart(a: &Rectangle, b: &Rectangle, min_mm: f64) -> bool {
    let mut sides = a.iter().zip(b);
    sides.any(|(a, b)| a.low - b.high >= min_mm || b.low - a.high >= min_mm)
}

/// The computation of the rectangles of the bodies on one mount.
struct MountBounding<'a> {
    assembly: &'a Assembly,
    guard: &'a Guard<'a>,
    mount: Mount,
    rectangles: &'a mut [Rectangle],
}

impl MountBounding<'_> {
    fn run<const N: usize>(&mut self, servos: [usize; N]) {
        let ranges = servos.map(|servo| self.guard.ranges[servo]);
        let mut regions = vec![Region::from_bounds(ranges)];
        while let Some(region) = regions.pop() {
            let Some((bounds, _)) = self.guard.bound_cranks(&servos, &region) else {
                continue;
            };
            let widest_index =
                (0..N).max_by(|a, b| region.half_widths[*a].total_cmp(&region.half_widths[*b]));
            match widest_index {
                Some(index) if region.half_widths[index] > MIN_HALF_WIDTH_DEG => {
                    regions.extend(region.halves(index));
                }
                _ => {
                    let placement = self.assembly.placement_for_cranks(self.mount, &bounds);
                    self.extend_rectangles(|point| {
                        let position = placement.map(point);
                        [position.x.value, position.y.value]
                    });
                }
            }
        }
    }

    /// Extends the rectangle of each body on the mount to enclose the bounds of the body's points.
    fn extend_rectangles(&mut self, bound_point: impl Fn(Vector) -> Rectangle) {
        let bodies = self.assembly.bodies().iter();
        let bodies = bodies.zip(self.rectangles.iter_mut());
        for (body, rectangle) in bodies.filter(|(body, _)| body.mount == self.mount) {
            for (point, radius) in list_points(body) {
                for (side, bounds) in rectangle.iter_mut().zip(bound_point(point)) {
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
