//! The cost of springs and play for a gait: the lag of its legs, and its movement as a share of the movement with
//! rigid legs.

use lizard_contact::{Ground, Prediction};

use crate::checks::CheckedGait;

/// The comparison of a gait on legs that lag with the same gait on rigid legs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringCost {
    /// Movement of a cycle on the legs that lag. A component is `None` if [`CheckedGait::predict`] leaves it undecided.
    pub movement: Prediction,
    /// Largest lag of a leg behind its servo, deg.
    pub max_lag: f64,
    /// Movement of a cycle divided by the movement with rigid legs: the share of the distance ahead or the share of the
    /// turn, whichever is smaller. `None` if the robot hardly moves on rigid legs, or if its movement on rigid legs
    /// depends on differences between the pads that cannot be measured.
    pub share_of_rigid: Option<f64>,
}

/// Smallest distance of a cycle on rigid legs for which a share is given, mm.
const MIN_DISTANCE_MM: f64 = 1.0;
/// Smallest turn of a cycle on rigid legs for which a share is given, deg.
const MIN_TURN_DEG: f64 = 0.5;

impl SpringCost {
    /// Compares a gait on this ground with the same gait on rigid legs. Returns `None` if the drive is rigid, so
    /// that legs do not lag.
    pub fn of(gait: &CheckedGait, ground: &Ground) -> Option<Self> {
        if !ground.drive.can_lag() {
            return None;
        }
        let cycle = gait.simulate_cycle(ground);
        let rigid_prediction = gait.predict(&ground.with_rigid_drive());
        let share_of = |lagging: f64, rigid: Option<f64>, min: f64| {
            rigid
                .filter(|rigid| rigid.abs() > min)
                .map(|rigid| lagging / rigid)
        };
        let forward_share = share_of(
            cycle.travel.forward,
            rigid_prediction.forward,
            MIN_DISTANCE_MM,
        );
        let turn_share = share_of(cycle.travel.turn, rigid_prediction.turn, MIN_TURN_DEG);
        Some(Self {
            movement: rigid_prediction.known_components_of(cycle.travel),
            max_lag: cycle.max_lag,
            share_of_rigid: [forward_share, turn_share]
                .into_iter()
                .flatten()
                .reduce(f64::min),
        })
    }
}
