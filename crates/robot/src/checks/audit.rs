//! Checks every sample of every gait, as the firmware will send it. First by the forward
//! solution: head, tail, sides and legs against all limits. Then by the firmware's own
//! guard, which would stop a gait that is closer to a limit than its integers resolve.

use lizard_core::guard::clearance::Clearance;
use lizard_core::guard::hazard::{Hazard, Margin};
use lizard_core::numbers::gaits::SAMPLES;
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::units::Sweep;
use lizard_kinematics::{Check, Solution, Violation};

use crate::file::Problem;
use crate::gaits::Gait;
use crate::measures::Measures;
use crate::measures::servo::NAMES;
use crate::tables::TabledGait;
use crate::tables::accuracy::{self, ALL_PHASES};
use crate::units::{FRAMES_PER_SECOND, PHASES, STEPS_PER_DEGREE};

/// Evenly spaced phases that are checked besides the tables' own samples.
const CHECKED: usize = 1024;
/// Phases over which the fastest frame is looked for.
const SPEEDS: usize = 4096;
/// The largest error of a table, deg.
const ERROR_LIMIT: f64 = 0.50;

/// The smallest of a kind of margin over a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Least {
    /// Which one.
    pub what: Check,
    /// Its value, a sine.
    pub value: f64,
    /// Where, 0 to 1.
    pub phase: f64,
}

/// The fastest that a servo turns between two frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Which servo, 0 to 3.
    pub servo: usize,
    /// deg/s, the mean over the 20 ms from one frame to the next.
    pub speed: f64,
    /// Where the frame begins, 0 to 1.
    pub phase: f64,
}

/// What the check of a gait found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Audit {
    /// Smallest type-2 margin, head and tail.
    pub type2: Least,
    /// Smallest type-1 margin of the four arms.
    pub type1: Least,
    /// Smallest margin of the four legs.
    pub leg: Least,
    /// Slider travel of both sides, smallest and largest, mm from nominal.
    pub stroke: (f64, f64),
    /// Fastest frame.
    pub peak: Peak,
}

/// Checks a gait against the limits of its robot.
///
/// # Errors
/// The first travel or loop that a sample breaks; else, over all samples, the
/// worst of the first limit broken; else what the firmware's guard would hold the
/// gait for; else a frame that is too fast, or a table that is too coarse.
pub(crate) fn check(
    gait: &TabledGait,
    robot: &Measures,
    firmware: &lizard_core::numbers::robot::Robot<'_>,
) -> Result<Audit, Problem> {
    let peak = fastest(gait.gait());
    let mut found: Option<Audit> = None;
    let mut worst: Option<(f64, Violation)> = None;
    let mut held: Option<(f64, Check)> = None;
    for phase in phases(gait) {
        let angles = gait.angles(phase);
        let sweeps = Pose(gait.sweeps(phase).map(Sweep));
        let phase = f64::from(phase) / PHASES;
        travels(robot, angles, phase)?;
        if let Some(hazard) = Clearance::of(firmware, &sweeps).hazard(firmware) {
            held.get_or_insert((phase, condition(&hazard)));
        }
        let solution = robot
            .lizard
            .solve(&angles.into())
            .map_err(|fault| Problem::Unsafe {
                phase,
                violation: fault.to_string(),
            })?;
        for violation in robot.limits.violations(&solution) {
            worst = Some(match worst {
                Some(earlier) if !exceeds(violation, earlier.1) => earlier,
                _ => (phase, violation),
            });
        }
        let here = Audit::of(&solution, phase, peak);
        found = Some(found.map_or(here, |so_far| so_far.least(here)));
    }
    if let Some((phase, violation)) = worst {
        return Err(Problem::Unsafe {
            phase,
            violation: violation.to_string(),
        });
    }
    if let Some((phase, what)) = held {
        return Err(Problem::TooNear {
            phase,
            what: what.name(),
        });
    }
    if peak.speed > robot.pace.gait_slew {
        let limit = robot.pace.gait_slew;
        return Err(Problem::TooFast {
            phase: peak.phase,
            servo: NAMES[peak.servo],
            speed: peak.speed,
            limit,
        });
    }
    let coarse = accuracy::worst(gait, CHECKED);
    if coarse.max > ERROR_LIMIT {
        let (phase, servo) = (coarse.phase, NAMES[coarse.servo]);
        return Err(Problem::Coarse {
            phase,
            servo,
            error: coarse.max,
            limit: ERROR_LIMIT,
        });
    }
    // `phases` is never empty, so something was found.
    found.ok_or(Problem::Coarse {
        phase: 0.0,
        servo: NAMES[0],
        error: f64::NAN,
        limit: ERROR_LIMIT,
    })
}

