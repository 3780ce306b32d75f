//! The prediction of a gait for the page: the displacement per cycle on the current floor, and the share of their
//! torque-speed line that the servos use at each pace.

use lizard_robot::{CheckedGait, Effort, Ground, Prediction, SpringCost, Travel};
use lizard_twin::{ServoModel, Twin};
use serde::Serialize;
use tsify::Tsify;

/// The displacement of the body per cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Tsify)]
pub struct Movement {
    /// Ahead, mm; `None` if it is undetermined.
    pub forward: Option<f64>,
    /// To the left, mm; `None` if it is undetermined.
    pub left: Option<f64>,
    /// Counter-clockwise, deg; `None` if it is undetermined.
    pub turn: Option<f64>,
}

impl From<Travel> for Movement {
    fn from(movement: Travel) -> Self {
        Self {
            forward: Some(movement.forward),
            left: Some(movement.left),
            turn: Some(movement.turn),
        }
    }
}

impl From<Prediction> for Movement {
    fn from(movement: Prediction) -> Self {
        let Prediction {
            forward,
            left,
            turn,
        } = movement;
        Self {
            forward,
            left,
            turn,
        }
    }
}

/// Number of steps of the page's pace slider up to the gait's own pace.
const PACE_COUNT: usize = 20;

/// The prediction of a cycle of a gait.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Tsify)]
pub struct GaitPrediction {
    /// Displacement of the body per cycle.
    #[serde(flatten)]
    pub movement: Movement,
    /// Largest lag of a leg behind its servo, deg; `None` with rigid legs.
    pub lag: Option<f64>,
    /// The displacement as a share of that with rigid legs; `None` with rigid legs, or if the displacement with rigid
    /// legs is zero.
    pub share: Option<f64>,
    /// Largest share of its torque-speed line that any servo uses, at each step of the pace slider; `None` with ideal
    /// servos.
    #[tsify(type = "number[] | null")]
    pub lines: Option<[f64; PACE_COUNT]>,
}

impl GaitPrediction {
    /// Predicts a gait with the current floor and servos of a twin.
    #[must_use]
    pub fn of(twin: &Twin, gait: &CheckedGait) -> Self {
        let prediction = Self::with_ideal_servos(gait, twin.ground());
        let ServoModel::Motors(motors) = twin.servo_model() else {
            return prediction;
        };
        let movement = prediction.movement;
        let travel = twin.simulate_cycle(gait).travel();
        let effort = Effort::of(gait, twin.ground(), &motors);
        let line_share =
            |step: usize| effort.line_share((step + 1) as f64 / PACE_COUNT as f64, 1.0);
        Self {
            movement: Movement {
                forward: movement.forward.and(Some(travel.forward)),
                left: movement.left.and(Some(travel.left)),
                turn: movement.turn.and(Some(travel.turn)),
            },
            lines: Some(std::array::from_fn(line_share)),
            ..prediction
        }
    }

    /// Predicts a gait with ideal servos.
    fn with_ideal_servos(gait: &CheckedGait, ground: &Ground) -> Self {
        let cost = SpringCost::of(gait, ground);
        let movement = cost.map_or_else(|| gait.predict(ground), |cost| cost.movement);
        Self {
            movement: movement.into(),
            lag: cost.map(|cost| cost.max_lag),
            share: cost.and_then(|cost| cost.share_of_rigid),
            lines: None,
        }
    }
}
