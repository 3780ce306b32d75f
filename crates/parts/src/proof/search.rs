//! Branch and bound: the least distance in a region, with proof.
//!
//! The region is halved again and again, always where the distance may be least. In
//! each part the distance in the middle, less what all points can move from there, is
//! less than every distance in the part; the distance at any pose is no less than the
//! least one. Where both meet, the least distance is known.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use lizard_kinematics::{Solution, Vector};

use super::guard::{Guard, Region, middle, within};
use super::slope::Slope;
use super::solids::Task;
use crate::bodies::assembly::Assembly;
use crate::layers::placement::Placement;

/// More air than this is not measured, mm.
pub const ENOUGH: f64 = 2.0;
/// Beyond the rounding of a distance in floating point, mm.
const ROUNDING: f64 = 1e-6;
/// How near the bounds from below and above come, mm, and as a share.
const NEAR: f64 = 0.01;
const SHARE: f64 = 0.05;
/// The share of what is made to meet: that it has air is all that counts.
const SHARE_MEETING: f64 = 0.5;
/// Regions narrower than this are not halved, deg.
const NARROW: f64 = 0.002;
/// The most regions that are checked.
pub const MANY: u64 = 100_000;
/// The same once an overlap is known: its exact depth does not change the result.
const FEW: u64 = 1_000;

/// What is known of the least distance.
#[derive(Clone, Debug)]
pub struct Found {
    /// It is at least this, mm; never more than [`ENOUGH`].
    pub proved: f64,
    /// Between these bodies.
    pub bodies: [usize; 2],
    /// A pose that the guard accepts, and the distance there, mm.
    pub seen: Option<(Solution, f64)>,
    /// In the middle of the region where no more is proved, if that is less than what
    /// was seen: angles of some servos, deg.
    pub doubt: Option<[Option<f64>; 4]>,
    /// Regions checked.
    pub regions: u64,
}

/// A region, and what may be near in it.
struct Part<const N: usize> {
    region: Region<N>,
    /// Of all distances in it, mm.
    low: f64,
    /// Which of the solids this is of.
    by: u32,
    /// Across which servo it is to be halved.
    across: usize,
    alive: Vec<u32>,
}

impl<const N: usize> PartialEq for Part<N> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<const N: usize> Eq for Part<N> {}

impl<const N: usize> PartialOrd for Part<N> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<const N: usize> Ord for Part<N> {
    /// The heap gives the greatest first, which is to be the least distance; equal ones
    /// in an order that is always the same.
    fn cmp(&self, other: &Self) -> Ordering {
        let places = |part: &Self| part.region.middle;
        other.low.total_cmp(&self.low).then_with(|| {
            let pairs = places(self).into_iter().zip(places(other));
            pairs.fold(Ordering::Equal, |order, (a, b)| order.then(a.total_cmp(&b)))
        })
    }
}

/// The least distance of a task's solids over all poses that the guard accepts, from
/// this many regions at `most`.
pub fn least(assembly: &Assembly, guard: &Guard, task: &Task, most: u64) -> Found {
    let servos = task.servos();
    match servos[..] {
        [] => Search::new(assembly, guard, task, []).run(most),
        [a] => Search::new(assembly, guard, task, [a]).run(most),
        [a, b] => Search::new(assembly, guard, task, [a, b]).run(most),
        [a, b, c] => Search::new(assembly, guard, task, [a, b, c]).run(most),
        _ => Search::new(assembly, guard, task, [0, 1, 2, 3]).run(most),
    }
}

struct Search<'a, const N: usize> {
    assembly: &'a Assembly,
    guard: &'a Guard<'a>,
    task: &'a Task,
    servos: [usize; N],
    /// The nearest that was seen, and by which solid.
    seen: Option<(Solution, f64)>,
    by: u32,
    regions: u64,
}

impl<'a, const N: usize> Search<'a, N> {
    fn new(
        assembly: &'a Assembly,
        guard: &'a Guard<'a>,
        task: &'a Task,
        servos: [usize; N],
    ) -> Self {
        Self {
            assembly,
            guard,
            task,
            servos,
            seen: None,
            by: 0,
            regions: 0,
        }
    }

    /// The nearest that was seen, or enough.
    fn high(&self) -> f64 {
        self.seen.as_ref().map_or(ENOUGH, |seen| seen.1.min(ENOUGH))
    }

    fn run(mut self, most: u64) -> Found {
        let whole = Region::of(self.servos.map(|servo| self.guard.ranges[servo]));
        let all: Vec<u32> = (0..self.task.solids.len() as u32).collect();
        let share = if self.task.meet { SHARE_MEETING } else { SHARE };
        let mut heap = BinaryHeap::new();
        heap.extend(self.look(whole, &all));
        while let Some(part) = heap.pop() {
            let high = self.high();
            if part.low >= high - NEAR - share * high.abs() {
                return self.found(part.low.min(high), None);
            }
            let most = if high < 0.0 { FEW } else { most };
            if part.region.half.iter().all(|half| *half < NARROW) || self.regions >= most {
                return self.found(part.low, Some(&part));
            }
            for half in part.region.halves(part.across) {
                heap.extend(self.look(half, &part.alive));
            }
        }
        let high = self.high();
        self.found(high, None)
    }

