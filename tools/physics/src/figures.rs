//! Stored displacements that the contact model and MuJoCo gave in their last run.

use std::collections::BTreeMap;

use lizard_robot::Travel;
use serde::{Deserialize, Serialize};

use crate::case::{Case, Feet};

/// A displacement in one cycle: mm forward, mm to the left, deg counter-clockwise; two decimals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Displacement(pub [f64; 3]);

impl Displacement {
    /// Returns the distance to another displacement, mm, and the difference of the turns, deg.
    pub fn distance_to(&self, other: &Self) -> (f64, f64) {
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

/// The displacements in one cycle that the contact model and MuJoCo compute.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answers {
    /// The contact model's displacement; `None` if two feet pull against the other two, so that the
    /// smallest difference between the pads decides.
    pub model: Option<Displacement>,
    /// MuJoCo's displacement, for the robot as `lizard model` writes it.
    pub mujoco: Displacement,
}

/// Allowed differences between MuJoCo and the model: mm or, if larger, a share of the distance; and
/// deg. `LEVEL` is for level feet, `SOFT_FOOT_TOLERANCE` and `STIFF` for one foot too long: on soft leaves, and on
/// stiff leaves, where a few hundredths of a mm decide which feet stick.
const LEVEL_FEET_TOLERANCE: (f64, f64, f64) = (1.5, 0.08, 1.0);
const SOFT_FOOT_TOLERANCE: (f64, f64, f64) = (2.5, 0.08, 1.5);
const STIFF_FOOT_TOLERANCE: (f64, f64, f64) = (5.0, 0.35, 4.0);
/// If a gait moves less than this in the model, mm and deg, MuJoCo may differ by
/// [`STANDSTILL_TOLERANCE_MM`]: the robot moves nearly equally fast in both directions, so that
/// inertia decides.
const STANDSTILL_LIMITS: (f64, f64) = (1.0, 0.5);
const STANDSTILL_TOLERANCE_MM: f64 = 3.5;

impl Answers {
    /// Returns the allowed difference between MuJoCo and the model, mm and deg.
    pub fn bound(&self, case: Case) -> (f64, f64) {
        let (mm, share, deg) = match case.feet {
            Feet::Level => LEVEL_FEET_TOLERANCE,
            Feet::Soft => SOFT_FOOT_TOLERANCE,
            Feet::Stiff => STIFF_FOOT_TOLERANCE,
        };
        let [ahead, left, turn] = self.model.unwrap_or_default().0;
        let displacement = ahead.hypot(left);
        match displacement < STANDSTILL_LIMITS.0 && turn.abs() < STANDSTILL_LIMITS.1 {
            true => (mm.max(STANDSTILL_TOLERANCE_MM), deg),
            false => (mm.max(share * displacement), deg),
        }
    }

    /// Returns a message if MuJoCo and the model differ by more than allowed; otherwise, or if the model has no
    /// displacement, `None`.
    pub fn disagreement(&self, case: Case) -> Option<String> {
        let (error, turn_error) = self.mujoco.distance_to(&self.model?);
        let (mm, deg) = self.bound(case);
        (error > mm || turn_error > deg).then(|| {
            format!(
                "MuJoCo is {error:.1} mm and {turn_error:.1} deg from the model; {mm:.1} and {deg:.1} are allowed"
            )
        })
    }
}

/// The answers by robot, gait and case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Figures(BTreeMap<String, BTreeMap<String, BTreeMap<String, Answers>>>);

impl Figures {
    /// Returns the figures stored in `figures.json`.
    ///
    /// # Panics
    /// If `figures.json` is not as [`Figures::text`] makes it.
    pub fn stored() -> Self {
        serde_json::from_str(include_str!("../figures.json")).expect("figures.json")
    }

    /// Returns the text of `figures.json`: a line for each walk.
    ///
    /// # Panics
    /// Never: names and numbers can always be written as JSON.
    pub fn text(&self) -> String {
        let json_object = |lines: Vec<String>| format!("{{\n{}\n}}", lines.join(",\n"));
        let robots = self.0.iter().map(|(robot, gaits)| {
            let gaits = gaits.iter().map(|(gait, cases)| {
                let cases = cases.iter().map(|(case, answers)| {
                    let answers = serde_json::to_string(answers).expect("numbers");
                    format!("{case:?}: {answers}")
                });
                format!("{gait:?}: {}", json_object(cases.collect()))
            });
            format!("{robot:?}: {}", json_object(gaits.collect()))
        });
        json_object(robots.collect()) + "\n"
    }

    /// Returns the answers for a robot's gait in a case; `None` if none are stored.
    pub fn get(&self, robot: &str, gait: &str, case: Case) -> Option<&Answers> {
        self.0.get(robot)?.get(gait)?.get(&case.to_string())
    }

    /// Stores the answers for a robot's gait in a case.
    pub fn store(&mut self, robot: &str, gait: &str, case: Case, answers: Answers) {
        let gaits = self.0.entry(robot.to_owned()).or_default();
        let cases = gaits.entry(gait.to_owned()).or_default();
        cases.insert(case.to_string(), answers);
    }

    /// Returns the number of walks.
    pub fn count(&self) -> usize {
        let gaits = self.0.values().flat_map(BTreeMap::values);
        gaits.map(BTreeMap::len).sum()
    }
}
