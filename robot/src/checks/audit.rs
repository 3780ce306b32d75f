//! Checks every sample of every gait, as the firmware will send it. First by the forward
//! solution: head, tail, sides and legs against all limits. Then by the firmware's own
//! guard, which would stop a gait that is closer to a limit than its integers resolve.

use lizard_core::gait::SAMPLES;
use lizard_core::guard::Clearance;
use lizard_core::hazard::{Hazard, Margin};
use lizard_core::pose::Pose;
use lizard_core::units::Sweep;
use lizard_kinematics::{Check, Solution, Violation};

use crate::file::Problem;
use crate::gaits::Gait;
use crate::measures::Measures;
use crate::measures::servo::NAMES;
use crate::tables::accuracy::{self, ALL_PHASES};
use crate::tables::TabledGait;
use crate::units::{FRAMES_PER_SECOND, PHASES, STEPS_PER_DEGREE};

/// Evenly spaced phases that are checked besides the tables' own samples.
const CHECKED: usize = 1024;
/// Phases over which the fastest frame is looked for.
const SPEEDS: usize = 4096;
/// The largest error of a table, deg.
const ERROR_LIMIT: f64 = 0.10;

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
    firmware: &lizard_core::robot::Robot<'_>,
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
mod tests {
    use crate::testing::{all, body, robot, with};
    use crate::{CheckedGait, Robot};
    use lizard_core::hazard::{Hazard, Margin};
    use lizard_core::part::{End, Servo, Side as CoreSide};
    use lizard_core::units::Sine;
    use lizard_kinematics::{Check, Side};

    /// The slider's least and greatest travel on each side over a gait, mm.
    fn travels(robot: &Robot, gait: &CheckedGait) -> [(f64, f64); 2] {
        let mut found = [(f64::INFINITY, f64::NEG_INFINITY); 2];
        for phase in (0..=u16::MAX).step_by(32) {
            let solved = robot.lizard().solve(&gait.table_angles(phase).into());
            let solved = solved.expect("a checked gait closes");
            for (found, side) in found.iter_mut().zip(Side::ALL) {
                let s = solved.side(side).s;
                *found = (found.0.min(s), found.1.max(s));
            }
        }
        found
    }

    const STAND: &str = "[gait.stand]\nperiod = 1.0\nwaveform = \"still\"\n";

    /// The unequal robot with sliders at nominal in its neutral pose, and one gait
    /// that moves the legs of a side, so that one slider alone travels.
    fn lean(right: bool, limits: &[(&str, String)]) -> Result<Robot, crate::Error> {
        let legs = if right {
            "LF = 0.0, LH = 0.0"
        } else {
            "RF = 0.0, RH = 0.0"
        };
        let mut text = body("unequal")
            .replacen("l13 = 51.0", "l13 = 57.0", 1)
            .replacen("l18 = 57.0", "l18 = 51.4", 1);
        for (from, to) in limits {
            assert!(text.contains(from), "{from}");
            text = text.replacen(from, to, 1);
        }
        Robot::parse(&format!(
            "{text}{STAND}[gait.lean]\nperiod = 2.0\nwaveform = \"wave\"\nduty = 0.75\namplitude = 17.0\nstart = {{ LH = 0.0, LF = 0.25, RH = 0.5, RF = 0.75 }}\ngain = {{ {legs} }}\n"
        ))
    }

    #[test]
    fn both_sides_count_to_the_sliders_travel() {
        for right in [false, true] {
            let robot = lean(right, &[]).expect("it leans");
            let gait = robot.gait("lean").expect("lean");
            let moving = travels(&robot, gait)[usize::from(right)];
            let (least, most) = gait.audit().stroke;
            assert!(moving.0 < -5.0 && moving.1 > 3.0, "{moving:?}");
            assert!((moving.0 - least).abs() < 0.05, "{least}");
            assert!((most - moving.1).abs() < 0.05, "{most}");
        }
    }

