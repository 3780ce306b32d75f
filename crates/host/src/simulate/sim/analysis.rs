//! Servo angles computed from the pulses of frames, and the results computed from these angles.

use std::collections::HashMap;

use lizard_robot::servo::{FORWARD_TURN_SIGN, LEG_NAMES, SERVO_NAMES};
use lizard_robot::{Robot, Travel};
use serde::Serialize;
use simulated_uno::{CYCLES_PER_US, FREQUENCY};

use super::frame::{FRAME_CYCLES, Frame};
use super::frame_log::FrameLog;
use super::spans::Span;
use crate::shared::displacement::Displacement;
use crate::shared::shapes::pin_name;

/// The servo angles of one frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ServoFrame {
    /// Seconds since power-on.
    pub seconds: f64,
    /// Servo angles in the chassis frame, degrees; `None` while the robot rests.
    pub angles: Option<[f64; 4]>,
    /// Servo sweeps from neutral, degrees, positive for a foot forward; `None` while the robot rests.
    #[serde(skip)]
    pub sweeps: Option<[f64; 4]>,
}

/// The pulses of one servo; the serialized field names are the JSON keys.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ServoReport {
    /// The servo's name, `A1` to `A4`.
    pub servo: &'static str,
    /// The servo's leg: L or R for the side, then F for front or H for hind.
    pub leg: &'static str,
    /// The servo's pin, such as `D9` or `A0`.
    pub pin: String,
    /// Number of pulses.
    #[serde(rename = "pulses")]
    pub pulse_count: usize,
    /// Shortest pulse, us; 0 if there is no pulse.
    pub min_us: f64,
    /// Longest pulse, us; 0 if there is no pulse.
    pub max_us: f64,
    /// Largest deviation of a width from its command, cycles; `None` if the commands are not known.
    pub width_error: Option<u64>,
    /// Largest deviation of a period from 20 ms, cycles.
    pub period_error: u64,
    /// Largest slew rate from one frame to the next, deg/s.
    pub slew: f64,
}

/// The smallest margin in a run, and its time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MinMargin {
    /// The name of the check that has this margin.
    #[serde(rename = "margin")]
    pub check: String,
    /// The margin, a sine.
    pub value: f64,
    /// Seconds from power-on to the frame with the margin.
    pub seconds: f64,
}

/// The smallest margin, the stroke and the violations over all poses of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Safety {
    /// The smallest margin; `None` if the run has no feasible pose.
    #[serde(rename = "least")]
    pub min_margin: Option<MinMargin>,
    /// Smallest and largest slider travel, mm; infinite if the run has no feasible pose.
    pub stroke: [f64; 2],
    /// Number of frames whose pose is infeasible or violates a limit of robot.toml.
    #[serde(rename = "violations")]
    pub violation_count: usize,
    /// The reason for the first violation; `None` if there is none.
    pub first_violation: Option<String>,
}

/// The robot's displacement during one command, according to the contact model.
#[derive(Debug, Clone, Serialize)]
pub struct CommandDisplacement {
    /// The command in effect, and its time span.
    #[serde(flatten)]
    pub span: Span,
    /// The displacement during the time span.
    #[serde(flatten)]
    pub displacement: Displacement,
}

impl ServoFrame {
    /// Creates the frame that starts `seconds` after power-on from its pulse widths, cycles.
    fn from_widths(robot: &Robot, seconds: f64, widths: Option<[u64; 4]>) -> Self {
        let to_us = |width: u64| width as f64 / CYCLES_PER_US as f64;
        let offsets = widths.map(|widths| -> [f64; 4] {
            std::array::from_fn(|i| robot.servos()[i].sweep(to_us(widths[i])))
        });
        Self {
            seconds,
            angles: offsets
                .map(|offsets| std::array::from_fn(|i| robot.servos()[i].neutral + offsets[i])),
            sweeps: offsets
                .map(|offsets| std::array::from_fn(|i| offsets[i] * FORWARD_TURN_SIGN[i])),
        }
    }
}

/// Computes the servo angles of each frame from its pulse widths.
pub fn compute_servo_frames(robot: &Robot, frames: &[Frame]) -> Vec<ServoFrame> {
    let to_servo_frame = |frame: &Frame| {
        let seconds = frame.start as f64 / FREQUENCY as f64;
        ServoFrame::from_widths(robot, seconds, frame.all_widths())
    };
    frames.iter().map(to_servo_frame).collect()
}