/// What the firmware's guard found, as the float calls it.
fn condition(hazard: &Hazard) -> Check {
    match *hazard {
        Hazard::Margin { margin, .. } => match margin {
            Margin::Type2(end) => Check::TYPE2[end as usize],
            Margin::Type1(servo) => Check::TYPE1[servo.index()],
            Margin::Leg(servo) => Check::LEG[servo.index()],
        },
        Hazard::Stroke { side, .. } => Check::STROKE[side as usize],
        Hazard::Travel(_) => unreachable!("the guard knows no servo's travel"),
    }
}

/// Whether a violation is the same limit's, and worse.
fn exceeds(violation: Violation, earlier: Violation) -> bool {
    let by = |v: Violation| (v.value - v.limit).abs();
    violation.what == earlier.what && by(violation) > by(earlier)
}

/// The phases to check: evenly spaced ones, and every sample of every servo.
fn phases(gait: &TabledGait) -> Vec<u16> {
    let every = |count: usize| (0..count).map(move |i| (i * (ALL_PHASES / count)) as u16);
    let mut phases: Vec<u16> = every(CHECKED).collect();
    for channel in &gait.table().channels {
        phases.extend(every(SAMPLES).map(|sample| sample.wrapping_sub(channel.offset)));
    }
    phases.sort_unstable();
    phases.dedup();
    phases
}

fn travels(robot: &Measures, angles: [f64; 4], phase: f64) -> Result<(), Problem> {
    // The ends of the travel and the sample are both rounded to an angle step.
    const STEP: f64 = 1.0 / STEPS_PER_DEGREE;
    for (i, servo) in robot.servos.iter().enumerate() {
        let (min, max) = servo.travel();
        let sweep = angles[i] - servo.neutral;
        if sweep < min - STEP || sweep > max + STEP {
            let (min, max) = (servo.neutral + min, servo.neutral + max);
            return Err(Problem::Travel {
                phase,
                servo: NAMES[i],
                angle: angles[i],
                min,
                max,
            });
        }
    }
    Ok(())
}

/// The fastest frame of a gait at full speed.
fn fastest(gait: &Gait) -> Peak {
    let frame = 1.0 / (FRAMES_PER_SECOND * gait.period);
    let mut peak = Peak {
        servo: 0,
        speed: 0.0,
        phase: 0.0,
    };
    for i in 0..SPEEDS {
        let phase = i as f64 / SPEEDS as f64;
        let (from, to) = (gait.sweeps(phase), gait.sweeps(phase + frame));
        for servo in 0..4 {
            let speed = (to[servo] - from[servo]).abs() * FRAMES_PER_SECOND;
            if speed > peak.speed {
                peak = Peak {
                    servo,
                    speed,
                    phase,
                };
            }
        }
    }
    peak
}

impl Audit {
    fn of(solution: &Solution, phase: f64, peak: Peak) -> Self {
        let least = |kind: &[Check]| {
            let of_kind = solution
                .margins
                .iter()
                .filter(|(what, _)| kind.contains(what));
            let (what, value) =
                of_kind.fold(
                    (kind[0], f64::INFINITY),
                    |a, b| if b.1 < a.1 { b } else { a },
                );
            Least { what, value, phase }
        };
        let (left, right) = (solution.left.s, solution.right.s);
        Self {
            type2: least(&Check::TYPE2),
            type1: least(&Check::TYPE1),
            leg: least(&Check::LEG),
            stroke: (left.min(right), left.max(right)),
            peak,
        }
    }

    fn least(self, other: Self) -> Self {
        let least = |a: Least, b: Least| if b.value < a.value { b } else { a };
        Self {
            type2: least(self.type2, other.type2),
            type1: least(self.type1, other.type1),
            leg: least(self.leg, other.leg),
            stroke: (
                self.stroke.0.min(other.stroke.0),
                self.stroke.1.max(other.stroke.1),
            ),
            peak: self.peak,
        }
    }
}

#[cfg(test)]
mod tests;