    #[test]
    fn a_slider_that_runs_out_on_one_side_alone_is_named() {
        for (right, side) in [(false, "left"), (true, "right")] {
            let robot = lean(right, &[]).expect("it leans");
            let gait = robot.gait("lean").expect("lean");
            let (least, most) = travels(&robot, gait)[usize::from(right)];
            for (from, to, word) in [
                (
                    "stroke_min = -19.0",
                    format!("stroke_min = {:.2}", least + 0.5),
                    "below",
                ),
                (
                    "stroke_max = 41.0",
                    format!("stroke_max = {:.2}", most - 0.5),
                    "above",
                ),
            ] {
                let refused = lean(right, &[(from, to)]).expect_err(word).to_string();
                assert!(refused.contains(": gait.lean: at phase"), "{refused}");
                assert!(
                    refused.contains(&format!("{side} slider travel")),
                    "{refused}"
                );
                assert!(refused.contains(word), "{refused}");
            }
            let enough = [
                (
                    "stroke_min = -19.0",
                    format!("stroke_min = {:.2}", least - 0.2),
                ),
                (
                    "stroke_max = 41.0",
                    format!("stroke_max = {:.2}", most + 0.2),
                ),
            ];
            assert!(lean(right, &enough).is_ok());
        }
    }

    #[test]
    fn what_the_guard_finds_is_called_as_solve_calls_it() {
        let margin = |margin| Hazard::Margin {
            margin,
            value: Sine(0),
        };
        let stroke = |side| Hazard::Stroke { side, length: 0 };
        for (hazard, name) in [
            (margin(Margin::Type2(End::Head)), "type2_head"),
            (margin(Margin::Type2(End::Tail)), "type2_tail"),
            (margin(Margin::Type1(Servo::A2)), "type1_a2"),
            (margin(Margin::Type1(Servo::A4)), "type1_a4"),
            (margin(Margin::Leg(Servo::A1)), "leg_lf"),
            (margin(Margin::Leg(Servo::A3)), "leg_rh"),
            (stroke(CoreSide::Left), "stroke_left"),
            (stroke(CoreSide::Right), "stroke_right"),
        ] {
            assert_eq!(super::condition(&hazard).name(), name);
        }
    }

    #[test]
    fn every_sample_of_every_servo_is_checked() {
        for (name, robot) in all() {
            for gait in robot.gaits() {
                let phases = super::phases(gait.tabled());
                for channel in gait.tabled().table().channels {
                    for sample in (0..=u16::MAX).step_by(512) {
                        let phase = sample.wrapping_sub(channel.offset);
                        assert!(phases.contains(&phase), "{name} {} {phase}", gait.name());
                    }
                }
            }
        }
    }

    #[test]
    fn a_swing_backward_is_as_fast_as_one_forward() {
        // All legs against their sense: no swing goes forward.
        let against = "[gait.against]\nlike = \"walk\"\ngain = { LF = -1.0, RF = -1.0, RH = -1.0, LH = -1.0 }\n[gait.trot]";
        let robot = with("unequal", &[("[gait.trot]", against)]).expect("a gait");
        let speed = |name: &str| robot.gait(name).expect(name).audit().peak.speed;
        assert!((speed("against") - speed("walk")).abs() < 1e-9);
    }

    #[test]
    fn a_gait_may_be_as_fast_as_its_limit() {
        let fastest = robot("unequal");
        let speed = |gait: &CheckedGait| gait.audit().peak.speed;
        let most = fastest.gaits().iter().map(speed).fold(0.0, f64::max);
        let limit = |speed: f64| format!("gait_slew = {speed:?}");
        assert!(with("unequal", &[("gait_slew = 330.0", &limit(most))]).is_ok());
        let refused = with("unequal", &[("gait_slew = 330.0", &limit(most - 1e-6))]);
        let refused = refused.expect_err("it is too fast").to_string();
        assert!(refused.contains("limits.gait_slew is"), "{refused}");
    }

    #[test]
    fn a_gait_may_use_all_of_a_servos_travel() {
        // A held leg swings exactly its amplitude to either side of neutral.
        let travel = |degrees: f64| {
            let servo = format!("us_per_degree = 8.5\nmin_us = {:?}", 1500.0 - degrees * 8.5);
            let body = body("unequal").replacen("us_per_degree = 8.5\nmin_us = 700.0", &servo, 1);
            Robot::parse(&format!(
                "{body}{STAND}[gait.sway]\nperiod = 2.0\nwaveform = \"held\"\namplitude = 17.0\norder = [\"LH\", \"LF\", \"RH\", \"RF\"]\n"
            ))
        };
        assert_eq!(travel(17.0).map(|robot| robot.gaits().len()), Ok(2));
        let refused = travel(16.9).expect_err("a tenth less").to_string();
        assert!(
            refused.contains("gait.sway: at phase")
                && refused.contains("deg, outside its travel of 299.10 to"),
            "{refused}"
        );
    }