    fn found(self, proved: f64, doubt: Option<&Part<N>>) -> Found {
        let by = match (&self.seen, doubt) {
            (None, Some(part)) => part.by,
            _ => self.by,
        };
        Found {
            proved: proved - ROUNDING,
            bodies: self.task.solids[by as usize].bodies,
            doubt: doubt.map(|part| self.angles(&part.region)),
            seen: self.seen,
            regions: self.regions,
        }
    }

    /// The middle of a region, servo order.
    fn angles(&self, region: &Region<N>) -> [Option<f64>; 4] {
        let mut angles = [None; 4];
        for (servo, angle) in self.servos.iter().zip(region.middle) {
            angles[*servo] = Some(angle);
        }
        angles
    }

    /// Bounds a region's distances; `None` where nothing can be nearer than what was
    /// seen already, or the guard accepts no pose.
    fn look(&mut self, region: Region<N>, alive: &[u32]) -> Option<Part<N>> {
        self.regions += 1;
        let robot = self.assembly.robot();
        let bounds = within(robot, &self.servos, &region);
        let middle = middle(robot, &self.servos, &region);
        if self.guard.breaks(&self.servos, &region, &bounds, &middle) {
            return None;
        }
        // The first and the second mount's place: in the middle, and anywhere.
        let [(a, around_a), (b, around_b)] = self.task.mounts.map(|mount| {
            let place = self.assembly.place_on(mount, &middle);
            let bounds = self.assembly.place_on(mount, &bounds);
            (place, near(&bounds, &place, &region))
        });
        let place = b.seen_from(&a);
        let bounds = near(&around_b.seen_from(&around_a), &place, &region);
        let strays = |vector: &Vector<Slope<N>>| {
            vector
                .x
                .strays(&region.half)
                .hypot(vector.y.strays(&region.half))
        };
        let strays = [strays(&bounds.at), strays(&bounds.turn)];
        let mut part = Part {
            region,
            low: f64::INFINITY,
            by: 0,
            across: across(&bounds, &region),
            alive: Vec::new(),
        };
        let closed = place.at.is_finite() && place.turn.is_finite();
        let mut nearest = (f64::INFINITY, 0);
        for &index in alive {
            let solid = &self.task.solids[index as usize];
            let low = if !closed {
                f64::NEG_INFINITY
            } else if solid.far(&place, strays, self.high()) {
                continue;
            } else {
                let apart = solid.apart(&place);
                if apart < nearest.0 {
                    nearest = (apart, index);
                }
                let low = solid.apart_within(&place, &bounds, &region);
                if low.is_nan() { f64::NEG_INFINITY } else { low }
            };
            if low < self.high() {
                part.alive.push(index);
                if low < part.low {
                    (part.low, part.by) = (low, index);
                }
            }
        }
        if nearest.0 < self.high() - NEAR / 4.0
            && let Some(pose) = self.guard.pose(self.angles(&region))
        {
            self.seen = Some((pose, nearest.0));
            self.by = nearest.1;
        }
        (!part.alive.is_empty()).then_some(part)
    }
}

/// Bounds of a place that are no farther from its middle than it can stray.
fn near<const N: usize>(
    bounds: &Placement<Slope<N>>,
    middle: &Placement,
    region: &Region<N>,
) -> Placement<Slope<N>> {
    let each = |bounds: Vector<Slope<N>>, middle: Vector| {
        Vector::new(
            bounds.x.near(middle.x, &region.half),
            bounds.y.near(middle.y, &region.half),
        )
    };
    Placement {
        at: each(bounds.at, middle.at),
        turn: each(bounds.turn, middle.turn),
    }
}

/// The servo that a place depends on most.
fn across<const N: usize>(bounds: &Placement<Slope<N>>, region: &Region<N>) -> usize {
    /// A length at which a turn counts, mm.
    const LEVER: f64 = 30.0;
    let numbers = [
        bounds.at.x,
        bounds.at.y,
        bounds.turn.x * LEVER,
        bounds.turn.y * LEVER,
    ];
    let weight = |servo: usize| {
        let half = region.half[servo];
        numbers.iter().fold(0.0, |sum, number| {
            // Without a bound, the widest is halved.
            let strays = number.slope[servo].most() * half;
            sum + if strays.is_finite() {
                strays
            } else {
                half * 1e6
            }
        })
    };
    (0..N)
        .max_by(|a, b| weight(*a).total_cmp(&weight(*b)).then(b.cmp(a)))
        .unwrap_or(0)
}
