//! Branch and bound: the smallest distance in a region, with a proven lower bound.
//!
//! The search is best-first: it repeatedly halves the region with the smallest lower bound. The distance at a region's
//! middle minus the largest displacement of any point is a lower bound of all distances in the region. The distance at
//! any accepted pose is an upper bound of the smallest distance. The search ends when the two bounds are close.

use std::collections::BTreeMap;

use lizard_kinematics::{Solution, Vector};

use super::NearestPair;
use super::guard::{Region, RelaxedGuard, total_order_key};
use super::interval_dual::IntervalDual;
use super::shape_pairs::Task;
use crate::bodies::assembly::Assembly;
use crate::layers::placement::Placement;

/// Distance beyond which parts count as far apart and are not measured, mm.
pub const FAR_MM: f64 = 2.0;
/// Upper bound of a distance's rounding error, mm.
const ROUNDING_MM: f64 = 1e-6;
/// Absolute part of the difference between the bounds at which the search ends, mm.
const TOLERANCE_MM: f64 = 0.01;
/// Relative part of the difference at which the search ends, as a fraction of the distance.
const RELATIVE_TOLERANCE: f64 = 0.05;
/// Relative part of the difference for parts designed to touch, for which only the sign of the gap matters.
const TOUCHING_RELATIVE_TOLERANCE: f64 = 0.5;
/// Half width below which a region is not halved, deg.
const MIN_HALF_WIDTH_DEG: f64 = 0.002;
/// Largest number of regions to check.
pub const MAX_REGIONS: u64 = 100_000;
/// Largest number of regions to check once an overlap is found, whose exact depth does not matter.
const MAX_REGIONS_OVERLAPPING: u64 = 1_000;

/// A pose that the guard accepts, and the nearest two shapes at this pose.
struct NearestPose {
    pose: Solution,
    /// Distance between the two shapes, mm.
    mm: f64,
    /// Index of the pair of shapes.
    shape_pair: u32,
}

/// A region, and the pairs of shapes that may be near each other in it.
struct BoundedRegion<const N: usize> {
    region: Region<N>,
    /// Lower bound of all distances in the region, mm.
    lower_bound: f64,
    /// Index of the pair of shapes with the bound `lower_bound`.
    bounding_pair: u32,
    /// Servo across whose angle the region will be halved.
    split_servo: usize,
    /// Indices of the pairs of shapes that may come closer than the smallest distance found.
    candidate_pairs: Vec<u32>,
}

/// Finds the nearest bodies of a task over all poses that the guard accepts, and the number of checked regions. Stops
/// after `max_regions` regions.
pub fn find_nearest_pair(
    assembly: &Assembly,
    guard: &RelaxedGuard,
    task: &Task,
    max_regions: u64,
) -> (NearestPair, u64) {
    match task.servos()[..] {
        [] => search(assembly, guard, task, [], max_regions),
        [a] => search(assembly, guard, task, [a], max_regions),
        [a, b] => search(assembly, guard, task, [a, b], max_regions),
        [a, b, c] => search(assembly, guard, task, [a, b, c], max_regions),
        _ => search(assembly, guard, task, [0, 1, 2, 3], max_regions),
    }
}

