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
    /// The run's pulses.
    pub log: FrameLog,
    /// The robot's state after each frame.
    pub states: Vec<State>,
    /// The run's commands and their time spans, in order.
    pub spans: Vec<Span>,
}

impl Replay {
    /// Simulates the robot with the pulses of a run. `spans` are the run's commands and their time spans.
    pub fn simulate(robot: &Robot, log: FrameLog, spans: Vec<Span>, model: ServoModel) -> Self {
        let to_us = |width: u16| (width > 0).then(|| f64::from(width) / CYCLES_PER_US as f64);
        let mut twin = Twin::new(robot, model);
        let frames = log.widths.iter();
        let states = frames.map(|widths| twin.simulate_pulses(widths.map(to_us)));
        Self {
            robot: robot.clone(),
            states: states.collect(),
            log,
            spans,
        }
    }

    /// Returns the indices of the frames during a command.
    pub fn frame_range(&self, span: &Span) -> Range<usize> {
        self.log.index_at(span.start_s)..self.log.index_at(span.end_s)
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

    /// Returns a command's gait and the frame indices of the gait's last complete cycle, whose length is rounded to
    /// whole frames. `None` unless the command is a moving gait, without a count, that ran for at least two cycles: a
    /// gait with a count brakes in its last cycle.
    pub fn find_last_cycle(&self, span: &Span) -> Option<(&CheckedGait, Range<usize>)> {
        let gait = self.robot.gait(&span.command);
        let gait = gait.filter(|gait| gait.has_movement())?;
        let frames = self.frame_range(span);
        let frames_per_cycle = (gait.period() / FRAME_PERIOD_S).round() as usize;
        let start_frame = frames.end.checked_sub(frames_per_cycle)?;
        (start_frame >= frames.start + frames_per_cycle).then_some((gait, start_frame..frames.end))
    }
}
