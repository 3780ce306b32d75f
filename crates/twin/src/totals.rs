//! The totals and extremes of a sequence of frames.

use lizard_contact::{BodyPose, Travel};
use lizard_kinematics::Check;

use crate::FRAME_PERIOD_S;
use crate::state::State;

/// The sums and extremes over a sequence of frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Totals {
    start: BodyPose,
    end: BodyPose,
    /// Number of frames.
    pub frame_count: u64,
    /// Length of the body's path over the floor, mm.
    pub path_length: f64,
    /// Slip distance of each foot on the floor, mm.
    pub slips: [f64; 4],
    /// Largest absolute lag of a leg behind its servo, deg.
    pub max_lag: f64,
    /// Check and value of the smallest margin; `None` before the first frame whose loops close.
    pub min_margin: Option<(Check, f64)>,
    /// Smallest and largest slider travel from nominal, mm; `None` before the first frame whose loops close.
    pub stroke_range: Option<[f64; 2]>,
    /// Largest absolute servo speed, deg/s.
    pub max_rate: f64,
    /// Largest absolute servo error, deg.
    pub max_error: f64,
}

impl Totals {
    /// Creates the totals of no frames; the first frame starts at `start`.
    pub fn new(start: BodyPose) -> Self {
        Self {
            start,
            end: start,
            frame_count: 0,
            path_length: 0.0,
            slips: [0.0; 4],
            max_lag: 0.0,
            min_margin: None,
            stroke_range: None,
            max_rate: 0.0,
            max_error: 0.0,
        }
    }

    /// Adds the next frame.
    pub fn add(&mut self, state: &State) {
        let (start, end) = (self.end, state.body_pose);
        self.path_length += (end.forward - start.forward).hypot(end.left - start.left);
        self.end = end;
        self.frame_count += 1;
        let max_abs = |previous: f64, values: [f64; 4]| {
            values.into_iter().map(f64::abs).fold(previous, f64::max)
        };
        self.max_lag = max_abs(self.max_lag, state.lags);
        self.max_rate = max_abs(self.max_rate, state.rates);
        self.max_error = max_abs(self.max_error, state.errors);
        for (sum, slip) in self.slips.iter_mut().zip(state.slips) {
            *sum += slip;
        }
        if let Some((check, value)) = state.margins.map(|margins| margins.min())
            && self.min_margin.is_none_or(|(_, min)| value < min)
        {
            self.min_margin = Some((check, value));
        }
        if let Some([left, right]) = state.strokes {
            let [min, max] = self.stroke_range.unwrap_or([left; 2]);
            self.stroke_range = Some([min.min(left).min(right), max.max(left).max(right)]);
        }
    }

    /// The body's movement, in the body's frame at the start.
    pub fn travel(&self) -> Travel {
        self.end.travel_from(self.start)
    }

    /// Duration of the frames, s.
    pub fn duration_s(&self) -> f64 {
        self.frame_count as f64 * FRAME_PERIOD_S
    }
}
