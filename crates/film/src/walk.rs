//! A walk from one rest to the next: the cycles of one gait, and the sources of their uncertainty.

use lizard_contact::Travel;

use crate::cycles::Cycles;

/// The measured cycles of a walk.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Walk {
    pub cycles: Cycles,
    /// Variances of the mean cycle that result from the covariance of the scene: forward and left, mm^2, and turn,
    /// deg^2.
    pub scene_variances: [f64; 3],
    /// Standard error of all lengths, as a share.
    pub scale_error: f64,
    /// The deviation of each picture from the predicted path.
    pub deviations: Vec<Deviation>,
}

impl Walk {
    /// The part of the mean cycle's error that all cycles share: the errors of ruler and height, of clock, and of
    /// camera. Forward and left, mm, and turn, deg.
    pub(crate) fn systematic_errors(&self) -> [f64; 3] {
        let components = travel_components(&self.cycles.travels);
        let period = self.cycles.period;
        [0, 1, 2].map(|i| {
            let mean = components[i].iter().sum::<f64>() / components[i].len() as f64;
            let scale_error = if i < 2 { mean * self.scale_error } else { 0.0 };
            let clock_error = self.cycles.calm_rate[i] * period.error / period.value;
            (scale_error.powi(2) + clock_error.powi(2) + self.scene_variances[i]).sqrt()
        })
    }
}

/// The measured place in a picture minus the predicted one, both relative to the start of the cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Deviation {
    /// Index of the cycle in the walk.
    pub cycle: usize,
    /// Phase of the picture, 0 to 1.
    pub phase: f64,
    /// Forward and left, mm, and turn, deg.
    pub offset: [f64; 3],
}

/// The forward, left and turn components of every cycle: mm, mm, deg.
pub(crate) fn travel_components(travels: &[Travel]) -> [Vec<f64>; 3] {
    let values_of = |coordinate: fn(&Travel) -> f64| travels.iter().map(coordinate).collect();
    [
        values_of(|travel| travel.forward),
        values_of(|travel| travel.left),
        values_of(|travel| travel.turn),
    ]
}
