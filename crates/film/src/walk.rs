//! A walk from one rest to the next: the cycles of one gait, and the sources of their uncertainty.

use lizard_contact::Travel;

use crate::cycles::Cycles;

/// The measured cycles of a walk.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Walk {
    pub cycles: Cycles,
    /// Variances of the mean cycle that result from the covariance of the scene: forward, left, turn.
    pub scene_variances: [f64; 3],
    /// Standard error of all lengths, as a share.
    pub scale: f64,
    /// The deviation of each picture from the predicted path.
    pub deviations: Vec<Deviation>,
}

impl Walk {
    /// The errors of the mean cycle that all its cycles share: the errors of ruler and height, clock and camera.
    pub(crate) fn common_errors(&self) -> [f64; 3] {
        let movements = parts(&self.cycles.travels);
        let [period, error] = self.cycles.period;
        [0, 1, 2].map(|i| {
            let mean = movements[i].iter().sum::<f64>() / movements[i].len() as f64;
            let scale = if i < 2 { mean * self.scale } else { 0.0 };
            let clock = self.cycles.pace[i] * error / period;
            (scale.powi(2) + clock.powi(2) + self.scene_variances[i]).sqrt()
        })
    }
}

/// The place in a picture minus the predicted one, both relative to the beginning of the cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Deviation {
    /// Index of the cycle.
    pub cycle: usize,
    /// Phase of the picture, 0 to 1.
    pub phase: f64,
    /// Forward and left, mm, and turn, deg.
    pub off: [f64; 3],
}

/// Forward, left and turn of every cycle.
pub(crate) fn parts(travels: &[Travel]) -> [Vec<f64>; 3] {
    let values_of = |coordinate: fn(&Travel) -> f64| travels.iter().map(coordinate).collect();
    [
        values_of(|travel| travel.forward),
        values_of(|travel| travel.left),
        values_of(|travel| travel.turn),
    ]
}
