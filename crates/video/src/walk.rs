//! A walk from one rest to the next: the cycles of one gait, and the sources of their uncertainty.

use lizard_contact::Travel;

use crate::cycles::Cycles;

/// The measured cycles of a walk, with the sources of their uncertainty.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Walk {
    pub cycles: Cycles,
    /// Variances of the mean cycle that result from the scene's covariance: forward and left, mm^2, and turn, deg^2.
    pub scene_variances: [f64; 3],
    /// Relative standard error of all lengths.
    pub scale_error: f64,
    /// The deviation of each frame from the predicted path.
    pub deviations: Vec<Deviation>,
}

impl Walk {
    /// Computes the part of the mean cycle's error that all cycles have in common: the errors of ruler, height, clock
    /// and camera. Forward and left, mm, and turn, deg.
    pub(crate) fn systematic_errors(&self) -> [f64; 3] {
        let means = mean_components(&self.cycles.travels);
        let period = self.cycles.period;
        [0, 1, 2].map(|i| {
            let scale_error = match i {
                0 | 1 => means[i] * self.scale_error,
                _ => 0.0,
            };
            let clock_error = self.cycles.calm_rate[i] * period.standard_error / period.value;
            (scale_error.powi(2) + clock_error.powi(2) + self.scene_variances[i]).sqrt()
        })
    }
}

/// The measured minus the predicted pose in a frame, both relative to the start of the cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Deviation {
    /// Index of the cycle in the walk.
    pub cycle_index: usize,
    /// Phase of the frame, 0 to 1.
    pub phase: f64,
    /// Forward and left, mm, and turn, deg.
    pub offset: [f64; 3],
}

/// Computes the means of the forward, left and turn components of movements: mm, mm, deg; 0 if there is no movement.
pub(crate) fn mean_components(travels: &[Travel]) -> [f64; 3] {
    [0, 1, 2].map(|axis| {
        let values = travels.iter().map(|travel| components(*travel)[axis]);
        values.sum::<f64>() / travels.len().max(1) as f64
    })
}

/// Returns the forward, left and turn components of a movement: mm, mm, deg.
pub(crate) fn components(travel: Travel) -> [f64; 3] {
    [travel.forward, travel.left, travel.turn]
}
