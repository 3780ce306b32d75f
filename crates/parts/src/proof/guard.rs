//! The poses that the guard accepts, as bounds on the servos' angles.
//!
//! [`Limits`] defines a safe pose; this module only applies the limits. The firmware computes in integers, so its
//! decision may differ within a band around each limit. The limits are relaxed by more than this band
//! ([`SINE_RELAXATION`], [`LENGTH_RELAXATION_MM`]), so the proof also covers every pose that the firmware accepts.

use std::collections::{BTreeMap, VecDeque};

use lizard_kinematics::{Check, End, Limits, Real, Side, Solution, Vector};
use lizard_robot::Robot;

use super::interval::Interval;
use super::interval_dual::IntervalDual;

/// Relaxation of the margins' limits, as a sine.
const SINE_RELAXATION: f64 = 0.005;
/// Type-2 limit down to which [`SINE_RELAXATION`] is enough. At a lower limit the relaxation is larger, in inverse
/// proportion: the closer two couplers are to alignment, the more a rounded length turns them.
const BASE_RELAXATION_TYPE2: f64 = 0.3;
/// Relaxation of a slider's stroke and of crossed crank tips, mm.
const LENGTH_RELAXATION_MM: f64 = 0.1;
/// Resolution of the bounds of a servo's range in [`RelaxedGuard::find_bound`], deg.
const RANGE_RESOLUTION_DEG: f64 = 0.01;
/// Resolution of the angle of a pair's other servo in [`RelaxedGuard::find_bound`], deg.
const PARTNER_RESOLUTION_DEG: f64 = 0.2;
/// Largest number of regions that [`RelaxedGuard::find_pose`] searches.
const MAX_SEARCHED_REGIONS: u32 = 300;

/// Returns a key that orders numbers as [`f64::total_cmp`] does.
pub fn total_order_key(value: f64) -> i64 {
    let bits = value.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

/// A box in the space of `N` servo angles: its middle and its half widths, deg. A `servo` is an index in these arrays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region<const N: usize> {
    pub middle: [f64; N],
    pub half_widths: [f64; N],
}

impl<const N: usize> Region<N> {
    /// Creates the region between bounds of each servo's angle, deg.
    pub fn from_bounds(bounds: [Interval; N]) -> Self {
        Self {
            middle: bounds.map(|angle| angle.low + (angle.high - angle.low) / 2.0),
            half_widths: bounds.map(|angle| (angle.high - angle.low) / 2.0),
        }
    }

    /// Splits the region into halves at the middle of one servo's angle.
    pub fn halves(&self, servo: usize) -> [Self; 2] {
        [-0.5, 0.5].map(|fraction| {
            let mut half = *self;
            half.middle[servo] += fraction * self.half_widths[servo];
            half.half_widths[servo] *= 0.5;
            half
        })
    }

    /// Index of the servo with the widest range; `None` for a region without servos.
    pub fn widest_servo(&self) -> Option<usize> {
        (0..N).max_by(|a, b| self.half_widths[*a].total_cmp(&self.half_widths[*b]))
    }

    /// Bounds of one servo's angle, slightly widened so that halves overlap.
    pub fn bounds(&self, servo: usize) -> Interval {
        let (middle, half_width) = (self.middle[servo], self.half_widths[servo] + 1e-10);
        Interval::new(middle - half_width, middle + half_width)
    }
}

/// Computes the crank directions, in servo order, of some servos at these angles, deg. The cranks of other servos get a
/// placeholder direction.
fn cranks_at<const N: usize, T: Real>(servos: &[usize; N], angles: [T; N]) -> [Vector<T>; 4] {
    let (sines, cosines) = T::sin_cos_all(angles);
    let mut directions = [Vector::new(T::constant(1.0), T::constant(0.0)); 4];
    for (i, servo) in servos.iter().enumerate() {
        directions[*servo] = Vector::new(cosines[i], sines[i]);
    }
    directions
}

/// A bound of a servo's angle.
#[derive(Clone, Copy)]
enum Bound {
    Lower,
    Upper,
}

/// A relaxed guard of a robot, which accepts every pose that the firmware accepts.
pub struct RelaxedGuard<'a> {
    robot: &'a Robot,
    /// Relaxed limits of the robot.
    limits: Limits,
    /// Bounds of each servo's angle over all accepted poses, deg, servo order.
    pub ranges: [Interval; 4],
}