/// The frames of a run, and the robot that received them.
#[derive(Debug, Clone, Copy)]
pub struct Run<'a> {
    /// The robot that received the frames.
    pub robot: &'a Robot,
    /// The run's frames.
    pub log: &'a FrameLog,
}

impl<'a> Run<'a> {
    /// Combines the frames of a run with the robot that received them.
    pub fn new(robot: &'a Robot, log: &'a FrameLog) -> Self {
        Self { robot, log }
    }

    /// Returns the servo angles of the frames with indices in `range`, in order.
    pub fn servo_frames_in(
        self,
        range: std::ops::Range<usize>,
    ) -> impl Iterator<Item = ServoFrame> + Clone + 'a {
        range.map(move |index| {
            let widths = self.log.widths[index];
            let has_all_widths = widths.iter().all(|width| *width > 0);
            let widths = has_all_widths.then_some(widths.map(u64::from));
            ServoFrame::from_widths(self.robot, self.log.seconds_at(index), widths)
        })
    }

    /// Returns the servo angles of all frames, in order.
    pub fn servo_frames(self) -> impl Iterator<Item = ServoFrame> + Clone + 'a {
        self.servo_frames_in(0..self.log.widths.len())
    }
}

impl Serialize for Run<'_> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.servo_frames())
    }
}

/// Computes each servo's report. `commanded_widths` are the widths in cycles that the firmware's core requested in
/// each frame, 0 for no pulse.
pub fn compute_servo_reports(
    run: Run<'_>,
    commanded_widths: Option<&[[u16; 4]]>,
) -> Vec<ServoReport> {
    let frames = &run.log.widths;
    let mut max_turns_per_frame = [0.0f64; 4];
    let angles = run.servo_frames().map(|servo_frame| servo_frame.angles);
    for (angles, next_angles) in angles.clone().zip(angles.skip(1)) {
        if let (Some(angles), Some(next_angles)) = (angles, next_angles) {
            max_turns_per_frame = std::array::from_fn(|i| {
                max_turns_per_frame[i].max((next_angles[i] - angles[i]).abs())
            });
        }
    }
    let compute_report = |i: usize| {
        let widths = || frames.iter().map(move |frame| frame[i]).filter(|w| *w > 0);
        let to_us = |width: Option<u16>| f64::from(width.unwrap_or(0)) / CYCLES_PER_US as f64;
        let width_error = commanded_widths.map(|commanded_widths| {
            let pairs = frames.iter().zip(commanded_widths);
            let errors = pairs.map(|(frame, command)| frame[i].abs_diff(command[i]));
            u64::from(errors.max().unwrap_or(0))
        });
        ServoReport {
            servo: SERVO_NAMES[i],
            leg: LEG_NAMES[i],
            pin: pin_name(run.robot.servos()[i].pin),
            pulse_count: widths().count(),
            min_us: to_us(widths().min()),
            max_us: to_us(widths().max()),
            width_error,
            period_error: run.log.max_period_error[i],
            slew: max_turns_per_frame[i] * FREQUENCY as f64 / FRAME_CYCLES as f64,
        }
    };
    (0..4).map(compute_report).collect()
}

/// Solves every pose of the run and collects the smallest margin, the stroke and the violations.
pub fn check_safety(run: Run<'_>) -> Safety {
    let mut safety = Safety {
        min_margin: None,
        stroke: [f64::INFINITY, f64::NEG_INFINITY],
        violation_count: 0,
        first_violation: None,
    };
    // A standing robot repeats its pose; consecutive equal poses are solved only once.
    let mut latest_pose: Option<([f64; 4], Option<String>)> = None;
    for servo_frame in run.servo_frames() {
        let Some(angles) = servo_frame.angles else {
            continue;
        };
        let violation = match latest_pose.take() {
            Some((previous_angles, violation)) if previous_angles == angles => violation,
            _ => safety.add_pose(run.robot, angles, servo_frame.seconds),
        };
        if let Some(reason) = &violation {
            safety.violation_count += 1;
            safety.first_violation.get_or_insert_with(|| reason.clone());
        }
        latest_pose = Some((angles, violation));
    }
    safety
}

