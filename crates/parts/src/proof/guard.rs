//! The poses that the guard accepts, as bounds of the servos' angles.
//!
//! [`Limits`] says what a safe pose is; this module only uses it. The firmware decides in
//! integers, and may differ within a band ([`SINE`], [`LENGTH`]). The limits are relaxed
//! by that band, so the proof also covers every pose that the firmware accepts.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

use lizard_kinematics::{Check, End, Limits, Real, Side, Solution, Vector};
use lizard_robot::Robot;

use super::interval::Interval;
use super::slope::Slope;
use crate::bodies::joints::{Cranks, Joints};

/// How far below the limit of a margin a pose is still checked.
const SINE: f64 = 0.005;
/// If the limit of the type-2 margin is below this, as many times farther: a rounded
/// length turns couplers by the more the nearer they are in line.
const TYPE2: f64 = 0.3;
/// How far beyond the ends of a slider's stroke, and crank tips crossed, mm.
const LENGTH: f64 = 0.1;
/// How exactly the ends of the servos' ranges are found, deg.
const FINE: f64 = 0.01;
/// In this many regions a pose is looked for that has some angles.
const ATTEMPTS: u32 = 300;
/// The same for what the other servo does there, deg.
const COARSE: f64 = 0.2;

/// Bounds of the angles of `N` servos: middles and half widths, deg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region<const N: usize> {
    pub middle: [f64; N],
    pub half: [f64; N],
}

impl<const N: usize> Region<N> {
    pub fn of(bounds: [Interval; N]) -> Self {
        Self {
            middle: bounds.map(|of| of.low + (of.high - of.low) / 2.0),
            half: bounds.map(|of| (of.high - of.low) / 2.0),
        }
    }

    /// Cut into two across one servo's angle.
    pub fn halves(&self, servo: usize) -> [Self; 2] {
        [-0.5, 0.5].map(|share| {
            let mut part = *self;
            part.middle[servo] += share * self.half[servo];
            part.half[servo] *= 0.5;
            part
        })
    }

    /// From and to, of one servo. A hair wider, so that halves overlap.
    pub fn bounds(&self, servo: usize) -> Interval {
        let half = self.half[servo] + 1e-10;
        Interval::new(self.middle[servo] - half, self.middle[servo] + half)
    }
}

/// Cranks of which some turn within bounds; the others have no meaning.
pub fn within<'a, const N: usize>(
    robot: &'a Robot,
    servos: &[usize; N],
    region: &Region<N>,
) -> Cranks<'a, Slope<N>> {
    let mut angles = [Slope::of(0.0); N];
    for (i, angle) in angles.iter_mut().enumerate() {
        *angle = Slope::angle(i, region.bounds(i));
    }
    turned(robot, servos, angles)
}

/// The same in the middle of the bounds.
pub fn middle<'a, const N: usize>(
    robot: &'a Robot,
    servos: &[usize; N],
    region: &Region<N>,
) -> Cranks<'a, f64> {
    turned(robot, servos, region.middle)
}

fn turned<'a, const N: usize, T: Real>(
    robot: &'a Robot,
    servos: &[usize; N],
    angles: [T; N],
) -> Cranks<'a, T> {
    let (sines, cosines) = T::sin_cos_each(angles);
    let mut cranks = [Vector::new(T::of(1.0), T::of(0.0)); 4];
    for (i, servo) in servos.iter().enumerate() {
        cranks[*servo] = Vector::new(cosines[i], sines[i]);
    }
    Cranks {
        lizard: robot.lizard(),
        cranks,
    }
}

/// What the guard of a robot accepts.
pub struct Guard<'a> {
    robot: &'a Robot,
    /// The robot's limits, relaxed.
    limits: Limits,
    /// No servo is ever beyond this in a pose that is accepted, deg, servo order.
    pub ranges: [Interval; 4],
}

impl<'a> Guard<'a> {
    pub fn new(robot: &'a Robot) -> Self {
        let limits = robot.limits();
        let sine = SINE * (TYPE2 / limits.type2).max(1.0);
        let mut guard = Self {
            robot,
            limits: Limits {
                type2: limits.type2 - sine,
                type1: limits.type1 - sine,
                leg: limits.leg - sine,
                stroke_min: limits.stroke_min - LENGTH,
                stroke_max: limits.stroke_max + LENGTH,
            },
            ranges: std::array::from_fn(|servo| {
                let servo = &robot.servos()[servo];
                let (low, high) = servo.travel();
                Interval::new(servo.neutral + low, servo.neutral + high)
            }),
        };
        // Twice, because what one pair may do depends on the pairs beside it.
        for _ in 0..2 {
            let ends = End::ALL.map(|end| end.servos());
            for pair in ends.into_iter().chain(Side::ALL.map(|side| side.servos())) {
                for which in 0..2 {
                    let [low, high] = [false, true].map(|high| guard.end_of(pair, which, high));
                    guard.ranges[pair[which]] = Interval::new(low, high);
                }
            }
        }
        guard
    }