impl<'a> RelaxedGuard<'a> {
    /// Relaxes a robot's limits and bounds each servo's range.
    pub fn new(robot: &'a Robot) -> Self {
        let limits = robot.limits();
        let sine_relaxation = SINE_RELAXATION * (BASE_RELAXATION_TYPE2 / limits.type2).max(1.0);
        let mut guard = Self {
            robot,
            limits: Limits {
                type2: limits.type2 - sine_relaxation,
                type1: limits.type1 - sine_relaxation,
                leg: limits.leg - sine_relaxation,
                stroke_min: limits.stroke_min - LENGTH_RELAXATION_MM,
                stroke_max: limits.stroke_max + LENGTH_RELAXATION_MM,
            },
            ranges: robot.servos().each_ref().map(|servo| {
                let (low, high) = servo.travel();
                Interval::new(servo.neutral + low, servo.neutral + high)
            }),
        };
        // Two passes, because the range of one pair depends on the neighbouring pairs.
        for _ in 0..2 {
            let end_pairs = End::ALL.map(|end| end.servos()).into_iter();
            for pair in end_pairs.chain(Side::ALL.map(|side| side.servos())) {
                for index in 0..2 {
                    let [low, high] = [Bound::Lower, Bound::Upper]
                        .map(|bound| guard.find_bound(pair, index, bound));
                    guard.ranges[pair[index]] = Interval::new(low, high);
                }
            }
        }
        guard
    }

    /// Finds the lower or upper bound of the angle of one servo of a pair. Beyond this bound, no pose is accepted at
    /// any angle of the other servo.
    fn find_bound(&self, pair: [usize; 2], index: usize, bound: Bound) -> f64 {
        let sign = match bound {
            Bound::Lower => 1.0,
            Bound::Upper => -1.0,
        };
        let region_bound =
            |region: &Region<2>| region.middle[index] - sign * region.half_widths[index];
        let whole_region = Region::from_bounds(pair.map(|servo| self.ranges[servo]));
        // The outermost region comes first; of equally far regions, the one found first.
        let (mut regions, mut insertion_index) = (BTreeMap::from([((0, 0), whole_region)]), 0);
        while let Some((_, region)) = regions.pop_first() {
            if self.bound_cranks(&pair, &region).is_none() {
                continue;
            }
            let mut resolution = [PARTNER_RESOLUTION_DEG; 2];
            resolution[index] = RANGE_RESOLUTION_DEG;
            let [a, b] = [0, 1].map(|i| region.half_widths[i] / resolution[i]);
            if a.max(b) < 1.0 {
                return region_bound(&region);
            }
            for half_region in region.halves(usize::from(b > a)) {
                insertion_index += 1;
                let order_key = total_order_key(sign * region_bound(&half_region));
                regions.insert((order_key, insertion_index), half_region);
            }
        }
        // The guard refuses every pose, which is impossible if the neutral pose is safe.
        region_bound(&whole_region)
    }

    /// Computes the crank directions of some servos, within a region and at its middle. `None` if the conditions that
    /// depend only on these servos exclude every pose of the region.
    pub fn bound_cranks<const N: usize>(
        &self,
        servos: &[usize; N],
        region: &Region<N>,
    ) -> Option<([Vector<IntervalDual<N>>; 4], [Vector; 4])> {
        let angles = std::array::from_fn(|i| IntervalDual::angle(i, region.bounds(i)));
        let cranks = cranks_at(servos, angles);
        let middle_cranks = cranks_at(servos, region.middle);
        let is_violated = |(check, bounds, middle): (Check, IntervalDual<N>, f64)| {
            let value = bounds.tighten(middle, &region.half_widths).value;
            let [limit_at_low, limit_at_high] =
                [value.low, value.high].map(|value| self.violated_limit(check, value));
            // Every value between is refused only if both ends violate the same limit.
            limit_at_low.is_some() && limit_at_low == limit_at_high
        };
        let has_all =
            |servos_needed: [usize; 2]| servos_needed.iter().all(|servo| servos.contains(servo));
        // A leg's margin depends only on the crank's direction, so the angle that is passed has no effect.
        let (lizard, zero) = (self.robot.lizard(), IntervalDual::constant(0.0));
        let violates_leg = servos.iter().any(|&servo| {
            let end = End::from_servo(servo);
            let bounds = lizard.leg.pose_at(end, zero, cranks[servo]).margin;
            let middle = lizard.leg.pose_at(end, 0.0, middle_cranks[servo]).margin;
            is_violated((Check::LEG[servo], bounds, middle))
        });
        let violates_end = |end: End| {
            let middle_pose = lizard.end_pose_unchecked(end, middle_cranks);
            let values = middle_pose.conditions(end).map(|(_, value)| value);
            let pose = lizard.end_pose_unchecked(end, cranks);
            let mut conditions = pose.conditions(end).into_iter().zip(values);
            conditions.any(|((check, bounds), value)| is_violated((check, bounds, value)))
        };
        let violates_side = |side: Side| {
            let check = Check::STROKE[usize::from(side == Side::Right)];
            let bounds = lizard.side_pose_unchecked(side, cranks).s;
            let middle = lizard.side_pose_unchecked(side, middle_cranks).s;
            is_violated((check, bounds, middle))
        };
        let mut ends = End::ALL.into_iter().filter(|end| has_all(end.servos()));
        let mut sides = Side::ALL.into_iter().filter(|side| has_all(side.servos()));
        let is_refused = violates_leg || ends.any(violates_end) || sides.any(violates_side);
        (!is_refused).then_some((cranks, middle_cranks))
    }

