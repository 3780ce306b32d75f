//! Frames read back into servo angles, and what can be said about them.

use lizard_robot::Robot;
use lizard_robot::servo::{FORWARD, LEGS, NAMES};
use serde::Serialize;
use simulated_uno::{CYCLES_PER_US, FREQUENCY};

use super::frame::{FRAME, Frame};
use super::script::Script;

/// One frame as the servos understand it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Instant {
    /// Seconds since power-on.
    pub seconds: f64,
    /// Servo angles in degrees, chassis frame; `None` while the robot rests.
    pub angles: Option<[f64; 4]>,
    /// Their sweeps from neutral in degrees, foot forward positive.
    #[serde(skip)]
    pub sweeps: Option<[f64; 4]>,
}

/// What one servo got.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ServoReport {
    /// A1 to A4.
    pub servo: &'static str,
    /// Its leg: L or R, F or H for hind.
    pub leg: &'static str,
    /// Arduino number of its pin.
    pub pin: u8,
    /// Number of pulses.
    pub pulses: usize,
    /// Shortest pulse, us.
    pub min_us: f64,
    /// Longest pulse, us.
    pub max_us: f64,
    /// Worst deviation of a width from its command, cycles.
    pub width_error: Option<u64>,
    /// Worst deviation of a period from 20 ms, cycles.
    pub period_error: u64,
    /// Fastest turn from one frame to the next, deg/s.
    pub slew: f64,
}

/// The tightest moment of the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tightest {
    /// Which margin.
    pub margin: String,
    /// Its value.
    pub value: f64,
    /// When, in seconds since power-on.
    pub seconds: f64,
}

/// What the poses of the run do to the mechanism.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Safety {
    /// The smallest margin.
    pub least: Option<Tightest>,
    /// Least and largest slider travel, mm.
    pub stroke: [f64; 2],
    /// Frames that break a limit of robot.toml, with the first reason.
    pub violations: usize,
    /// The first violation in words.
    pub first_violation: Option<String>,
}

/// Where one command took the robot, by the contact model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Leg {
    /// The command in effect.
    pub command: String,
    /// From this many seconds since power-on.
    pub from: f64,
    /// To this many.
    pub to: f64,
    /// Forward, mm, seen from where it began.
    pub forward: f64,
    /// To the left, mm.
    pub left: f64,
    /// Counter-clockwise, deg.
    pub turn: f64,
}

/// Reads frames back into angles.
#[must_use]
pub fn instants(robot: &Robot, frames: &[Frame]) -> Vec<Instant> {
    let us = |width: u64| width as f64 / CYCLES_PER_US as f64;
    frames
        .iter()
        .map(|frame| {
            let turns = frame.all().map(|widths| -> [f64; 4] {
                std::array::from_fn(|i| robot.servos[i].sweep(us(widths[i])))
            });
            Instant {
                seconds: frame.start as f64 / FREQUENCY as f64,
                angles: turns
                    .map(|turns| std::array::from_fn(|i| robot.servos[i].neutral + turns[i])),
                sweeps: turns.map(|turns| std::array::from_fn(|i| turns[i] * FORWARD[i])),
            }
        })
        .collect()
}