/// Finds the nearest bodies over all poses of `servos`.
fn search<const N: usize>(
    assembly: &Assembly,
    guard: &RelaxedGuard,
    task: &Task,
    servos: [usize; N],
    max_regions: u64,
) -> (NearestPair, u64) {
    let mut search = Search {
        assembly,
        guard,
        task,
        servos,
        nearest: None,
        region_count: 0,
    };
    let all_poses = Region::from_bounds(servos.map(|servo| guard.ranges[servo]));
    let all_pairs: Vec<u32> = (0..task.shape_pairs.len() as u32).collect();
    let relative_tolerance = match task.may_touch {
        true => TOUCHING_RELATIVE_TOLERANCE,
        false => RELATIVE_TOLERANCE,
    };
    // The region with the smallest bound comes first. Regions with equal bounds are ordered by their middles, so the
    // order is deterministic.
    let with_order_key = |bounded_region: BoundedRegion<N>| {
        let bound_key = total_order_key(bounded_region.lower_bound);
        let middle_key = bounded_region.region.middle.map(total_order_key);
        ((bound_key, middle_key), bounded_region)
    };
    let first_region = search.bound_region(all_poses, &all_pairs);
    let mut open_regions = BTreeMap::from_iter(first_region.map(with_order_key));
    while let Some((_, bounded_region)) = open_regions.pop_first() {
        let upper_bound = search.upper_bound();
        let tolerance = relative_tolerance * upper_bound.abs();
        if bounded_region.lower_bound >= upper_bound - TOLERANCE_MM - tolerance {
            return search.into_result(bounded_region.lower_bound.min(upper_bound), None);
        }
        let max_regions = match upper_bound < 0.0 {
            true => MAX_REGIONS_OVERLAPPING,
            false => max_regions,
        };
        let mut half_widths = bounded_region.region.half_widths.iter();
        let is_small = half_widths.all(|half_width| *half_width < MIN_HALF_WIDTH_DEG);
        if is_small || search.region_count >= max_regions {
            return search.into_result(bounded_region.lower_bound, Some(&bounded_region));
        }
        for half_region in bounded_region.region.halves(bounded_region.split_servo) {
            let bounded_half = search.bound_region(half_region, &bounded_region.candidate_pairs);
            open_regions.extend(bounded_half.map(with_order_key));
        }
    }
    let upper_bound = search.upper_bound();
    search.into_result(upper_bound, None)
}

/// A search over the angles of `N` servos.
struct Search<'a, const N: usize> {
    assembly: &'a Assembly,
    guard: &'a RelaxedGuard<'a>,
    task: &'a Task,
    servos: [usize; N],
    /// Accepted pose with the smallest distance found.
    nearest: Option<NearestPose>,
    /// Number of regions checked so far.
    region_count: u64,
}

