//! The pairs of shapes that must stay clear of each other, grouped by mounts.
//!
//! A layer is the union of its shapes minus its holes. A shape is clear of a layer if it is beside the layer's shapes
//! or, like a pin, inside one of the layer's holes. The larger of the two distances counts.

use lizard_kinematics::Vector;

use super::bounding_rectangles::{are_apart, compute_bounding_rectangles};
use super::guard::{Region, RelaxedGuard};
use super::interval_dual::IntervalDual;
use super::{MIN_GAP_MM, TOUCH_OVERLAP};
use crate::bodies::assembly::Assembly;
use crate::layers::body::{Body, Mount, Prism};
use crate::layers::placement::Placement;
use crate::layers::shape::Shape;

/// Tolerance within which heights count as equal, mm.
const SAME_HEIGHT_MM: f64 = 1e-6;

/// A pair of shapes of two bodies.
#[derive(Clone, Debug)]
pub struct ShapePair {
    /// Bodies, as indices in [`Assembly::bodies`].
    pub bodies: [usize; 2],
    /// Vertical gap between the shapes, mm; 0 if their heights overlap.
    height_gap: f64,
    /// First shape, frame of the first mount.
    first: Shape,
    /// Second shape, frame of the second mount.
    second: Shape,
    /// Enclosing discs of both shapes: centre and radius.
    discs: [(Vector, f64); 2],
    /// Largest distance between the second shape's points and the origin of its frame, mm.
    lever_arm: f64,
    /// Holes of the second shape's layer that may hold the first shape.
    holes_for_first: Vec<Shape>,
    /// Holes of the first shape's layer that may hold the second shape.
    holes_for_second: Vec<Shape>,
}

/// The pairs of shapes on two mounts.
#[derive(Clone, Debug)]
pub struct Task {
    /// The two mounts, in the order of the pairs' shapes.
    pub mounts: [Mount; 2],
    /// True if the pairs are designed to touch.
    pub may_touch: bool,
    /// Pairs, each with a shape on either mount.
    pub shape_pairs: Vec<ShapePair>,
}

impl Task {
    /// Smallest allowed distance between the shapes of each pair, mm; negative if they are designed to touch.
    pub fn required_gap(&self) -> f64 {
        match self.may_touch {
            true => -TOUCH_OVERLAP,
            false => MIN_GAP_MM,
        }
    }

    /// Lists the servos on which the relative placement of the two mounts depends.
    pub fn servos(&self) -> Vec<usize> {
        let mut servos = self.mounts.map(Mount::servos).concat();
        servos.sort_unstable();
        servos.dedup();
        servos
    }

    /// Collects the tasks of a robot: all pairs of bodies that are less than `max_gap_mm` apart both in height and
    /// between the rectangles that they never leave. Bodies designed to touch are paired only if their heights overlap.
    pub fn collect(
        assembly: &Assembly,
        guard: &RelaxedGuard,
        max_gap_mm: f64,
        is_chosen: impl Fn(&Body, &Body) -> bool,
    ) -> Vec<Self> {
        let mut tasks: Vec<Self> = Vec::new();
        let rectangles = compute_bounding_rectangles(assembly, guard);
        let bodies = assembly.bodies();
        for (i, a) in bodies.iter().enumerate() {
            for (j, b) in bodies.iter().enumerate().skip(i + 1) {
                let is_apart = || are_apart(&rectangles[i], &rectangles[j], max_gap_mm);
                if a.mount == b.mount || !is_chosen(a, b) || is_apart() {
                    continue;
                }
                let may_touch = assembly.may_touch(a, b);
                let max_gap_mm = if may_touch { 0.0 } else { max_gap_mm };
                let shape_pairs = pair_shapes(i, a, j, b, max_gap_mm);
                if shape_pairs.is_empty() {
                    continue;
                }
                let mounts = [a.mount, b.mount];
                let has_same_mounts =
                    |task: &&mut Self| task.mounts == mounts && task.may_touch == may_touch;
                match tasks.iter_mut().find(has_same_mounts) {
                    Some(task) => task.shape_pairs.extend(shape_pairs),
                    None => tasks.push(Self {
                        mounts,
                        may_touch,
                        shape_pairs,
                    }),
                }
            }
        }
        tasks
    }
}

/// Pairs the shapes of the bodies `a` and `b`, which have the indices `i` and `j`, if their heights are less than
/// `max_gap_mm` apart.
fn pair_shapes(i: usize, a: &Body, j: usize, b: &Body, max_gap_mm: f64) -> Vec<ShapePair> {
    let mut shape_pairs = Vec::new();
    for p in &a.prisms {
        for q in &b.prisms {
            let height_gap = (p.z[0] - q.z[1]).max(q.z[0] - p.z[1]);
            if height_gap > max_gap_mm - SAME_HEIGHT_MM {
                continue;
            }
            let clamped_height_gap = match height_gap < -SAME_HEIGHT_MM {
                true => 0.0,
                false => height_gap.max(SAME_HEIGHT_MM),
            };
            for first in &p.filled_shapes {
                for second in &q.filled_shapes {
                    shape_pairs.push(ShapePair {
                        bodies: [i, j],
                        height_gap: clamped_height_gap,
                        first: first.clone(),
                        second: second.clone(),
                        discs: [first, second].map(|shape| {
                            let middle = shape.middle();
                            (middle, shape.max_distance_from(middle))
                        }),
                        lever_arm: second.max_distance_from(Vector::default()) - second.radius,
                        holes_for_first: select_holes(q, first),
                        holes_for_second: select_holes(p, second),
                    });
                }
            }
        }
    }
    shape_pairs
}

