//! The pairs of shapes that must stay clear of each other, grouped by mounts.
//!
//! A layer is the union of its shapes minus its holes. A shape is clear of a layer if it is beside the layer's
//! shapes, or within one of its holes, as a pin is. The larger of the two distances counts.

use lizard_kinematics::Vector;

use super::guard::{Guard, Region};
use super::slope::Slope;
use super::{MIN_GAP_MM, TOUCH, sweep};
use crate::bodies::assembly::Assembly;
use crate::layers::body::{Body, Mount, Prism};
use crate::layers::placement::Placement;
use crate::layers::shape::Shape;

/// Tolerance within which heights count as equal, mm.
const SAME_HEIGHT_MM: f64 = 1e-6;

/// A pair of shapes of two bodies.
#[derive(Clone, Debug)]
pub struct ShapePair {
    /// The bodies, by their index in [`Assembly::bodies`].
    pub bodies: [usize; 2],
    /// Vertical gap between the shapes, mm; 0 if their heights overlap.
    gap: f64,
    /// The first shape, in the first mount's frame.
    first: Shape,
    /// The second shape, in the second mount's frame.
    second: Shape,
    /// Enclosing discs of both shapes: centre and radius.
    discs: [(Vector, f64); 2],
    /// Largest distance of the second shape's points from the origin of its frame, mm.
    lever: f64,
    /// Holes of the second shape's layer that may hold the first shape.
    holes_for_first: Vec<Shape>,
    /// Holes of the first shape's layer that may hold the second shape.
    holes_for_second: Vec<Shape>,
}

/// The pairs of shapes on two mounts.
#[derive(Clone, Debug)]
pub struct Task {
    pub mounts: [Mount; 2],
    /// True if the pairs are designed to touch.
    pub may_touch: bool,
    pub shape_pairs: Vec<ShapePair>,
}

impl Task {
    /// Least distance that the task's pairs must keep, mm.
    pub fn min_distance(&self) -> f64 {
        if self.may_touch { -TOUCH } else { MIN_GAP_MM }
    }

    /// The servos on which the relative placement of the two mounts depends.
    pub fn servos(&self) -> Vec<usize> {
        let mut all: Vec<_> = self
            .mounts
            .iter()
            .flat_map(|mount| mount.servos())
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The tasks of a robot: all pairs of bodies whose heights, and whose rectangles that they never leave, are less
    /// than `within` mm apart. Bodies that are designed to touch are paired only if their heights overlap.
    pub fn all(
        assembly: &Assembly,
        guard: &Guard,
        within: f64,
        which: impl Fn(&Body, &Body) -> bool,
    ) -> Vec<Self> {
        let mut tasks: Vec<Self> = Vec::new();
        let rectangles = sweep::body_rectangles(assembly, guard);
        let bodies = assembly.bodies();
        for (i, a) in bodies.iter().enumerate() {
            for (j, b) in bodies.iter().enumerate().skip(i + 1) {
                let is_apart = || sweep::are_apart(&rectangles[i], &rectangles[j], within);
                if a.mount == b.mount || !which(a, b) || is_apart() {
                    continue;
                }
                let meet = assembly.may_touch(a, b);
                let within = if meet { 0.0 } else { within };
                let shape_pairs = shape_pairs(i, a, j, b, within);
                if shape_pairs.is_empty() {
                    continue;
                }
                let mounts = [a.mount, b.mount];
                let is_same = |task: &&mut Self| task.mounts == mounts && task.may_touch == meet;
                match tasks.iter_mut().find(is_same) {
                    Some(task) => task.shape_pairs.extend(shape_pairs),
                    None => tasks.push(Self {
                        mounts,
                        may_touch: meet,
                        shape_pairs,
                    }),
                }
            }
        }
        tasks
    }
}

/// The pairs of shapes of two bodies whose heights are less than `within` mm apart.
fn shape_pairs(i: usize, a: &Body, j: usize, b: &Body, within: f64) -> Vec<ShapePair> {
    let mut shape_pairs = Vec::new();
    for p in &a.prisms {
        for q in &b.prisms {
            let gap = (p.z[0] - q.z[1]).max(q.z[0] - p.z[1]);
            if gap > within - SAME_HEIGHT_MM {
                continue;
            }
            let gap = if gap < -SAME_HEIGHT_MM {
                0.0
            } else {
                gap.max(SAME_HEIGHT_MM)
            };
            for first in &p.filled_shapes {
                for second in &q.filled_shapes {
                    shape_pairs.push(ShapePair {
                        bodies: [i, j],
                        gap,
                        first: first.clone(),
                        second: second.clone(),
                        discs: [first, second].map(|shape| {
                            let middle = shape.middle();
                            (middle, shape.farthest(middle))
                        }),
                        lever: second.farthest(Vector::default()) - second.radius,
                        holes_for_first: holes(q, first),
                        holes_for_second: holes(p, second),
                    });
                }
            }
        }
    }
    shape_pairs
}

/// The holes of a layer that are at least as wide as a shape.
fn holes(prism: &Prism, shape: &Shape) -> Vec<Shape> {
    let large = |hole: &&Shape| hole.width() >= shape.width();
    prism.cut_shapes.iter().filter(large).cloned().collect()
}

impl ShapePair {
    /// True if the shapes are certainly at least `by` mm apart while the second shape's frame moves by up to `moves`
    /// mm and the tips of its unit axes by up to `turns`. It is a quick test: false does not mean that the shapes are
    /// near.
    pub fn is_far(&self, place: &Placement, [moves, turns]: [f64; 2], by: f64) -> bool {
        let [(a, reach), (b, other)] = self.discs;
        let between = (place.map(b) - a).length() - reach - other;
        // When the frame turns, a point moves along both axes.
        between - moves - 2.0 * turns * self.lever >= by
    }