impl<const N: usize> Search<'_, N> {
    /// Upper bound of the smallest distance, mm.
    fn upper_bound(&self) -> f64 {
        let nearest = self.nearest.as_ref();
        nearest.map_or(FAR_MM, |nearest| nearest.mm.min(FAR_MM))
    }

    /// Converts the search to its result. In `unproved_region`, no larger distance could be proved.
    fn into_result(
        self,
        lower_bound: f64,
        unproved_region: Option<&BoundedRegion<N>>,
    ) -> (NearestPair, u64) {
        let nearest = self.nearest.as_ref();
        let shape_pair = match (nearest, unproved_region) {
            (Some(nearest), _) => nearest.shape_pair,
            (None, Some(region)) => region.bounding_pair,
            (None, None) => 0,
        };
        let nearest_pair = self.assembly.make_nearest_pair(
            self.task.shape_pairs[shape_pair as usize].bodies,
            lower_bound - ROUNDING_MM,
            nearest.map(|nearest| (nearest.pose, nearest.mm)),
            unproved_region.map(|bounded| self.angles(&bounded.region)),
        );
        (nearest_pair, self.region_count)
    }

    /// Angles at the middle of a region, deg, servo order; `None` for a servo without effect on the distance.
    fn angles(&self, region: &Region<N>) -> [Option<f64>; 4] {
        let mut angles = [None; 4];
        for (servo, angle) in self.servos.iter().zip(region.middle) {
            angles[*servo] = Some(angle);
        }
        angles
    }

    /// Bounds a region's distances. Returns `None` if no pair of shapes can be closer than the smallest distance found
    /// so far, or if the guard accepts no pose of the region.
    fn bound_region(
        &mut self,
        region: Region<N>,
        candidate_pairs: &[u32],
    ) -> Option<BoundedRegion<N>> {
        self.region_count += 1;
        let (bounds, middle) = self.guard.bound_cranks(&self.servos, &region)?;
        // Placements of both mounts at the region's middle, and bounds for the whole region.
        let [(a, bounds_a), (b, bounds_b)] = self.task.mounts.map(|mount| {
            let placement = self.assembly.placement_for_cranks(mount, middle);
            let bounds = self.assembly.placement_for_cranks(mount, bounds);
            (placement, tighten(&bounds, &placement, &region))
        });
        let placement = b.relative_to(&a);
        let bounds = tighten(&bounds_b.relative_to(&bounds_a), &placement, &region);
        let deviations = [bounds.origin, bounds.x_axis].map(|vector| {
            let [x, y] =
                [vector.x, vector.y].map(|coordinate| coordinate.max_change(&region.half_widths));
            x.hypot(y)
        });
        let mut bounded_region = BoundedRegion {
            region,
            lower_bound: f64::INFINITY,
            bounding_pair: 0,
            split_servo: find_most_influential_servo(&bounds, &region),
            candidate_pairs: Vec::new(),
        };
        // The linkages' loops may not close at the region's middle.
        let loops_close = placement.origin.is_finite() && placement.x_axis.is_finite();
        let (mut min_distance, mut nearest_pair) = (f64::INFINITY, 0);
        for &index in candidate_pairs {
            let shape_pair = &self.task.shape_pairs[index as usize];
            let lower_bound = if !loops_close {
                f64::NEG_INFINITY
            } else if shape_pair.is_far(&placement, deviations, self.upper_bound()) {
                continue;
            } else {
                let distance = shape_pair.distance(&placement);
                if distance < min_distance {
                    (min_distance, nearest_pair) = (distance, index);
                }
                let lower_bound = shape_pair.distance_bound(&placement, &bounds, &region);
                match lower_bound.is_nan() {
                    true => f64::NEG_INFINITY,
                    false => lower_bound,
                }
            };
            if lower_bound < self.upper_bound() {
                bounded_region.candidate_pairs.push(index);
                if lower_bound < bounded_region.lower_bound {
                    (bounded_region.lower_bound, bounded_region.bounding_pair) =
                        (lower_bound, index);
                }
            }
        }
        if min_distance < self.upper_bound() - TOLERANCE_MM / 4.0
            && let Some(pose) = self.guard.find_pose(self.angles(&region))
        {
            self.nearest = Some(NearestPose {
                pose,
                mm: min_distance,
                shape_pair: nearest_pair,
            });
        }
        (!bounded_region.candidate_pairs.is_empty()).then_some(bounded_region)
    }
}

/// Tightens a placement's bounds in a region with the value at the region's middle and the largest change from it.
fn tighten<const N: usize>(
    bounds: &Placement<IntervalDual<N>>,
    middle: &Placement,
    region: &Region<N>,
) -> Placement<IntervalDual<N>> {
    let tighten_vector = |bounds: Vector<IntervalDual<N>>, middle: Vector| {
        let x = bounds.x.tighten(middle.x, &region.half_widths);
        Vector::new(x, bounds.y.tighten(middle.y, &region.half_widths))
    };
    Placement {
        origin: tighten_vector(bounds.origin, middle.origin),
        x_axis: tighten_vector(bounds.x_axis, middle.x_axis),
    }
}

/// Finds the index of the servo whose range in a region changes a placement most.
fn find_most_influential_servo<const N: usize>(
    bounds: &Placement<IntervalDual<N>>,
    region: &Region<N>,
) -> usize {
    /// Lever arm that converts a rotation to a distance, mm.
    const LEVER_ARM_MM: f64 = 30.0;
    let (origin, axis_shift) = (bounds.origin, bounds.x_axis * LEVER_ARM_MM);
    let coordinates = [origin.x, origin.y, axis_shift.x, axis_shift.y];
    let influence = |servo: usize| {
        let half_width = region.half_widths[servo];
        coordinates.iter().fold(0.0, |sum, coordinate| {
            let change = coordinate.derivatives[servo].max_abs() * half_width;
            // If there is no finite bound, the widest angle is halved.
            sum + match change.is_finite() {
                true => change,
                false => half_width * 1e6,
            }
        })
    };
    (0..N)
        .max_by(|a, b| influence(*a).total_cmp(&influence(*b)).then(b.cmp(a)))
        .unwrap_or(0)
}
