//! The totals of a sequence of frames.

use lizard_contact::{Place, Travel};
use lizard_kinematics::Check;

use crate::FRAME;
use crate::state::State;

/// The sums and extremes of a stretch of frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tally {
    begin: Place,
    end: Place,
    /// How many frames.
    pub frames: u64,
    /// Length of the body's way over the floor, frame by frame, mm.
    pub length: f64,
    /// How far each foot slid over the floor in all, mm.
    pub slip: [f64; 4],
    /// How far a leg was behind its servo at most, deg.
    pub lag: f64,
    /// The smallest margin and its value.
    pub margin: Option<(Check, f64)>,
    /// Least and greatest slider travel, mm; none before the first frame.
    pub stroke: Option<[f64; 2]>,
    /// The fastest turn of a servo, deg/s.
    pub rate: f64,
    /// The most that a servo was away from its pulse, deg.
    pub error: f64,
}

impl Tally {
    /// Nothing yet, from this place on.
    #[must_use]
    pub fn new(begin: Place) -> Self {
        Self {
            begin,
            end: begin,
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

    /// Takes the next frame.
    pub fn add(&mut self, state: &State) {
        let (from, to) = (self.end, state.place);
        self.length += (to.forward - from.forward).hypot(to.left - from.left);
        self.end = to;
        self.frames += 1;
        let most =
            |values: [f64; 4], most: f64| values.into_iter().map(f64::abs).fold(most, f64::max);
        self.lag = most(state.lag, self.lag);
        self.rate = most(state.rates, self.rate);
        self.error = most(state.errors, self.error);
        for (sum, slip) in self.slip.iter_mut().zip(state.slip) {
            *sum += slip;
        }
        if let Some((check, value)) = state.least_margin()
            && self.margin.is_none_or(|(_, least)| value < least)
        {
            self.margin = Some((check, value));
        }
        if let Some(strokes) = state.strokes {
            let [least, greatest] = self.stroke.unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
            self.stroke = Some([
                strokes.into_iter().fold(least, f64::min),
                strokes.into_iter().fold(greatest, f64::max),
            ]);
        }
    }

    /// Where it led, seen from where it began.
    #[must_use]
    pub fn travel(&self) -> Travel {
        self.end.seen_from(self.begin)
    }

    /// How long it took, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.frames as f64 * FRAME
    }
}
