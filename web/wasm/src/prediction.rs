//! The prediction of a gait for the page: the displacement per cycle on the current floor, and the servos' load at each
//! pace, as a fraction of their torque-speed line.

use lizard_robot::{CheckedGait, DriveEffect, Effort, Prediction, Travel};
use lizard_twin::{ServoModel, Twin};
use serde::Serialize;
use tsify::Tsify;

/// The displacement of the body per cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Tsify)]
pub struct Displacement {
    /// Forward, mm; `None` if it is undetermined.
    pub forward: Option<f64>,
    /// To the left, mm; `None` if it is undetermined.
    pub left: Option<f64>,
    /// Counter-clockwise, deg; `None` if it is undetermined.
    pub turn: Option<f64>,
}

impl From<Travel> for Displacement {
    fn from(travel: Travel) -> Self {
        Self {
            forward: Some(travel.forward),
            left: Some(travel.left),
            turn: Some(travel.turn),
        }
    }
}

impl From<Prediction> for Displacement {
    fn from(prediction: Prediction) -> Self {
        Self {
            forward: prediction.forward,
            left: prediction.left,
            turn: prediction.turn,
        }
    }
}

/// Number of paces for which the load is predicted: the steps of the page's pace slider up to the gait's nominal pace.
const PACE_COUNT: usize = 20;

/// The prediction of a cycle of a gait.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Tsify)]
pub struct GaitPrediction {
    /// Displacement of the body per cycle.
    #[serde(flatten)]
    pub displacement: Displacement,
    /// Largest lag of a leg behind its servo, deg; `None` with rigid legs.
    pub lag: Option<f64>,
    /// Displacement as a fraction of the displacement with rigid legs; `None` with rigid legs, or if the displacement
    /// with rigid legs is zero.
    pub fraction: Option<f64>,
    /// Largest fraction of its torque-speed line that a servo uses, at each step of the pace slider; `None` with ideal
    /// servos.
    #[tsify(type = "number[] | null")]
    pub utilisations: Option<[f64; PACE_COUNT]>,
}

impl GaitPrediction {
    /// Predicts a gait with a twin's current floor and servos.
    pub fn predict(twin: &Twin, gait: &CheckedGait) -> Self {
        let ground = twin.ground();
        let effect = DriveEffect::compute(gait, ground);
        let mut prediction = effect.map_or_else(|| gait.predict(ground), |effect| effect.movement);
        let mut utilisations = None;
        if let ServoModel::Motors(motors) = twin.servo_model() {
            // The simulated travel replaces the components that can be predicted.
            prediction = prediction.keep_determined(twin.simulate_cycle(gait).travel());
            let effort = Effort::simulate(gait, ground, &motors);
            let utilisation =
                |step: usize| effort.utilisation((step + 1) as f64 / PACE_COUNT as f64, 1.0);
            utilisations = Some(std::array::from_fn(utilisation));
        }
        Self {
            displacement: prediction.into(),
            lag: effect.map(|effect| effect.max_lag),
            fraction: effect.and_then(|effect| effect.fraction_of_rigid),
            utilisations,
        }
    }
}
