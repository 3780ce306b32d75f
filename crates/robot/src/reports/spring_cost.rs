//! The cost of springs and play to a gait: the lag of its legs, and its distance as a share of
//! that with rigid legs.

use lizard_contact::{Ground, Prediction};

use crate::checks::CheckedGait;

/// A gait on legs that lag, compared with the same gait on rigid ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringCost {
    /// Movement of a cycle, as [`CheckedGait::predict`] has it.
    pub movement: Prediction,
    /// Largest lag of a leg behind its servo, deg.
    pub lag: f64,
    /// Movement of a cycle over that of rigid legs: ahead, or the turn of a gait that turns on
    /// the spot, or the smaller of both. `None` if rigid legs go nowhere, or their movement depends
    /// on ties.
    pub share: Option<f64>,
}

/// Smallest movement of a cycle that counts: mm ahead, deg of turn.
const MIN_MOVEMENT: (f64, f64) = (1.0, 0.5);

impl SpringCost {
    /// Compares a gait on this ground with the same gait on rigid legs; `None` if legs do not lag.
    pub fn of(gait: &CheckedGait, ground: &Ground) -> Option<Self> {
        if !ground.drive.lags() {
            return None;
        }
        let walked = gait.walked(ground);
        let movement = gait.predict(&ground.rigid());
        let part = |lagging: f64, rigid: Option<f64>, smallest: f64| {
            rigid
                .filter(|rigid| rigid.abs() > smallest)
                .map(|rigid| lagging / rigid)
        };
        let forward_share = part(walked.travel.forward, movement.forward, MIN_MOVEMENT.0);
        let turn = part(walked.travel.turn, movement.turn, MIN_MOVEMENT.1);
        Some(Self {
            movement: movement.keep_known(walked.travel),
            lag: walked.lag,
            share: [forward_share, turn].into_iter().flatten().reduce(f64::min),
        })
    }
}