    /// Beyond this angle of one of two servos no pose is accepted, whatever the other
    /// one does.
    fn end_of(&self, pair: [usize; 2], which: usize, high: bool) -> f64 {
        let sign = if high { -1.0 } else { 1.0 };
        let end = |region: &Region<2>| region.middle[which] - sign * region.half[which];
        // Orders floats that are numbers.
        let key = |region: &Region<2>| {
            let bits = (sign * end(region)).to_bits() as i64;
            Reverse(bits ^ (((bits >> 63) as u64) >> 1) as i64)
        };
        let whole = Region::of(pair.map(|servo| self.ranges[servo]));
        let mut regions = vec![whole];
        let mut heap = BinaryHeap::from([(key(&whole), 0)]);
        while let Some((_, index)) = heap.pop() {
            let region: Region<2> = regions[index];
            if self.refuses(&pair, &region) {
                continue;
            }
            let least = if which == 0 {
                [FINE, COARSE]
            } else {
                [COARSE, FINE]
            };
            let [a, b] = [0, 1].map(|i| region.half[i] / least[i]);
            if a.max(b) < 1.0 {
                return end(&region);
            }
            for half in region.halves(usize::from(b > a)) {
                heap.push((key(&half), regions.len()));
                regions.push(half);
            }
        }
        // Nothing is accepted at all; a robot whose neutral pose is safe has something.
        end(&whole)
    }

    /// Whether no pose of a region is accepted, for all that these servos decide alone.
    pub fn refuses<const N: usize>(&self, servos: &[usize; N], region: &Region<N>) -> bool {
        let bounds = within(self.robot, servos, region);
        let middle = middle(self.robot, servos, region);
        self.breaks(servos, region, &bounds, &middle)
    }

    /// The same for joints that are known already.
    pub fn breaks<const N: usize>(
        &self,
        servos: &[usize; N],
        region: &Region<N>,
        bounds: &Cranks<Slope<N>>,
        middle: &Cranks<f64>,
    ) -> bool {
        let broken = |(what, bounds, middle): (Check, Slope<N>, f64)| {
            let value = bounds.near(middle, &region.half).value;
            let [low, high] = [value.low, value.high].map(|value| self.broken(what, value));
            low.is_some() && low == high
        };
        let all = |of: [usize; 2]| of.iter().all(|servo| servos.contains(servo));
        let legs = servos.iter().any(|&servo| {
            let end = End::of_servo(servo);
            let shape = &self.robot.lizard().leg;
            // Its margin depends on the direction alone.
            let bounds = shape.shape(end, Slope::of(0.0), bounds.crank(servo)).margin;
            let middle = shape.shape(end, 0.0, middle.crank(servo)).margin;
            broken((Check::LEG[servo], bounds, middle))
        });
        legs || End::ALL
            .into_iter()
            .filter(|end| all(end.servos()))
            .any(|end| {
                let values = middle.end(end).conditions(end);
                let conditions = bounds.end(end).conditions(end);
                conditions
                    .into_iter()
                    .zip(values)
                    .any(|((what, bounds), (_, middle))| broken((what, bounds, middle)))
            })
            || Side::ALL
                .into_iter()
                .filter(|side| all(side.servos()))
                .any(|side| {
                    let what = Check::STROKE[usize::from(side == Side::Right)];
                    broken((what, bounds.side(side).s, middle.side(side).s))
                })
    }

    /// The limit that a value breaks though it is relaxed, if it does.
    fn broken(&self, what: Check, value: f64) -> Option<f64> {
        // Crossed tips have no limit that could be relaxed.
        let off = match what {
            Check::UncrossedHead | Check::UncrossedTail => LENGTH,
            _ => 0.0,
        };
        self.limits.broken(what, value + off).map(|of| of.limit)
    }

