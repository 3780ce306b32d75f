//! Stored displacements from the last run of the contact model and MuJoCo.

use std::collections::BTreeMap;

use lizard_robot::Travel;
use serde::{Deserialize, Serialize};

use crate::case::{Case, FootSetup};
use crate::text;

/// A displacement in one cycle: mm forward, mm to the left, deg counter-clockwise; rounded to two decimals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Displacement(pub [f64; 3]);

impl Displacement {
    /// Returns the differences from another displacement: the distance, mm, and the turn, deg.
    pub fn compute_difference(self, other: Self) -> (f64, f64) {
        let [a, b] = [self.0, other.0];
        ((a[0] - b[0]).hypot(a[1] - b[1]), (a[2] - b[2]).abs())
    }
}

impl From<[f64; 3]> for Displacement {
    fn from(displacement: [f64; 3]) -> Self {
        // Adding 0 turns -0 into 0.
        Self(displacement.map(|component| (100.0 * component).round() / 100.0 + 0.0))
    }
}

impl From<Travel> for Displacement {
    fn from(displacement: Travel) -> Self {
        Self::from([displacement.forward, displacement.left, displacement.turn])
    }
}

/// The displacements that the contact model and MuJoCo compute for one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DisplacementPair {
    /// The contact model's displacement. `None` if two feet pull against the other two: the result would depend on the
    /// smallest difference between the pads.
    pub model: Option<Displacement>,
    /// MuJoCo's displacement of the robot that `lizard model` writes.
    pub mujoco: Displacement,
}

/// The allowed difference between MuJoCo and the model with level feet: that of the distance in mm, or as a fraction
/// of the distance if this is larger, and that of the turn in deg.
const LEVEL_FEET_TOLERANCE: (f64, f64, f64) = (1.5, 0.08, 1.0);
/// The allowed difference with one foot too long on leaves as in robot.toml.
const LONG_FOOT_TOLERANCE: (f64, f64, f64) = (2.5, 0.08, 1.5);
/// The allowed difference with one foot too long on stiff leaves, where hundredths of a mm decide which feet stick.
const LONG_STIFF_FOOT_TOLERANCE: (f64, f64, f64) = (5.0, 0.35, 4.0);
/// The model's displacement below which MuJoCo may differ by [`STANDSTILL_TOLERANCE_MM`]. The robot then moves nearly
/// equally fast in both directions, and the result depends on inertia.
const STANDSTILL_MM: f64 = 1.0;
const STANDSTILL_DEG: f64 = 0.5;
const STANDSTILL_TOLERANCE_MM: f64 = 3.5;

impl DisplacementPair {
    /// Returns the allowed difference between MuJoCo and the model, mm and deg.
    pub fn allowed_difference(&self, case: Case) -> (f64, f64) {
        let (mm, fraction, deg) = match case.feet {
            FootSetup::Level => LEVEL_FEET_TOLERANCE,
            FootSetup::Long => LONG_FOOT_TOLERANCE,
            FootSetup::LongStiff => LONG_STIFF_FOOT_TOLERANCE,
        };
        let [forward, left, turn] = self.model.unwrap_or_default().0;
        let distance = forward.hypot(left);
        match distance < STANDSTILL_MM && turn.abs() < STANDSTILL_DEG {
            true => (mm.max(STANDSTILL_TOLERANCE_MM), deg),
            false => (mm.max(fraction * distance), deg),
        }
    }

    /// Returns a message if MuJoCo and the model differ by more than allowed; `None` if they agree, or if the model has
    /// no displacement.
    pub fn describe_disagreement(&self, case: Case) -> Option<String> {
        let (distance_error, turn_error) = self.mujoco.compute_difference(self.model?);
        let (mm, deg) = self.allowed_difference(case);
        (distance_error > mm || turn_error > deg).then(|| {
            format!(
                "MuJoCo differs from the model by {distance_error:.1} mm and {turn_error:.1} deg; \
                 allowed: {mm:.1} mm and {deg:.1} deg"
            )
        })
    }
}

/// MuJoCo's displacements by group and name. These are, depending on the table: assumption and gait, pad shape and
/// surface, or gait and surface.
pub type GroupedDisplacements = BTreeMap<String, BTreeMap<String, Displacement>>;

/// The results by robot, gait and case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct WalkResults(BTreeMap<String, BTreeMap<String, BTreeMap<String, DisplacementPair>>>);

impl WalkResults {
    /// Loads the results stored in `walks.json`.
    ///
    /// # Panics
    /// If `walks.json` does not have the format of the results.
    pub fn load_stored() -> Self {
        text::load_stored("walks.json")
    }

    /// Returns the results for a robot's gait in a case; `None` if no results are stored.
    pub fn get(&self, robot: &str, gait: &str, case: Case) -> Option<&DisplacementPair> {
        self.0.get(robot)?.get(gait)?.get(&case.to_string())
    }

    /// Stores the results for a robot's gait in a case.
    pub fn store(&mut self, robot: &str, gait: &str, case: Case, results: DisplacementPair) {
        let gaits = self.0.entry(robot.to_owned()).or_default();
        let cases = gaits.entry(gait.to_owned()).or_default();
        cases.insert(case.to_string(), results);
    }

    /// Returns the number of walks.
    pub fn walk_count(&self) -> usize {
        let gaits = self.0.values().flat_map(BTreeMap::values);
        gaits.map(BTreeMap::len).sum()
    }
}