    /// Returns the relaxed limit that a value violates; `None` if it violates none.
    fn violated_limit(&self, check: Check, value: f64) -> Option<f64> {
        // The limit of crossed tips is 0 and not a field of `Limits`, so the value is shifted instead of the limit.
        let shift = match check {
            Check::UncrossedHead | Check::UncrossedTail => LENGTH_RELAXATION_MM,
            _ => 0.0,
        };
        let violation = self.limits.violation(check, value + shift);
        violation.map(|violation| violation.limit)
    }

    /// Finds a pose with the given angles of some servos that the guard accepts with its unrelaxed limits; `None` if
    /// the search finds no such pose.
    pub fn find_pose(&self, angles: [Option<f64>; 4]) -> Option<Solution> {
        const ALL_SERVOS: [usize; 4] = [0, 1, 2, 3];
        let neutral = |servo: usize| self.robot.servos()[servo].neutral;
        let start_angles = ALL_SERVOS.map(|servo| angles[servo].unwrap_or(neutral(servo)));
        if let Some(pose) = self.robot.solve_if_allowed(start_angles) {
            return Some(pose);
        }
        let bounds = ALL_SERVOS.map(|servo| match angles[servo] {
            Some(angle) => Interval::new(angle, angle),
            None => self.ranges[servo],
        });
        let mut regions = VecDeque::from([Region::from_bounds(bounds)]);
        for _ in 0..MAX_SEARCHED_REGIONS {
            let region: Region<4> = regions.pop_front()?;
            if let Some(pose) = self.robot.solve_if_allowed(region.middle) {
                return Some(pose);
            }
            if self.bound_cranks(&ALL_SERVOS, &region).is_some() {
                regions.extend(region.halves(region.widest_servo()?));
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest error of the firmware's integer arithmetic, as a sine (docs/firmware.md).
    const SINE_ERROR: f64 = 0.002;
    /// Largest error of the firmware's integer arithmetic, mm (docs/firmware.md).
    const LENGTH_ERROR_MM: f64 = 4.0 / 256.0;

    /// Reads a robot from `robots/`. With the suffix " at its type-2 limit", no pose reaches another limit.
    fn read_robot(name: &str) -> Robot {
        let file = name.trim_end_matches(" at its type-2 limit");
        let path = format!("{}/../../robots/{file}.toml", env!("CARGO_MANIFEST_DIR"));
        let mut text = std::fs::read_to_string(&path).expect(&path);
        if file != name {
            for (key, limit) in [
                ("limits.type1", 0.0),
                ("limits.leg", 0.0),
                ("limits.stroke_min", -80.0),
                ("limits.stroke_max", 150.0),
            ] {
                text = lizard_robot::edit::with_number(&text, key, limit).expect(file);
            }
        }
        Robot::parse(&text).expect(name)
    }

    /// Relaxes the robot's limits by the largest error of the firmware's integers.
    fn relax_limits(robot: &Robot) -> Limits {
        let limits = robot.limits();
        Limits {
            type2: limits.type2 - SINE_ERROR,
            type1: limits.type1 - SINE_ERROR,
            leg: limits.leg - SINE_ERROR,
            stroke_min: limits.stroke_min - LENGTH_ERROR_MM,
            stroke_max: limits.stroke_max + LENGTH_ERROR_MM,
        }
    }

    /// Each limit is tested alone: a pose near some limits, such as that of crossed tips, always violates another.
    #[test]
    fn each_limit_is_relaxed_by_slightly_more_than_the_firmwares_error() {
        for name in ["paper", "large", "unequal", "paper at its type-2 limit"] {
            let robot = read_robot(name);
            let (guard, limits) = (RelaxedGuard::new(&robot), robot.limits());
            let sines_below = |limit: f64| [limit - SINE_ERROR, limit - 0.1];
            let strokes_beyond = |end: f64, sign: f64| {
                [LENGTH_ERROR_MM, 1.0].map(|distance_mm| end + sign * distance_mm)
            };
            let cases = [
                (&Check::TYPE2[..], sines_below(limits.type2)),
                (&Check::TYPE1, sines_below(limits.type1)),
                (&Check::LEG, sines_below(limits.leg)),
                (&Check::UNCROSSED, [-LENGTH_ERROR_MM, -1.0]),
                (&Check::STROKE, strokes_beyond(limits.stroke_min, -1.0)),
                (&Check::STROKE, strokes_beyond(limits.stroke_max, 1.0)),
            ];
            for (checks, [inside, outside]) in cases {
                for &check in checks {
                    assert_eq!(guard.violated_limit(check, inside), None, "{name}: {check}");
                    let is_violated = guard.violated_limit(check, outside).is_some();
                    assert!(is_violated, "{name}: {check}");
                }
            }
        }
    }

    #[test]
    fn a_pose_that_the_firmware_may_accept_at_a_limit_is_never_refused() {
        const ALL_SERVOS: [usize; 4] = [0, 1, 2, 3];
        let mut reached_checks: Vec<Check> = Vec::new();
        for name in ["paper", "unequal", "paper at its type-2 limit"] {
            let robot = read_robot(name);
            let guard = RelaxedGuard::new(&robot);
            let relaxed = relax_limits(&robot);
            let neutral = robot.servos().each_ref().map(|servo| servo.neutral);
            let violated_check_at = |angles: [f64; 4]| match robot.lizard().solve(&angles.into()) {
                Ok(solution) => relaxed
                    .violations(&solution)
                    .map(|violation| Some(violation.check))
                    .next(),
                Err(_) => Some(None),
            };
            // In a direction, each servo turns to one side, to the other side, or not at all.
            for direction_index in 0..81 {
                let direction =
                    [1, 3, 9, 27].map(|divisor| f64::from(direction_index / divisor % 3) - 1.0);
                for factors in [[1.0; 4], [1.0, 0.4, 0.7, 0.2], [0.2, 0.7, 0.4, 1.0]] {
                    let angles_at = |angle_deg: f64| {
                        ALL_SERVOS.map(|servo| {
                            neutral[servo] + angle_deg * direction[servo] * factors[servo]
                        })
                    };
                    let (mut accepted_deg, mut refused_deg) = (0.0, 90.0);
                    if violated_check_at(angles_at(refused_deg)).is_none() {
                        continue;
                    }
                    while refused_deg - accepted_deg > 1e-6 {
                        let middle = (accepted_deg + refused_deg) / 2.0;
                        match violated_check_at(angles_at(middle)) {
                            None => accepted_deg = middle,
                            Some(_) => refused_deg = middle,
                        }
                    }
                    let middle = angles_at(accepted_deg);
                    let region = Region {
                        middle,
                        half_widths: [1e-7; 4],
                    };
                    let is_accepted = guard.bound_cranks(&ALL_SERVOS, &region).is_some();
                    assert!(is_accepted, "{name}: {middle:?}");
                    reached_checks.extend(violated_check_at(angles_at(refused_deg)).flatten());
                }
            }
        }
        for (limit, checks) in [
            ("type-2", &Check::TYPE2[..]),
            ("type-1", &Check::TYPE1),
            ("leg", &Check::LEG),
            ("stroke", &Check::STROKE),
        ] {
            let is_reached = reached_checks.iter().any(|check| checks.contains(check));
            assert!(is_reached, "no pose reaches a {limit} limit");
        }
    }
}