    /// The gap of a pinned pair, mm, which is constant: a pin in the centre of a round hole, or a disc whose centre
    /// is fixed in the other shape's frame, in all of `places`. `None` if the pair is not pinned.
    pub fn pinned_gap(&self, places: &[Placement]) -> Option<f64> {
        /// A bound of the rounding error of a joint's position, mm.
        const ROUNDING_MM: f64 = 1e-6;
        let centre = |shape: &Shape| match shape.points[..] {
            [centre] => Some(centre),
            _ => None,
        };
        let stays = |first: Vector, second: Vector| {
            let error = |place: &Placement| (place.map(second) - first).length();
            places.iter().all(|place| error(place) < ROUNDING_MM)
        };
        let air = |pin: &Shape, holes: &[Shape], stays: &dyn Fn(Vector, Vector) -> bool| {
            let middle = centre(pin)?;
            let around = |hole: &&Shape| centre(hole).is_some_and(|hole| stays(middle, hole));
            let holes = holes.iter().filter(around);
            holes.map(|hole| hole.radius - pin.radius).reduce(f64::max)
        };
        let beside = |middle: Vector, radius: f64, other: &Shape, holes: &[Shape]| {
            let disc = Shape::disc(middle, radius);
            let within = holes
                .iter()
                .map(|hole| disc.depth_in(hole, Vector::default()));
            within.fold(disc.distance(other), f64::max)
        };
        let (first, second) = (&self.first, &self.second);
        let (place, around) = (
            places.first()?,
            [&self.holes_for_first, &self.holes_for_second],
        );
        air(first, around[0], &stays)
            .or_else(|| air(second, around[1], &|second, first| stays(first, second)))
            .or_else(|| {
                let (own, middle) = (centre(first)?, place.unmap(centre(first)?));
                let clear = || beside(middle, first.radius, second, around[0]);
                stays(own, middle).then(clear)
            })
            .or_else(|| {
                let (own, middle) = (centre(second)?, place.map(centre(second)?));
                let clear = || beside(middle, second.radius, first, around[1]);
                stays(middle, own).then(clear)
            })
            .map(|air| self.with_gap(air))
    }

    /// The distance of two shapes, mm, from their distance in plan view.
    fn with_gap(&self, flat: f64) -> f64 {
        match self.gap > 0.0 {
            true => flat.max(0.0).hypot(self.gap),
            false => flat,
        }
    }

    /// The distance of the two shapes, mm, negative if they overlap; `place` is the second shape's frame in the first
    /// shape's frame.
    pub fn distance(&self, place: &Placement) -> f64 {
        self.lower_bound(place, |_| Vector::default())
    }

    /// Lower bound of the shapes' distance in a region, mm, from their relative placement at the region's middle and
    /// the largest motion of each point in the region.
    pub fn distance_bound<const N: usize>(
        &self,
        place: &Placement,
        bounds: &Placement<Slope<N>>,
        region: &Region<N>,
    ) -> f64 {
        const ANYWHERE: Vector = Vector::new(f64::INFINITY, f64::INFINITY);
        self.lower_bound(place, |shape| {
            let strays = shape.points.iter().map(|&point| {
                let position = bounds.map(point);
                Vector::new(
                    position.x.largest_change(&region.half),
                    position.y.largest_change(&region.half),
                )
            });
            strays.fold(Vector::default(), |max, stray| match stray.is_finite() {
                true => Vector::new(max.x.max(stray.x), max.y.max(stray.y)),
                false => ANYWHERE,
            })
        })
    }

    /// Lower bound of the shapes' distance, mm, while each point of the second shape moves along x and y by up to
    /// `largest_change`.
    fn lower_bound(&self, place: &Placement, largest_change: impl Fn(&Shape) -> Vector) -> f64 {
        let second = self.second.placed(place);
        let moves = largest_change(&self.second);
        let mut flat = self.first.distance(&second) - moves.length();
        if self.gap > 0.0 {
            return self.with_gap(flat);
        }
        for hole in &self.holes_for_first {
            // A hole that moves has the same effect as a pin that moves.
            flat = flat.max(
                self.first
                    .depth_in(&hole.placed(place), largest_change(hole)),
            );
        }
        for hole in &self.holes_for_second {
            flat = flat.max(second.depth_in(hole, moves));
        }
        flat
    }
}
