//! The totals of a sequence of frames.

use lizard_contact::{Place, Travel};
use lizard_kinematics::Check;

use crate::FRAME;
use crate::state::State;

/// The sums and extremes over a sequence of frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tally {
    begin: Place,
    end: Place,
    /// Number of frames.
    pub frames: u64,
    /// Length of the body's path over the floor, mm.
    pub length: f64,
    /// Distance that each foot slid over the floor, mm.
    pub slip: [f64; 4],
    /// Largest absolute lag of a leg behind its servo, deg.
    pub lag: f64,
    /// Name and value of the smallest margin; `None` before the first frame whose loops close.
    pub margin: Option<(Check, f64)>,
    /// Smallest and greatest slider travel, mm; `None` before the first frame whose loops close.
    pub stroke: Option<[f64; 2]>,
    /// Highest speed of a servo, deg/s.
    pub rate: f64,
    /// Largest difference between a servo's angle and that of its pulse, deg.
    pub error: f64,
}

impl Tally {
    /// Returns a tally of no frames that starts at this place.
    pub fn new(start: Place) -> Self {
        Self {
            begin: start,
            end: start,
            frames: 0,
            length: 0.0,
            slip: [0.0; 4],
            lag: 0.0,
            margin: None,
            stroke: None,
            rate: 0.0,
            error: 0.0,
        }
    }

    /// Adds the next frame.
    pub fn add(&mut self, state: &State) {
        let (from, to) = (self.end, state.place);
        self.length += (to.forward - from.forward).hypot(to.left - from.left);
        self.end = to;
        self.frames += 1;
        let largest_of = |values: [f64; 4], largest: f64| {
            values.into_iter().map(f64::abs).fold(largest, f64::max)
        };
        self.lag = largest_of(state.lag, self.lag);
        self.rate = largest_of(state.rates, self.rate);
        self.error = largest_of(state.errors, self.error);
        for (sum, slip) in self.slip.iter_mut().zip(state.slip) {
            *sum += slip;
        }
        if let Some((check, value)) = state.least_margin()
            && self.margin.is_none_or(|(_, smallest)| value < smallest)
        {
            self.margin = Some((check, value));
        }
        if let Some(strokes) = state.strokes {
            let [smallest, greatest] = self.stroke.unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
            self.stroke = Some([
                strokes.into_iter().fold(smallest, f64::min),
                strokes.into_iter().fold(greatest, f64::max),
            ]);
        }
    }

    /// The movement of the body, seen from its start.
    pub fn travel(&self) -> Travel {
        self.end.travel_from(self.begin)
    }

    /// Duration of the frames, s.
    pub fn seconds(&self) -> f64 {
        self.frames as f64 * FRAME
    }
}
