//! The cost of springs and play for a gait: the lag of its legs, and its movement as a share of that with rigid
//! legs.

use lizard_contact::{Ground, Prediction};

use crate::checks::CheckedGait;

/// The comparison of a gait on legs that lag with the same gait on rigid legs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringCost {
    /// Movement of a cycle, as [`CheckedGait::predict`] returns it.
    pub movement: Prediction,
    /// Largest lag of a leg behind its servo, deg.
    pub lag: f64,
    /// Movement of a cycle divided by the movement with rigid legs: the share of the distance ahead or of the turn,
    /// whichever is smaller. `None` if the robot hardly moves on rigid legs, or if that movement depends on
    /// unmeasurable differences between the pads.
    pub share: Option<f64>,
}

/// Smallest movement of a cycle for which a share is given: mm ahead, deg of turn.
const MIN_MOVEMENT: (f64, f64) = (1.0, 0.5);

impl SpringCost {
    /// Compares a gait on this ground with the same gait on rigid legs. Returns `None` if the drive is rigid, so
    /// that legs do not lag.
    pub fn of(gait: &CheckedGait, ground: &Ground) -> Option<Self> {
        if !ground.drive.can_lag() {
            return None;
        }
        let cycle = gait.simulate_cycle(ground);
        let movement = gait.predict(&ground.rigid());
        let share_of = |lagging: f64, rigid: Option<f64>, min: f64| {
            rigid
                .filter(|rigid| rigid.abs() > min)
                .map(|rigid| lagging / rigid)
        };
        let forward_share = share_of(cycle.travel.forward, movement.forward, MIN_MOVEMENT.0);
        let turn_share = share_of(cycle.travel.turn, movement.turn, MIN_MOVEMENT.1);
        Some(Self {
            movement: movement.keep_known(cycle.travel),
            lag: cycle.lag,
            share: [forward_share, turn_share]
                .into_iter()
                .flatten()
                .reduce(f64::min),
        })
    }
}