/// Each servo's row of the table. `commands` are the widths in cycles that the
/// firmware's core asked for, frame by frame, 0 for none.
#[must_use]
pub fn servos(
    robot: &Robot,
    frames: &[Frame],
    instants: &[Instant],
    commands: Option<&[[u16; 4]]>,
) -> Vec<ServoReport> {
    let row = |i: usize| {
        let widths = || frames.iter().filter_map(move |frame| frame.widths[i]);
        let us = |width: Option<u64>| width.unwrap_or(0) as f64 / CYCLES_PER_US as f64;
        let width_error = commands.map(|commands| {
            let pairs = frames.iter().zip(commands);
            let error = |(frame, command): (&Frame, &[u16; 4])| {
                frame.widths[i].unwrap_or(0).abs_diff(u64::from(command[i]))
            };
            pairs.map(error).max().unwrap_or(0)
        });
        let periods = frames
            .windows(2)
            .filter_map(|pair| Some((pair[1].starts[i]? - pair[0].starts[i]?).abs_diff(FRAME)));
        let steps = instants
            .windows(2)
            .filter_map(|pair| Some((pair[1].angles?[i] - pair[0].angles?[i]).abs()));
        ServoReport {
            servo: NAMES[i],
            leg: LEGS[i],
            pin: robot.servos[i].pin,
            pulses: widths().count(),
            min_us: us(widths().min()),
            max_us: us(widths().max()),
            width_error,
            period_error: periods.max().unwrap_or(0),
            slew: steps.fold(0.0, f64::max) * FREQUENCY as f64 / FRAME as f64,
        }
    };
    (0..4).map(row).collect()
}

/// Solves every pose of the run.
#[must_use]
pub fn safety(robot: &Robot, instants: &[Instant]) -> Safety {
    let mut safety = Safety {
        least: None,
        stroke: [f64::INFINITY, f64::NEG_INFINITY],
        violations: 0,
        first_violation: None,
    };
    for instant in instants {
        let Some(angles) = instant.angles else {
            continue;
        };
        let broken = match robot.lizard.solve(&angles.into()) {
            Err(infeasible) => Some(infeasible.to_string()),
            Ok(solution) => {
                let (check, value) = solution.margins.min();
                if safety
                    .least
                    .as_ref()
                    .is_none_or(|least| value < least.value)
                {
                    let (margin, seconds) = (check.to_string(), instant.seconds);
                    safety.least = Some(Tightest {
                        margin,
                        value,
                        seconds,
                    });
                }
                for s in [solution.left.s, solution.right.s] {
                    safety.stroke = [safety.stroke[0].min(s), safety.stroke[1].max(s)];
                }
                robot
                    .limits
                    .violations(&solution)
                    .next()
                    .map(|violation| violation.to_string())
            }
        };
        if let Some(reason) = broken {
            safety.violations += 1;
            safety.first_violation.get_or_insert(reason);
        }
    }
    safety
}