/// Selects the holes of a layer that are at least as wide as a shape.
fn select_holes(prism: &Prism, shape: &Shape) -> Vec<Shape> {
    let holes = prism.cut_shapes.iter();
    let large_holes = holes.filter(|hole| hole.diameter() >= shape.diameter());
    large_holes.cloned().collect()
}

impl ShapePair {
    /// True if the shapes are certainly at least `min_mm` apart even if the second shape's frame deviates from
    /// `placement`: its origin by up to the first of `max_deviations`, mm, and the tips of its unit axes by up to the
    /// second. This test is quick: false does not mean close.
    pub fn is_far(&self, placement: &Placement, max_deviations: [f64; 2], min_mm: f64) -> bool {
        let [(a, a_radius), (b, b_radius)] = self.discs;
        let [origin_deviation, axis_deviation] = max_deviations;
        let gap = (placement.map(b) - a).length() - a_radius - b_radius;
        // When the frame turns, a point moves along both axes.
        gap - origin_deviation - 2.0 * axis_deviation * self.lever_arm >= min_mm
    }

    /// Computes the constant gap of a pinned pair, mm: a pin in the centre of a round hole, or a disc whose centre is
    /// fixed in the other shape's frame at all `placements`. `None` if the pair is not pinned.
    pub fn compute_pinned_gap(&self, placements: &[Placement]) -> Option<f64> {
        /// Upper bound of a joint position's rounding error, mm.
        const ROUNDING_MM: f64 = 1e-6;
        let disc_centre = |shape: &Shape| match shape.points[..] {
            [centre] => Some(centre),
            _ => None,
        };
        let keeps_position = |first: Vector, second: Vector| {
            let error_at = |placement: &Placement| (placement.map(second) - first).length();
            let mut placements = placements.iter();
            placements.all(|placement| error_at(placement) < ROUNDING_MM)
        };
        let gap_in_hole = |pin: &Shape, holes: &[Shape], stays: &dyn Fn(Vector, Vector) -> bool| {
            let middle = disc_centre(pin)?;
            let is_around =
                |hole: &&Shape| disc_centre(hole).is_some_and(|hole| stays(middle, hole));
            let holes = holes.iter().filter(is_around);
            holes.map(|hole| hole.radius - pin.radius).reduce(f64::max)
        };
        let gap_beside = |middle: Vector, radius: f64, other: &Shape, holes: &[Shape]| {
            let disc = Shape::disc(middle, radius);
            let depths = holes
                .iter()
                .map(|hole| disc.depth_in(hole, Vector::default()));
            depths.fold(disc.distance(other), f64::max)
        };
        let (first, second) = (&self.first, &self.second);
        let placement = placements.first()?;
        let holes = [&self.holes_for_first, &self.holes_for_second];
        gap_in_hole(first, holes[0], &keeps_position)
            .or_else(|| {
                gap_in_hole(second, holes[1], &|second, first| {
                    keeps_position(first, second)
                })
            })
            .or_else(|| {
                let (own_centre, other_centre) =
                    (disc_centre(first)?, placement.unmap(disc_centre(first)?));
                let gap = || gap_beside(other_centre, first.radius, second, holes[0]);
                keeps_position(own_centre, other_centre).then(gap)
            })
            .or_else(|| {
                let (own_centre, other_centre) =
                    (disc_centre(second)?, placement.map(disc_centre(second)?));
                let gap = || gap_beside(other_centre, second.radius, first, holes[1]);
                keeps_position(other_centre, own_centre).then(gap)
            })
            .map(|gap| self.spatial_distance(gap))
    }

    /// Computes the shapes' distance from their distance in plan view, mm.
    fn spatial_distance(&self, plan_distance: f64) -> f64 {
        match self.height_gap > 0.0 {
            true => plan_distance.max(0.0).hypot(self.height_gap),
            false => plan_distance,
        }
    }

    /// Computes the shapes' distance, mm; negative if they overlap. `placement` is the second frame in the first frame.
    pub fn distance(&self, placement: &Placement) -> f64 {
        self.lower_bound(placement, |_| Vector::default())
    }

    /// Computes a lower bound of the shapes' distance in a region, mm, from their relative placement at the region's
    /// middle and the largest displacement of each point in the region.
    pub fn distance_bound<const N: usize>(
        &self,
        placement: &Placement,
        bounds: &Placement<IntervalDual<N>>,
        region: &Region<N>,
    ) -> f64 {
        const ANYWHERE: Vector = Vector::new(f64::INFINITY, f64::INFINITY);
        let max_change = |coordinate: IntervalDual<N>| coordinate.max_change(&region.half_widths);
        self.lower_bound(placement, |shape| {
            let changes = shape.points.iter().map(|&point| {
                let position = bounds.map(point);
                Vector::new(max_change(position.x), max_change(position.y))
            });
            changes.fold(Vector::default(), |max, change| match change.is_finite() {
                true => Vector::new(max.x.max(change.x), max.y.max(change.y)),
                false => ANYWHERE,
            })
        })
    }

    /// Computes a lower bound of the shapes' distance, mm, if each point of the second shape moves along x and y by at
    /// most `max_displacement`.
    fn lower_bound(
        &self,
        placement: &Placement,
        max_displacement: impl Fn(&Shape) -> Vector,
    ) -> f64 {
        let second = self.second.placed(placement);
        let displacement = max_displacement(&self.second);
        let mut distance = self.first.distance(&second) - displacement.length();
        if self.height_gap > 0.0 {
            return self.spatial_distance(distance);
        }
        for hole in &self.holes_for_first {
            // A moving hole has the same effect as a moving pin.
            let placed_hole = hole.placed(placement);
            distance = distance.max(self.first.depth_in(&placed_hole, max_displacement(hole)));
        }
        for hole in &self.holes_for_second {
            distance = distance.max(second.depth_in(hole, displacement));
        }
        distance
    }
}
