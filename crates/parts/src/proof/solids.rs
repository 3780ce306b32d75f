//! What has to keep clear of what, sorted by what it moves with.
//!
//! A layer is what its shapes cover and no hole takes away. A shape is clear of a layer
//! if it is beside the layer's shapes, or within one of its holes, as a pin is. The
//! larger of the two distances counts.

use lizard_kinematics::Vector;

use super::guard::{Guard, Region};
use super::slope::Slope;
use super::{LEAST, TOUCH, sweep};
use crate::bodies::assembly::Assembly;
use crate::layers::body::{Body, Mount, Prism};
use crate::layers::placement::Placement;
use crate::layers::shape::Shape;

/// Heights that differ by less are the same, mm.
const SAME: f64 = 1e-6;

/// Two shapes of two bodies.
#[derive(Clone, Debug)]
pub struct Solid {
    /// The bodies, by their places in [`Assembly::bodies`].
    pub bodies: [usize; 2],
    /// Air between their heights, mm; 0 where they share one.
    gap: f64,
    /// In the first mount's frame.
    first: Shape,
    /// In the second mount's frame.
    second: Shape,
    /// Discs that hold the two: middle and radius.
    discs: [(Vector, f64); 2],
    /// How far the second's points are from its frame's origin, mm.
    lever: f64,
    /// Holes of the second's layer that may hold the first.
    around_first: Vec<Shape>,
    /// Holes of the first's layer that may hold the second.
    around_second: Vec<Shape>,
}

/// Everything that moves with one mount, and everything that moves with another.
#[derive(Clone, Debug)]
pub struct Task {
    pub mounts: [Mount; 2],
    /// Whether these are pairs that are made to meet.
    pub meet: bool,
    pub solids: Vec<Solid>,
}

impl Task {
    /// Nearer than this its parts must not come, mm.
    pub fn least(&self) -> f64 {
        if self.meet { -TOUCH } else { LEAST }
    }

    /// The servos that decide how the two stand to each other.
    pub fn servos(&self) -> Vec<usize> {
        let mut all: Vec<_> = self.mounts.iter().flat_map(|of| of.servos()).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Everything that is to be asked of a robot: pairs of bodies whose heights are
    /// less than `within` mm apart, and whose rectangles are.
    pub fn all(
        assembly: &Assembly,
        guard: &Guard,
        within: f64,
        which: impl Fn(&Body, &Body) -> bool,
    ) -> Vec<Self> {
        let mut tasks: Vec<Self> = Vec::new();
        let rectangles = sweep::all(assembly, guard);
        let bodies = assembly.bodies();
        for (i, a) in bodies.iter().enumerate() {
            for (j, b) in bodies.iter().enumerate().skip(i + 1) {
                let away = || sweep::apart(&rectangles[i], &rectangles[j], within);
                if a.mount == b.mount || !which(a, b) || away() {
                    continue;
                }
                let meet = assembly.meet(a, b);
                let within = if meet { 0.0 } else { within };
                let solids = solids(i, a, j, b, within);
                if solids.is_empty() {
                    continue;
                }
                let mounts = [a.mount, b.mount];
                let known = tasks
                    .iter_mut()
                    .find(|task| task.mounts == mounts && task.meet == meet);
                match known {
                    Some(task) => task.solids.extend(solids),
                    None => tasks.push(Self {
                        mounts,
                        meet,
                        solids,
                    }),
                }
            }
        }
        tasks
    }
}

fn solids(i: usize, a: &Body, j: usize, b: &Body, within: f64) -> Vec<Solid> {
    let mut solids = Vec::new();
    for p in &a.prisms {
        for q in &b.prisms {
            let gap = (p.z[0] - q.z[1]).max(q.z[0] - p.z[1]);
            if gap > within - SAME {
                continue;
            }
            let gap = if gap < -SAME { 0.0 } else { gap.max(SAME) };
            for first in &p.add {
                for second in &q.add {
                    solids.push(Solid {
                        bodies: [i, j],
                        gap,
                        first: first.clone(),
                        second: second.clone(),
                        discs: [first, second].map(|shape| {
                            let middle = shape.middle();
                            (middle, shape.farthest(middle))
                        }),
                        lever: second.farthest(Vector::default()) - second.radius,
                        around_first: holes(q, first),
                        around_second: holes(p, second),
                    });
                }
            }
        }
    }
    solids
}

/// The holes of a layer that are large enough for a shape.
fn holes(prism: &Prism, shape: &Shape) -> Vec<Shape> {
    let large = |hole: &&Shape| hole.width() >= shape.width();
    prism.cut.iter().filter(large).cloned().collect()
}

impl Solid {
    /// Whether the two are `by` mm apart or more, wherever the second's points are if
    /// its frame strays by `moves` mm and its axes' ends by `turns`; quickly, so it may
    /// say no where they are.
    pub fn far(&self, place: &Placement, [moves, turns]: [f64; 2], by: f64) -> bool {
        let [(a, reach), (b, other)] = self.discs;
        let between = (place.map(b) - a).length() - reach - other;
        // Turned, a point strays along both axes.
        between - moves - 2.0 * turns * self.lever >= by
    }

