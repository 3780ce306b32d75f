//! The check of a gait as the firmware will play it, at every sample of its tables and between the samples. Forward
//! kinematics computes the pose of head, tail, sides and legs, which is checked against all limits in floating point.
//! The firmware's own guard then checks the same poses, because the guard would stop a gait that is closer to a limit
//! than its integers resolve.

use lizard_core::guard::clearance::Clearance;
use lizard_core::guard::hazard::{Hazard, Margin};
use lizard_core::numbers::gaits::{Gait as TableGait, SAMPLES_PER_WAVE};
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::units::Sweep;
use lizard_kinematics::{Check, Solution, Violation};

use crate::checks::accuracy::{self, PHASE_COUNT};
use crate::config::servo::SERVO_NAMES;
use crate::config::{RobotConfig, describe_open_loop, describe_violation};
use crate::file::{Error, ReadResult};
use crate::gaits::Gait;
use crate::tables::Tables;
use crate::units::{FRAMES_PER_SECOND, PHASE_STEPS_PER_CYCLE, STEPS_PER_DEGREE};

/// Number of evenly spaced phases in a cycle that are checked in addition to the tables' samples.
const CHECKED_PHASE_COUNT: usize = 1024;
/// Number of phases at which the speed over one frame is computed.
const SPEED_PHASE_COUNT: usize = 4096;
/// The largest error allowed in a table, deg.
const MAX_TABLE_ERROR_DEG: f64 = 0.50;

/// The smallest margin of one kind (type-2, type-1 or leg) over a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MinMargin {
    /// The condition that has this margin.
    pub check: Check,
    /// The smallest value of the margin, as a sine.
    pub value: f64,
    /// Phase of the smallest value, 0 to 1.
    pub phase: f64,
}

/// The highest speed of a servo between two frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeakSpeed {
    /// Index of the servo, 0 to 3.
    pub servo: usize,
    /// Mean speed over the 20 ms from one frame to the next, deg/s.
    pub speed: f64,
    /// Phase at the start of the frame, 0 to 1.
    pub phase: f64,
}

/// The smallest margins, the range of the slider travels and the highest speed in a checked gait.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Audit {
    /// Smallest type-2 margin, head and tail.
    pub type2: MinMargin,
    /// Smallest type-1 margin of the four arms.
    pub type1: MinMargin,
    /// Smallest margin of the four legs.
    pub leg: MinMargin,
    /// Smallest and largest slider travel over both sides, mm from nominal.
    pub stroke_range: (f64, f64),
    /// Highest speed of a servo over one frame.
    pub peak_speed: PeakSpeed,
}

impl Audit {
    /// The audit before the first sample is added.
    pub(crate) const EMPTY: Self = Self {
        type2: MinMargin::unset(Check::TYPE2[0]),
        type1: MinMargin::unset(Check::TYPE1[0]),
        leg: MinMargin::unset(Check::LEG[0]),
        stroke_range: (f64::INFINITY, f64::NEG_INFINITY),
        peak_speed: PeakSpeed {
            servo: 0,
            speed: 0.0,
            phase: 0.0,
        },
    };

    /// Adds the margins and slider travels of the pose at a phase.
    fn add(&mut self, solution: &Solution, phase: f64) {
        for (check, value) in solution.margins.iter() {
            let kinds = [
                (&mut self.type2, &Check::TYPE2[..]),
                (&mut self.type1, &Check::TYPE1),
                (&mut self.leg, &Check::LEG),
            ];
            for (min_margin, checks) in kinds {
                if checks.contains(&check) && value < min_margin.value {
                    *min_margin = MinMargin {
                        check,
                        value,
                        phase,
                    };
                }
            }
        }
        for slider_travel in [solution.left.s, solution.right.s] {
            self.stroke_range = (
                self.stroke_range.0.min(slider_travel),
                self.stroke_range.1.max(slider_travel),
            );
        }
    }
}

impl MinMargin {
    /// The margin before the first sample is added.
    const fn unset(check: Check) -> Self {
        Self {
            check,
            value: f64::INFINITY,
            phase: 0.0,
        }
    }
}

