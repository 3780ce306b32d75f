//! Replays the pulses of a run on the simulated robot, frame by frame.

use std::ops::Range;

use lizard_robot::{BodyPose, CheckedGait, Robot};
use lizard_twin::{FRAME_PERIOD_S, ServoModel, State, Totals, Twin};
use simulated_uno::CYCLES_PER_US;

use crate::simulate::sim::frame_log::FrameLog;
use crate::simulate::sim::spans::Span;

/// A run replayed on the simulated robot.
pub struct Replay {
    /// The robot that the pulses move.
    pub robot: Robot,
    /// Seconds from power-on to the first frame.
    pub start_s: f64,
    /// The robot's state after each frame.
    pub states: Vec<State>,
    /// The run's stages, one for each command, in order.
    pub stages: Vec<Stage>,
}

/// A stage of a run: the frames during one command.
pub struct Stage {
    /// The command, as it was sent.
    pub command: String,
    /// The indices of the stage's frames.
    pub frames: Range<usize>,
}

impl Replay {
    /// Simulates the robot with the pulses of a run. `spans` are the run's commands.
    pub fn simulate(robot: &Robot, log: &FrameLog, spans: Vec<Span>, model: ServoModel) -> Self {
        let to_us = |width: u16| (width > 0).then(|| f64::from(width) / CYCLES_PER_US as f64);
        let mut twin = Twin::new(robot, model);
        let states = log
            .widths
            .iter()
            .map(|widths| twin.simulate_pulses(widths.map(to_us)));
        let to_stage = |span: Span| Stage {
            frames: log.index_at(span.start_s)..log.index_at(span.end_s),
            command: span.command,
        };
        Self {
            robot: robot.clone(),
            start_s: log.seconds_at(0),
            states: states.collect(),
            stages: spans.into_iter().map(to_stage).collect(),
        }
    }

    /// Computes the totals of a range of frames.
    pub fn compute_totals(&self, frames: Range<usize>) -> Totals {
        let start_pose = match frames.start {
            0 => BodyPose::START,
            first_frame => self.states[first_frame - 1].body_pose,
        };
        let mut totals = Totals::new(start_pose);
        for state in &self.states[frames] {
            totals.add(state);
        }
        totals
    }

    /// Returns a stage's gait and the frame indices of the gait's last complete cycle. `None` unless the stage's
    /// command is a moving gait that ran for at least two cycles.
    pub fn find_last_cycle(&self, stage: &Stage) -> Option<(&CheckedGait, Range<usize>)> {
        let gait = self
            .robot
            .gait(&stage.command)
            .filter(|gait| gait.has_movement())?;
        let frames_per_cycle = (gait.period() / FRAME_PERIOD_S).round() as usize;
        let start_frame = stage.frames.end.checked_sub(frames_per_cycle)?;
        (start_frame >= stage.frames.start + frames_per_cycle)
            .then_some((gait, start_frame..stage.frames.end))
    }
}