    /// The air around a pin that is in the middle of a round hole at every one of some
    /// places, or beside a disc whose middle stays where it is in the other's frame, mm;
    /// `None` if neither is so. A linkage that closes keeps it there.
    pub fn pinned(&self, places: &[Placement]) -> Option<f64> {
        /// Beyond the rounding of a joint's place, mm.
        const SAME: f64 = 1e-6;
        let centre = |shape: &Shape| match shape.points[..] {
            [centre] => Some(centre),
            _ => None,
        };
        let stays = |first: Vector, second: Vector| {
            let off = |place: &Placement| (place.map(second) - first).length();
            places.iter().all(|place| off(place) < SAME)
        };
        let air = |pin: &Shape, holes: &[Shape], stays: &dyn Fn(Vector, Vector) -> bool| {
            let middle = centre(pin)?;
            let around = |hole: &&Shape| centre(hole).is_some_and(|hole| stays(middle, hole));
            let holes = holes.iter().filter(around);
            holes.map(|hole| hole.radius - pin.radius).reduce(f64::max)
        };
        let beside = |disc: &Shape, other: &Shape, holes: &[Shape]| {
            let within = holes
                .iter()
                .map(|hole| disc.within(hole, Vector::default()));
            within.fold(disc.distance(other), f64::max)
        };
        air(&self.first, &self.around_first, &stays)
            .or_else(|| {
                let stays = |second, first| stays(first, second);
                air(&self.second, &self.around_second, &stays)
            })
            .or_else(|| {
                let middle = places.first()?.unmap(centre(&self.first)?);
                let disc = Shape::disc(middle, self.first.radius);
                let clear = || beside(&disc, &self.second, &self.around_first);
                stays(centre(&self.first)?, middle).then(clear)
            })
            .or_else(|| {
                let middle = places.first()?.map(centre(&self.second)?);
                let disc = Shape::disc(middle, self.second.radius);
                let clear = || beside(&disc, &self.first, &self.around_second);
                stays(middle, centre(&self.second)?).then(clear)
            })
            .map(|air| {
                if self.gap > 0.0 {
                    air.max(0.0).hypot(self.gap)
                } else {
                    air
                }
            })
    }

    /// How far the two are apart, mm, where the second's frame is at a place in the
    /// first's; below 0 they overlap.
    pub fn apart(&self, place: &Placement) -> f64 {
        self.at_least(place, |_| Vector::default())
    }

    /// Their least distance in a region, from where they are in its
    /// middle and how far each point can stray from there.
    pub fn apart_within<const N: usize>(
        &self,
        place: &Placement,
        bounds: &Placement<Slope<N>>,
        region: &Region<N>,
    ) -> f64 {
        self.at_least(place, |shape| {
            let mut most: Vector = Vector::default();
            for &point in &shape.points {
                let at = bounds.map(point);
                let strays = Vector::new(at.x.strays(&region.half), at.y.strays(&region.half));
                if !strays.is_finite() {
                    return Vector::new(f64::INFINITY, f64::INFINITY);
                }
                most = Vector::new(most.x.max(strays.x), most.y.max(strays.y));
            }
            most
        })
    }

    fn at_least(&self, place: &Placement, strays: impl Fn(&Shape) -> Vector) -> f64 {
        let second = self.second.placed(place);
        let moves = strays(&self.second);
        let mut flat = self.first.distance(&second) - moves.length();
        if self.gap > 0.0 {
            return flat.max(0.0).hypot(self.gap);
        }
        for hole in &self.around_first {
            // It is the same whether the hole strays or what is in it.
            flat = flat.max(self.first.within(&hole.placed(place), strays(hole)));
        }
        for hole in &self.around_second {
            flat = flat.max(second.within(hole, moves));
        }
        flat
    }
}