/// The way of each command by the contact model, and of the whole run as the
/// last one. `Feet are never lifted`: see [`lizard_robot::Ground`].
#[must_use]
pub fn way(robot: &Robot, instants: &[Instant], script: &Script) -> Vec<Leg> {
    let moves = script.steps.iter().filter(|step| step.command != "status");
    let mut cuts: Vec<(f64, &str)> = vec![(0.0, "stand")];
    cuts.extend(moves.map(|step| (step.ms as f64 / 1000.0, step.command.as_str())));
    let end = script.end_ms as f64 / 1000.0;
    let leg = |command: &str, from: f64, to: f64| {
        let within = instants
            .iter()
            .filter(|at| at.seconds >= from && at.seconds < to);
        let travel = robot.ground.travel(within.filter_map(|at| at.sweeps));
        Leg {
            command: command.to_owned(),
            from,
            to,
            forward: travel.forward,
            left: travel.left,
            turn: travel.turn,
        }
    };
    let mut legs: Vec<Leg> = (0..cuts.len())
        .map(|n| {
            leg(
                cuts[n].1,
                cuts[n].0,
                cuts.get(n + 1).map_or(end, |next| next.0),
            )
        })
        .collect();
    legs.push(leg("all", 0.0, end));
    legs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn robot() -> Robot {
        Robot::parse(include_str!("../../../robot.toml")).expect("robot.toml is right")
    }

    /// The frames that servos of `angles(seconds)` would get, from second 1 on.
    fn frames_of(robot: &Robot, count: u64, angles: impl Fn(f64) -> [f64; 4]) -> Vec<Frame> {
        (0..count)
            .map(|n| {
                let angles = angles(n as f64 / 50.0);
                let width = |i: usize| (robot.servos[i].pulse(angles[i]) * 16.0).round() as u64;
                let start = FREQUENCY + n * FRAME;
                Frame {
                    start,
                    starts: std::array::from_fn(|i| Some(start + i as u64 * FRAME / 5)),
                    widths: std::array::from_fn(|i| Some(width(i))),
                }
            })
            .collect()
    }

    fn gait_frames(robot: &Robot, name: &str, count: u64) -> Vec<Frame> {
        let (_, gait) = robot.gait(name).expect("it is in robot.toml");
        frames_of(robot, count, |seconds| gait.angles(gait.phase(seconds)))
    }

    #[test]
    fn an_angle_survives_the_way_through_a_pulse() {
        let robot = robot();
        let pose = [120.0, 45.0, 300.0, 230.0];
        let instants = instants(&robot, &frames_of(&robot, 2, |_| pose));
        let angles = instants[0].angles.expect("all four have a pulse");
        for i in 0..4 {
            // Half a cycle of 62.5 ns at 10 us per degree.
            assert!(
                (angles[i] - pose[i]).abs() <= 0.0032,
                "{} {}",
                angles[i],
                pose[i]
            );
        }
        assert_eq!(instants[0].seconds, 1.0);
    }

    #[test]
    fn walking_and_turning_lead_where_the_contact_model_says() {
        let robot = robot();
        for (gait, forward, turn) in [
            ("walk", 34.16, 0.0),
            ("left", 0.0, 15.34),
            ("back", -34.16, 0.0),
        ] {
            let frames = gait_frames(&robot, gait, 51);
            let script = Script::parse(&format!("0 {gait}")).expect("it is well formed");
            let script = Script {
                end_ms: 10_000,
                ..script
            };
            let way = way(&robot, &instants(&robot, &frames), &script);
            let all = way.last().expect("the whole run");
            assert!((all.forward - forward).abs() < 0.35, "{gait}: {all:?}");
            assert!((all.turn - turn).abs() < 0.2, "{gait}: {all:?}");
        }
    }

    #[test]
    fn the_table_tells_widths_periods_slew_and_errors() {
        let robot = robot();
        let mut frames = frames_of(&robot, 3, |seconds| {
            let mut angles: [f64; 4] = robot.neutral().into();
            angles[0] += 100.0 * seconds;
            angles
        });
        frames[2].starts[1] = frames[2].starts[1].map(|start| start + 7);
        frames[1].widths[2] = frames[1].widths[2].map(|width| width - 3);
        let commands: Vec<[u16; 4]> = (0..3)
            .map(|n| [24_000 + 320 * n, 24_000, 24_000, 24_000])
            .collect();
        let rows = servos(&robot, &frames, &instants(&robot, &frames), Some(&commands));
        assert_eq!(
            (rows[0].pulses, rows[0].min_us, rows[0].max_us),
            (3, 1500.0, 1540.0)
        );
        assert!((rows[0].slew - 100.0).abs() < 0.5);
        let errors: Vec<_> = rows
            .iter()
            .map(|row| (row.width_error, row.period_error))
            .collect();
        assert_eq!(
            errors,
            [(Some(0), 0), (Some(0), 7), (Some(3), 0), (Some(0), 0)]
        );
    }

    #[test]
    fn a_pose_near_a_singularity_is_reported() {
        let robot = robot();
        let fine = safety(&robot, &instants(&robot, &gait_frames(&robot, "walk", 50)));
        assert_eq!(fine.violations, 0);
        assert!(fine.least.is_some_and(|least| least.value > 0.3));
        let bad = frames_of(&robot, 2, |_| [90.0, 90.0, 318.59, 221.41]);
        let found = safety(&robot, &instants(&robot, &bad));
        assert_eq!(found.violations, 2);
        assert!(found.first_violation.is_some());
    }
}