/// Checks a gait against the limits of its robot.
///
/// # Errors
/// Returns the first error that exists, in this order: the first phase at which an angle is outside a servo's
/// travel or the linkage does not close; the worst violation of the limit that is violated first; the first pose at
/// which the firmware's guard would stop the gait; a servo speed that is too high; a table that is too coarse.
pub(crate) fn check_gait(
    gait: &Gait,
    index: usize,
    tables: &Tables,
    config: &RobotConfig,
    core_robot: &lizard_core::numbers::robot::Robot<'_>,
) -> ReadResult<Audit> {
    let gait_error =
        |consequence: String, problem: String| Error::in_gait(&gait.name, &consequence, problem);
    let mut audit = Audit {
        peak_speed: find_peak_speed(gait),
        ..Audit::EMPTY
    };
    let mut worst_violation: Option<(f64, Violation)> = None;
    let mut guard_stop: Option<(f64, Check)> = None;
    let at_phase = |phase: f64| format!("at phase {phase:.4}");
    for phase in list_phases(&tables.gaits[index]) {
        let sweeps = tables.sweeps(index, phase);
        let angles = gait.angles_from_table(sweeps);
        let sweeps = Pose(sweeps.map(Sweep));
        let phase = f64::from(phase) / PHASE_STEPS_PER_CYCLE;
        check_travels(gait, config, angles, phase)?;
        if let Some(hazard) = Clearance::measure(core_robot, &sweeps).first_hazard(core_robot) {
            guard_stop.get_or_insert((phase, check_of_hazard(&hazard)));
        }
        let solution = config.lizard.solve(&angles.into());
        let solution = solution.map_err(|infeasible| {
            let problem = format!("{infeasible} {}", at_phase(phase));
            gait_error(describe_open_loop(infeasible.mechanism), problem)
        })?;
        for violation in config.limits.violations(&solution) {
            if worst_violation.is_none_or(|(_, earlier)| is_worse_violation(violation, earlier)) {
                worst_violation = Some((phase, violation));
            }
        }
        audit.add(&solution, phase);
    }
    if let Some((phase, violation)) = worst_violation {
        let problem = format!("{violation} {}", at_phase(phase));
        return Err(gait_error(describe_violation(violation.check), problem));
    }
    if let Some((phase, stopping_check)) = guard_stop {
        let problem = format!(
            "margin or travel {stopping_check} is so close to its limit {} that the firmware's integers place it beyond the limit; leave more room",
            at_phase(phase)
        );
        return Err(gait_error(describe_violation(stopping_check), problem));
    }
    let peak = audit.peak_speed;
    let limit = config.speed_limits.gait_slew;
    if peak.speed > limit {
        let name = SERVO_NAMES[peak.servo];
        return Err(gait_error(
            format!("servo {name} would have to turn too fast"),
            format!(
                "{:.1} deg/s {}; limits.gait_slew is {limit:.1} deg/s",
                peak.speed,
                at_phase(peak.phase)
            ),
        ));
    }
    let error = accuracy::compute_table_error(gait, index, tables, CHECKED_PHASE_COUNT);
    if error.max > MAX_TABLE_ERROR_DEG {
        let name = SERVO_NAMES[error.servo];
        return Err(gait_error(
            format!("servo {name} would have to turn too sharply"),
            format!(
                "the firmware's table of {SAMPLES_PER_WAVE} samples is {:.3} deg off {}; at most {MAX_TABLE_ERROR_DEG:.2} deg is allowed",
                error.max,
                at_phase(error.phase)
            ),
        ));
    }
    Ok(audit)
}

/// Returns the floating-point check that corresponds to a hazard of the firmware's guard.
fn check_of_hazard(hazard: &Hazard) -> Check {
    match *hazard {
        Hazard::Margin { margin, .. } => match margin {
            Margin::Type2(end) => Check::TYPE2[end as usize],
            Margin::Type1(servo) => Check::TYPE1[servo.index()],
            Margin::Leg(servo) => Check::LEG[servo.index()],
        },
        Hazard::Stroke { side, .. } => Check::STROKE[side as usize],
        Hazard::Travel(_) => unreachable!("the clearance does not include the servos' travel"),
    }
}

/// True if a violation exceeds the limit by more than an earlier violation of the same limit.
fn is_worse_violation(violation: Violation, earlier: Violation) -> bool {
    let excess = |v: Violation| (v.value - v.limit).abs();
    violation.check == earlier.check && excess(violation) > excess(earlier)
}

/// Lists the phases to check, in 1/65536 cycle: evenly spaced phases, and the phase of every sample of every servo.
fn list_phases(table: &TableGait) -> Vec<u16> {
    let evenly_spaced = |count: usize| (0..count).map(move |i| (i * (PHASE_COUNT / count)) as u16);
    let mut phases: Vec<u16> = evenly_spaced(CHECKED_PHASE_COUNT).collect();
    for channel in &table.channels {
        phases.extend(
            evenly_spaced(SAMPLES_PER_WAVE).map(|sample| sample.wrapping_sub(channel.offset)),
        );
    }
    phases.sort_unstable();
    phases.dedup();
    phases
}

/// Rejects angles outside a servo's travel.
fn check_travels(
    gait: &Gait,
    config: &RobotConfig,
    angles: [f64; 4],
    phase: f64,
) -> ReadResult<()> {
    // Both the travel's limits and the sample are rounded to an angle step.
    const STEP_DEG: f64 = 1.0 / STEPS_PER_DEGREE;
    for ((servo, angle), name) in config.servos.iter().zip(angles).zip(SERVO_NAMES) {
        let (min, max) = servo.travel();
        let sweep = angle - servo.neutral;
        if sweep < min - STEP_DEG || sweep > max + STEP_DEG {
            let (min, max) = (servo.neutral + min, servo.neutral + max);
            let consequence = format!("servo {name} would have to turn farther than it can");
            let problem = format!(
                "{angle:.2} deg at phase {phase:.4} is outside its travel of {min:.2} to {max:.2} deg"
            );
            return Err(Error::in_gait(&gait.name, &consequence, problem));
        }
    }
    Ok(())
}

/// Finds the highest speed of a servo over one frame of a gait at full speed.
fn find_peak_speed(gait: &Gait) -> PeakSpeed {
    let phase_per_frame = 1.0 / (FRAMES_PER_SECOND * gait.period);
    let mut peak = Audit::EMPTY.peak_speed;
    for i in 0..SPEED_PHASE_COUNT {
        let phase = i as f64 / SPEED_PHASE_COUNT as f64;
        let (sweeps, next_sweeps) = (gait.sweeps(phase), gait.sweeps(phase + phase_per_frame));
        for servo in 0..4 {
            let speed = (next_sweeps[servo] - sweeps[servo]).abs() * FRAMES_PER_SECOND;
            if speed > peak.speed {
                peak = PeakSpeed {
                    servo,
                    speed,
                    phase,
                };
            }
        }
    }
    peak
}

#[cfg(test)]
mod tests;
