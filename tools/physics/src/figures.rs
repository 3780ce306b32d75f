//! The figures of the model and of MuJoCo from their last run.

use std::collections::BTreeMap;

use lizard_robot::Travel;
use serde::{Deserialize, Serialize};

use crate::case::{Case, Feet};

/// Where a cycle leads: mm forward, mm to the left, deg counter-clockwise; in hundredths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Way(pub [f64; 3]);

impl Way {
    /// How far two of them are apart: mm and deg.
    #[must_use]
    pub fn off(&self, other: &Self) -> (f64, f64) {
        let [a, b] = [self.0, other.0];
        ((a[0] - b[0]).hypot(a[1] - b[1]), (a[2] - b[2]).abs())
    }
}

impl From<[f64; 3]> for Way {
    fn from(way: [f64; 3]) -> Self {
        // And without a minus before 0.
        Self(way.map(|part| (100.0 * part).round() / 100.0 + 0.0))
    }
}

impl From<Travel> for Way {
    fn from(way: Travel) -> Self {
        Self::from([way.forward, way.left, way.turn])
    }
}

/// The figures of a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Said {
    /// By the contact model; none where two feet pull against two, so that the smallest
    /// difference between the pads decides.
    pub model: Option<Way>,
    /// By MuJoCo: the robot as `lizard mjcf` writes it.
    pub mujoco: Way,
}

/// MuJoCo may differ from the model by this many mm, or by this share of the way, or by so
/// many deg: with level feet; with one that is too long on leaves that give; and on stiff
/// ones, where a few hundredths of a mm decide which feet hold.
const LEVEL: (f64, f64, f64) = (1.5, 0.08, 1.0);
const SOFT: (f64, f64, f64) = (2.5, 0.08, 1.5);
const STIFF: (f64, f64, f64) = (5.0, 0.35, 4.0);
/// A gait that leads nowhere by the model, mm and deg, may creep so far, mm: what it does to
/// and fro is nearly as fast both ways, and inertia decides.
const NOWHERE: (f64, f64) = (1.0, 0.5);
const CREEPS: f64 = 3.5;

impl Said {
    /// How far MuJoCo may be from the model, mm and deg.
    #[must_use]
    pub fn bound(&self, case: Case) -> (f64, f64) {
        let (mm, share, deg) = match case.feet {
            Feet::Level => LEVEL,
            Feet::Soft => SOFT,
            Feet::Stiff => STIFF,
        };
        let [ahead, left, turn] = self.model.unwrap_or_default().0;
        let way = ahead.hypot(left);
        match way < NOWHERE.0 && turn.abs() < NOWHERE.1 {
            true => (mm.max(CREEPS), deg),
            false => (mm.max(share * way), deg),
        }
    }

    /// The words for MuJoCo if it is further off.
    #[must_use]
    pub fn parted(&self, case: Case) -> Option<String> {
        let (off, turned) = self.mujoco.off(&self.model?);
        let (mm, deg) = self.bound(case);
        (off > mm || turned > deg).then(|| {
            format!(
                "MuJoCo is {off:.1} mm and {turned:.1} deg from the model; {mm:.1} and {deg:.1} are allowed"
            )
        })
    }
}

/// Of each robot and gait, by the case's name.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Figures(BTreeMap<String, BTreeMap<String, BTreeMap<String, Said>>>);

impl Figures {
    /// Those that are kept.
    ///
    /// # Panics
    /// Where `figures.json` is not as [`Figures::text`] makes it.
    #[must_use]
    pub fn kept() -> Self {
        serde_json::from_str(include_str!("../figures.json")).expect("figures.json")
    }

    /// As `figures.json` has them: a line for each walk.
    ///
    /// # Panics
    /// Never: they are names and numbers.
    #[must_use]
    pub fn text(&self) -> String {
        let block = |lines: Vec<String>| format!("{{\n{}\n}}", lines.join(",\n"));
        let robots = self.0.iter().map(|(robot, gaits)| {
            let gaits = gaits.iter().map(|(gait, cases)| {
                let cases = cases.iter().map(|(case, said)| {
                    let said = serde_json::to_string(said).expect("numbers");
                    format!("{case:?}: {said}")
                });
                format!("{gait:?}: {}", block(cases.collect()))
            });
            format!("{robot:?}: {}", block(gaits.collect()))
        });
        block(robots.collect()) + "\n"
    }

    /// Of a robot's gait in a case.
    #[must_use]
    pub fn get(&self, robot: &str, gait: &str, case: Case) -> Option<&Said> {
        self.0.get(robot)?.get(gait)?.get(&case.to_string())
    }

    /// Keeps them.
    pub fn put(&mut self, robot: &str, gait: &str, case: Case, said: Said) {
        let gaits = self.0.entry(robot.to_owned()).or_default();
        let cases = gaits.entry(gait.to_owned()).or_default();
        cases.insert(case.to_string(), said);
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        let gaits = self.0.values().flat_map(BTreeMap::values);
        gaits.map(BTreeMap::len).sum()
    }
}
