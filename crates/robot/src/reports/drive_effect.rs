//! The effect of springs and play on a gait: the lag of its legs, and its displacement as a fraction of the
//! displacement with rigid legs.

use lizard_contact::{GroundContact, Prediction};

use crate::checks::CheckedGait;

/// The comparison of a gait with legs that lag and the same gait with rigid legs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveEffect {
    /// Displacement over a cycle with legs that lag. A component is `None` if [`CheckedGait::predict`] leaves it
    /// undetermined.
    pub movement: Prediction,
    /// Largest lag of a leg behind its servo, deg.
    pub max_lag: f64,
    /// Displacement over a cycle divided by the displacement with rigid legs: the fraction of the forward distance or
    /// the fraction of the turn, whichever is smaller. `None` if the robot hardly moves with rigid legs, or if its
    /// displacement with rigid legs depends on differences between the pads that cannot be measured.
    pub fraction_of_rigid: Option<f64>,
}

/// Smallest distance per cycle with rigid legs for which a fraction is computed, mm.
const MIN_DISTANCE_MM: f64 = 1.0;
/// Smallest turn per cycle with rigid legs for which a fraction is computed, deg.
const MIN_TURN_DEG: f64 = 0.5;

impl DriveEffect {
    /// Compares a gait on this ground with the same gait with rigid legs. Returns `None` if the drive is rigid, so that
    /// the legs do not lag.
    pub fn compute(gait: &CheckedGait, ground: &GroundContact) -> Option<Self> {
        if !ground.drive.can_lag() {
            return None;
        }
        let cycle = gait.simulate_cycle(ground);
        let rigid_prediction = gait.predict(&ground.with_rigid_drive());
        let divide = |lagging: f64, rigid: Option<f64>, min: f64| {
            rigid
                .filter(|rigid| rigid.abs() > min)
                .map(|rigid| lagging / rigid)
        };
        let travel = cycle.travel;
        let forward_fraction = divide(travel.forward, rigid_prediction.forward, MIN_DISTANCE_MM);
        let turn_fraction = divide(travel.turn, rigid_prediction.turn, MIN_TURN_DEG);
        Some(Self {
            movement: rigid_prediction.keep_determined(travel),
            max_lag: cycle.max_lag,
            fraction_of_rigid: [forward_fraction, turn_fraction]
                .into_iter()
                .flatten()
                .reduce(f64::min),
        })
    }
}
