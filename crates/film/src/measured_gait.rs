//! A measured gait: the mean of its cycles over one walk or several.

use lizard_contact::Travel;

use crate::cycle_path::{self, CyclePoint};
use crate::figure::Figure;
use crate::gait::Gait;
use crate::mean::{self, Mean, WalkValues};
use crate::walk::{Walk, travel_components};

/// A gait's mean displacement, period and path per cycle, measured from films.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredGait {
    /// Displacement per cycle along the robot's forward direction at the start of the cycle, mm.
    pub forward: Mean,
    /// Displacement per cycle to the left, mm.
    pub left: Mean,
    /// Turn per cycle, deg, counter-clockwise positive.
    pub turn: Mean,
    /// Duration of a cycle, s.
    pub period: Figure,
    /// The movement of each cycle.
    pub cycles: Vec<Travel>,
    /// The times of the calm phases at which each walk is divided into cycles, s.
    pub cycle_boundaries: Vec<f64>,
    /// The mean path within a cycle, with the predicted path for comparison.
    pub cycle_path: Vec<CyclePoint>,
    /// The walks from which the means are computed.
    walks: Vec<Walk>,
}

impl MeasuredGait {
    /// Computes the means over walks.
    pub(crate) fn from_walks(walks: Vec<Walk>, gait: &Gait) -> Self {
        let mean_of = |i: usize| {
            let values_of = |walk: &Walk| WalkValues {
                cycles: travel_components(&walk.cycles.travels)[i].clone(),
                systematic_error: walk.systematic_errors()[i],
            };
            mean::mean_of_walks(&walks.iter().map(values_of).collect::<Vec<_>>())
        };
        let cycles: Vec<Travel> = walks
            .iter()
            .flat_map(|walk| walk.cycles.travels.clone())
            .collect();
        let share_of = |walk: &Walk| walk.cycles.travels.len() as f64 / cycles.len() as f64;
        let mean_over_cycles = |value_of: fn(&Walk) -> f64| {
            walks
                .iter()
                .map(|walk| share_of(walk) * value_of(walk))
                .sum()
        };
        Self {
            forward: mean_of(0),
            left: mean_of(1),
            turn: mean_of(2),
            period: Figure {
                value: mean_over_cycles(|walk| walk.cycles.period.value),
                error: mean_over_cycles(|walk| walk.cycles.period.error),
            },
            cycle_boundaries: walks
                .iter()
                .flat_map(|walk| walk.cycles.boundaries.clone())
                .collect(),
            cycle_path: cycle_path::compute_points(&walks, gait),
            cycles,
            walks,
        }
    }

    /// Computes the means over all walks of several results of one gait, from one film or several.
    pub fn combine(results: &[Self], gait: &Gait) -> Self {
        let walks = results.iter().flat_map(|result| result.walks.clone());
        Self::from_walks(walks.collect(), gait)
    }
}