    /// A pose that the guard accepts, with its own limits, where some servos have an
    /// angle; `None` if none is found.
    pub fn pose(&self, angles: [Option<f64>; 4]) -> Option<Solution> {
        const ALL: [usize; 4] = [0, 1, 2, 3];
        let or = |of: fn(&lizard_robot::Servo) -> f64| {
            ALL.map(|servo| angles[servo].unwrap_or(of(&self.robot.servos()[servo])))
        };
        if let Some(pose) = self.robot.accepted(or(|servo| servo.neutral)) {
            return Some(pose);
        }
        let bounds = ALL.map(|servo| match angles[servo] {
            Some(angle) => Interval::new(angle, angle),
            None => self.ranges[servo],
        });
        let mut regions = VecDeque::from([Region::of(bounds)]);
        for _ in 0..ATTEMPTS {
            let region: Region<4> = regions.pop_front()?;
            if let Some(pose) = self.robot.accepted(region.middle) {
                return Some(pose);
            }
            if !self.refuses(&ALL, &region) {
                let by = |a: &usize, b: &usize| region.half[*a].total_cmp(&region.half[*b]);
                let widest = ALL.into_iter().max_by(by)?;
                regions.extend(region.halves(widest));
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the firmware's integers may decide otherwise by, a sine and mm: docs/firmware.md.
    const BAND: f64 = 0.002;
    const STEPS: f64 = 4.0 / 256.0;

    /// A robot of `robots/`, and the paper's with no limit in the way of the type-2 one.
    fn robot(name: &str) -> Robot {
        let file = name.trim_end_matches(" at its type-2 limit");
        let path = format!("{}/../../robots/{file}.toml", env!("CARGO_MANIFEST_DIR"));
        let mut text = std::fs::read_to_string(&path).expect(&path);
        if file != name {
            for (from, to) in [
                ("type1 = 0.3 ", "type1 = 0.0 "),
                ("leg = 0.3 ", "leg = 0.0 "),
                ("stroke_min = -15.0", "stroke_min = -80.0"),
                ("stroke_max = 45.0", "stroke_max = 150.0"),
            ] {
                assert!(text.contains(from), "{file} has no {from}");
                text = text.replacen(from, to, 1);
            }
        }
        Robot::parse(&text).expect(name)
    }

    /// The robot's limits, laxer by what the integers may be off by.
    fn lax(robot: &Robot) -> Limits {
        let limits = robot.limits();
        Limits {
            type2: limits.type2 - BAND,
            type1: limits.type1 - BAND,
            leg: limits.leg - BAND,
            stroke_min: limits.stroke_min - STEPS,
            stroke_max: limits.stroke_max + STEPS,
        }
    }

    /// Each limit by itself: some, as that of crossed tips, lie beyond others in every pose.
    #[test]
    fn every_limit_is_relaxed_by_more_than_the_firmware_may_be_off() {
        for name in ["paper", "large", "unequal", "paper at its type-2 limit"] {
            let robot = robot(name);
            let (guard, limits) = (Guard::new(&robot), robot.limits());
            let sine = |limit: f64| [limit - BAND, limit - 0.1];
            let sines = [
                (&Check::TYPE2[..], sine(limits.type2)),
                (&Check::TYPE1, sine(limits.type1)),
                (&Check::LEG, sine(limits.leg)),
                (&Check::UNCROSSED, [-STEPS, -1.0]),
                (
                    &Check::STROKE,
                    [limits.stroke_min - STEPS, limits.stroke_min - 1.0],
                ),
                (
                    &Check::STROKE,
                    [limits.stroke_max + STEPS, limits.stroke_max + 1.0],
                ),
            ];
            for (checks, [within, beyond]) in sines {
                for &what in checks {
                    assert_eq!(guard.broken(what, within), None, "{name}: {what}");
                    assert!(guard.broken(what, beyond).is_some(), "{name}: {what}");
                }
            }
        }
    }

    #[test]
    fn no_pose_that_the_firmware_may_accept_is_left_out_at_any_limit() {
        const ALL: [usize; 4] = [0, 1, 2, 3];
        let mut seen: Vec<Check> = Vec::new();
        for name in ["paper", "unequal", "paper at its type-2 limit"] {
            let robot = robot(name);
            let guard = Guard::new(&robot);
            let lax = lax(&robot);
            let neutral = robot.servos().each_ref().map(|servo| servo.neutral);
            let broken = |angles: [f64; 4]| match robot.lizard().solve(&angles.into()) {
                Ok(solution) => lax.violations(&solution).map(|of| Some(of.what)).next(),
                Err(_) => Some(None),
            };
            // To either side with each servo, each pair and all of them.
            for ways in 0..81 {
                let way = [1, 3, 9, 27].map(|part| f64::from(ways / part % 3) - 1.0);
                for share in [
                    [1.0, 1.0, 1.0, 1.0],
                    [1.0, 0.4, 0.7, 0.2],
                    [0.2, 0.7, 0.4, 1.0],
                ] {
                    let at =
                        |by: f64| ALL.map(|servo| neutral[servo] + by * way[servo] * share[servo]);
                    let (mut safe, mut not) = (0.0, 90.0);
                    if broken(at(not)).is_none() {
                        continue;
                    }
                    while not - safe > 1e-6 {
                        let middle = (safe + not) / 2.0;
                        if broken(at(middle)).is_none() {
                            safe = middle;
                        } else {
                            not = middle;
                        }
                    }
                    let region = Region {
                        middle: at(safe),
                        half: [1e-7; 4],
                    };
                    assert!(!guard.refuses(&ALL, &region), "{name}: {:?}", at(safe));
                    seen.extend(broken(at(not)).flatten());
                }
            }
        }
        type IsKind = fn(&Check) -> bool;
        let kinds: [(&str, IsKind); 4] = [
            ("type-2", |what| {
                matches!(what, Check::Type2Head | Check::Type2Tail)
            }),
            ("type-1", |what| {
                matches!(
                    what,
                    Check::Type1A1 | Check::Type1A2 | Check::Type1A3 | Check::Type1A4
                )
            }),
            ("leg", |what| Check::LEG.contains(what)),
            ("stroke", |what| Check::STROKE.contains(what)),
        ];
        for (kind, is) in kinds {
            let count = seen.iter().filter(|what| is(what)).count();
            assert!(count > 0, "no pose at the limit of a {kind}");
        }
    }
}