impl Safety {
    /// Adds a pose; returns the violation if the pose is infeasible or violates a limit.
    fn add_pose(&mut self, robot: &Robot, angles: [f64; 4], seconds: f64) -> Option<String> {
        let solution = match robot.lizard().solve(&angles.into()) {
            Err(infeasible) => return Some(infeasible.to_string()),
            Ok(solution) => solution,
        };
        let (check, value) = solution.margins.min();
        let min_margin = self.min_margin.as_ref();
        if min_margin.is_none_or(|min| value < min.value) {
            self.min_margin = Some(MinMargin {
                check: check.to_string(),
                value,
                seconds,
            });
        }
        for slider_travel in [solution.left.s, solution.right.s] {
            let [min, max] = self.stroke;
            self.stroke = [min.min(slider_travel), max.max(slider_travel)];
        }
        let violation = robot.limits().violations(&solution).next();
        violation.map(|violation| violation.to_string())
    }
}

/// Computes the displacement during each command with the contact model; the last entry is the complete run. The
/// legs are rigid here, whereas in `lizard twin` they lag. A frame's displacement therefore depends only on its own
/// pulses and those of the next frame, and each pair of frames is computed only once. Feet are never lifted; see
/// [`lizard_robot::GroundContact`].
pub fn compute_command_displacements(run: Run<'_>, spans: &[Span]) -> Vec<CommandDisplacement> {
    let mut cache = HashMap::new();
    let mut total = NO_TRAVEL;
    let mut are_all_determined = [true; 3];
    let mut determined_by_command = HashMap::new();
    let mut displacements = Vec::with_capacity(spans.len() + 1);
    for span in spans {
        let mut travel = NO_TRAVEL;
        for index in run.log.index_at(span.start_s)..run.log.index_at(span.end_s) {
            let frame_travel = compute_frame_travel(run, index, &mut cache);
            travel = compose_travel(travel, frame_travel);
            total = compose_travel(total, frame_travel);
        }
        let are_determined = *determined_by_command
            .entry(span.command.as_str())
            .or_insert_with(|| find_determined_components(run.robot, &span.command));
        are_all_determined = std::array::from_fn(|i| are_all_determined[i] && are_determined[i]);
        displacements.push(CommandDisplacement {
            span: span.clone(),
            displacement: Displacement::from_travel(travel, are_determined),
        });
    }
    let end_s = spans.last().map_or(0.0, |span| span.end_s);
    displacements.push(CommandDisplacement {
        span: Span::new("all", 0.0, end_s),
        displacement: Displacement::from_travel(total, are_all_determined),
    });
    displacements
}

/// Returns true for each component of a command's displacement (forward, left, turn) that the contact model determines.
/// A component is not determined if it depends on a tie: two feet pull with equal force against the other two.
fn find_determined_components(robot: &Robot, command: &str) -> [bool; 3] {
    robot.find_gait_in_line(command).map_or([true; 3], |gait| {
        Displacement::from(robot.predict(gait)).are_determined()
    })
}

/// The travel of a standing robot.
const NO_TRAVEL: Travel = Travel {
    forward: 0.0,
    left: 0.0,
    turn: 0.0,
};

/// Computes the displacement from frame `index` to the next; zero while the robot rests, and for the last frame.
/// `cache` has the displacements by the pulse widths of both frames, because a gait repeats its frames.
fn compute_frame_travel(
    run: Run<'_>,
    index: usize,
    cache: &mut HashMap<[[u16; 4]; 2], Travel>,
) -> Travel {
    /// Largest number of frame pairs in the cache, a few megabytes.
    const MAX_CACHED_PAIRS: usize = 100_000;
    let frames = &run.log.widths;
    let Some(next) = frames.get(index + 1) else {
        return NO_TRAVEL;
    };
    let pair = [frames[index], *next];
    if let Some(travel) = cache.get(&pair) {
        return *travel;
    }
    let servo_frames = run.servo_frames_in(index..index + 2);
    let sweeps = servo_frames.filter_map(|servo_frame| servo_frame.sweeps);
    let travel = run.robot.ground().with_rigid_drive().compute_travel(sweeps);
    if cache.len() < MAX_CACHED_PAIRS {
        cache.insert(pair, travel);
    }
    travel
}

/// Composes two displacements; `second` is relative to the end of `first`.
fn compose_travel(first: Travel, second: Travel) -> Travel {
    let (sin, cos) = first.turn.to_radians().sin_cos();
    Travel {
        forward: first.forward + cos * second.forward - sin * second.left,
        left: first.left + sin * second.forward + cos * second.left,
        turn: first.turn + second.turn,
    }
}

#[cfg(test)]
mod tests;