    #[test]
    fn every_end_of_every_travel_is_checked() {
        // A servo that is left a degree on one side cannot walk.
        for (servo, least, most, neutral) in [
            ("A1", "min_us = 610.0", "max_us = 2350.0", 1470.0),
            ("A2", "min_us = 560.0", "max_us = 2420.0", 1535.0),
            ("A3", "min_us = 700.0", "max_us = 2300.0", 1500.0),
            ("A4", "min_us = 590.0", "max_us = 2460.0", 1440.0),
        ] {
            for (from, to) in [
                (least, format!("min_us = {}", neutral - 9.0)),
                (most, format!("max_us = {}", neutral + 9.0)),
            ] {
                let refused = with("unequal", &[(from, &to)]).expect_err(&to).to_string();
                assert!(
                    refused.contains("gait.walk: at phase")
                        && refused.contains(&format!("servo {servo} would be at")),
                    "{refused}"
                );
            }
        }
    }

    #[test]
    fn each_kind_of_margin_has_the_limit_of_its_kind() {
        let unequal = robot("unequal");
        for (key, kind) in [
            ("type2 = 0.32 ", &Check::TYPE2[..]),
            ("type1 = 0.27 ", &Check::TYPE1),
            ("leg = 0.38 ", &Check::LEG),
        ] {
            let name = key.split(' ').next().expect("a name");
            let least = |gait: &CheckedGait| {
                let audit = gait.audit();
                let [of] = [audit.type2, audit.type1, audit.leg]
                    .into_iter()
                    .filter(|least| kind.contains(&least.what))
                    .collect::<Vec<_>>()[..]
                else {
                    panic!("{audit:?}")
                };
                of.value
            };
            let least = unequal.gaits().iter().map(least).fold(1.0, f64::min);
            let limit = |value: f64| format!("{name} = {value:?} ");
            // The firmware's guard is exact to a thousandth or two.
            assert!(
                with("unequal", &[(key, &limit(least - 0.003))]).is_ok(),
                "{name}"
            );
            let refused = with("unequal", &[(key, &limit(least + 1e-6))]);
            let refused = refused.expect_err(name).to_string();
            assert!(refused.contains(&format!("margin {name}_")), "{refused}");
        }
    }

    #[test]
    fn what_floating_point_allows_and_the_firmwares_guard_does_not_is_refused() {
        // Within a step or two of the integers above the gaits' least margin the float
        // still agrees, and the guard of some robot does not.
        let mut refusals = Vec::new();
        for (name, key) in [
            ("paper", "leg = 0.3 "),
            ("unequal", "leg = 0.38 "),
            ("large", "type1 = 0.3 "),
            ("unequal", "type1 = 0.27 "),
        ] {
            let robot = robot(name);
            let least = |gait: &CheckedGait| {
                if key.starts_with("leg") {
                    gait.audit().leg.value
                } else {
                    gait.audit().type1.value
                }
            };
            let least = robot.gaits().iter().map(least).fold(1.0, f64::min);
            let kind = key.split(' ').next().expect("a name");
            for i in 1..10 {
                let limit = format!("{kind} = {:?} ", least - f64::from(i) * 1e-5);
                let refused = with(name, &[(key, &limit)]).err();
                refusals.extend(refused.map(|error| error.to_string()));
            }
        }
        assert!(!refusals.is_empty(), "no limit is too near");
        for refused in refusals {
            assert!(
                refused.contains(": margin or travel ")
                    && refused.ends_with("leave it a little room"),
                "{refused}"
            );
        }
    }

    #[test]
    fn what_was_found_lies_where_it_was_found() {
        for (name, robot) in all() {
            for gait in robot.gaits() {
                let audit = gait.audit();
                for least in [audit.type2, audit.type1, audit.leg] {
                    let phase = (least.phase * 65536.0) as u16;
                    let pose = gait.table_angles(phase).into();
                    let solved = robot.lizard().solve(&pose).expect("closes");
                    let (_, value) = solved
                        .conditions()
                        .find(|(what, _)| *what == least.what)
                        .expect("a condition");
                    assert_eq!(value, least.value, "{name} {}", gait.name());
                }
            }
        }
    }
}
