//! The totals of a sequence of frames.

use lizard_contact::{Place, Travel};
use lizard_kinematics::Check;

use crate::FRAME_S;
use crate::state::State;

/// The sums and extremes over a sequence of frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tally {
    start: Place,
    end: Place,
    /// Number of frames.
    pub frame_count: u64,
    /// Length of the body's path over the floor, mm.
    pub path_length: f64,
    /// Distance that each foot slid over the floor, mm.
    pub slips: [f64; 4],
    /// Largest absolute lag of a leg behind its servo, deg.
    pub max_lag: f64,
    /// Name and value of the smallest margin; `None` before the first frame whose loops close.
    pub min_margin: Option<(Check, f64)>,
    /// Smallest and largest slider travel from nominal, mm; `None` before the first frame whose loops close.
    pub stroke_range: Option<[f64; 2]>,
    /// Highest speed of a servo, deg/s.
    pub max_rate: f64,
    /// Largest difference between a servo's angle and that of its pulse, deg.
    pub max_error: f64,
}

impl Tally {
    /// Creates an empty tally that starts at this place.
    pub fn new(start: Place) -> Self {
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
        let (start, end) = (self.end, state.place);
        self.path_length += (end.forward - start.forward).hypot(end.left - start.left);
        self.end = end;
        self.frame_count += 1;
        let largest_of = |values: [f64; 4], largest: f64| {
            values.into_iter().map(f64::abs).fold(largest, f64::max)
        };
        self.max_lag = largest_of(state.lags, self.max_lag);
        self.max_rate = largest_of(state.rates, self.max_rate);
        self.max_error = largest_of(state.errors, self.max_error);
        for (sum, slip) in self.slips.iter_mut().zip(state.slips) {
            *sum += slip;
        }
        if let Some((check, value)) = state.min_margin()
            && self.min_margin.is_none_or(|(_, smallest)| value < smallest)
        {
            self.min_margin = Some((check, value));
        }
        if let Some(strokes) = state.strokes {
            let [smallest, largest] = self
                .stroke_range
                .unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
            self.stroke_range = Some([
                strokes.into_iter().fold(smallest, f64::min),
                strokes.into_iter().fold(largest, f64::max),
            ]);
        }
    }

    /// The movement of the body, in its frame at the start.
    pub fn travel(&self) -> Travel {
        self.end.travel_from(self.start)
    }

    /// Duration of the frames, s.
    pub fn seconds(&self) -> f64 {
        self.frame_count as f64 * FRAME_S
    }
}
