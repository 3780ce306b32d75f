//! A measured gait: the mean of its cycles over one or several walks.

use lizard_contact::Travel;

use crate::cycle_path::{self, CyclePoint};
use crate::estimate::Estimate;
use crate::gait::Gait;
use crate::mean::{self, Mean, WalkValues};
use crate::walk::{Walk, components};

/// A gait's mean displacement, period and path per cycle, measured from videos.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredGait {
    /// Displacement per cycle along the robot's forward direction at the start of the cycle, mm.
    pub forward: Mean,
    /// Displacement per cycle to the left, mm.
    pub left: Mean,
    /// Turn per cycle, deg, counter-clockwise positive.
    pub turn: Mean,
    /// Duration of a cycle, s.
    pub period: Estimate,
    /// The movement of each cycle.
    pub cycles: Vec<Travel>,
    /// The times of the calm phases that divide each walk into cycles, s.
    pub cycle_boundaries: Vec<f64>,
    /// The mean path within a cycle, with the predicted path for comparison.
    pub cycle_path: Vec<CyclePoint>,
    /// The walks from which the means are computed.
    walks: Vec<Walk>,
}

impl MeasuredGait {
    /// Computes the means over walks.
    pub(crate) fn from_walks(walks: Vec<Walk>, gait: &Gait) -> Self {
        let component_mean = |i: usize| {
            let component = |travel: &Travel| components(*travel)[i];
            let walk_values = |walk: &Walk| WalkValues {
                cycles: walk.cycles.travels.iter().map(component).collect(),
                systematic_error: walk.systematic_errors()[i],
            };
            mean::compute_mean(&walks.iter().map(walk_values).collect::<Vec<_>>())
        };
        let travels = |walk: &Walk| walk.cycles.travels.clone();
        let cycles: Vec<Travel> = walks.iter().flat_map(travels).collect();
        let boundaries = |walk: &Walk| walk.cycles.boundaries.clone();
        let mean_over_cycles = |value: fn(&Walk) -> f64| {
            let weight = |walk: &Walk| walk.cycles.travels.len() as f64 / cycles.len() as f64;
            walks.iter().map(|walk| weight(walk) * value(walk)).sum()
        };
        Self {
            forward: component_mean(0),
            left: component_mean(1),
            turn: component_mean(2),
            period: Estimate {
                value: mean_over_cycles(|walk| walk.cycles.period.value),
                standard_error: mean_over_cycles(|walk| walk.cycles.period.standard_error),
            },
            cycle_boundaries: walks.iter().flat_map(boundaries).collect(),
            cycle_path: cycle_path::compute_points(&walks, gait),
            cycles,
            walks,
        }
    }

    /// Computes the means over all walks in several results for one gait.
    pub fn combine(results: &[Self], gait: &Gait) -> Self {
        let walks = results.iter().flat_map(|result| result.walks.clone());
        Self::from_walks(walks.collect(), gait)
    }
}
