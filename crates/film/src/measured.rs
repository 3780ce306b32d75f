//! A measured gait: the mean of its cycles over one walk or several.

use lizard_contact::Travel;

use crate::gait::Gait;
use crate::mean::{self, Mean};
use crate::walk::{Walk, parts};
use crate::within::{self, Point};

/// A gait as it is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Way ahead of a cycle, seen from its start, mm.
    pub forward: Mean,
    /// Drift to the left, mm.
    pub left: Mean,
    /// Turn, deg, counter-clockwise positive.
    pub turn: Mean,
    /// Time of a cycle, s, and its standard error.
    pub period: [f64; 2],
    /// The movement of each cycle.
    pub cycles: Vec<Travel>,
    /// The times between the cycles of each walk, s.
    pub ends: Vec<f64>,
    /// The mean path within a cycle beside the predicted one.
    pub within: Vec<Point>,
    /// The walks of which it is the mean.
    walks: Vec<Walk>,
}

impl Measured {
    /// The mean over walks.
    pub(crate) fn of(walks: Vec<Walk>, gait: &Gait) -> Self {
        let mean = |i: usize| {
            let own = |walk: &Walk| (parts(&walk.cycles.travels)[i].clone(), walk.common()[i]);
            mean::of(&walks.iter().map(own).collect::<Vec<_>>())
        };
        let cycles: Vec<Travel> = walks
            .iter()
            .flat_map(|walk| walk.cycles.travels.clone())
            .collect();
        let share = |walk: &Walk| walk.cycles.travels.len() as f64 / cycles.len() as f64;
        let period = |i: usize| {
            walks
                .iter()
                .map(|walk| share(walk) * walk.cycles.period[i])
                .sum()
        };
        Self {
            forward: mean(0),
            left: mean(1),
            turn: mean(2),
            period: [period(0), period(1)],
            ends: walks
                .iter()
                .flat_map(|walk| walk.cycles.ends.clone())
                .collect(),
            within: within::points(&walks, gait),
            cycles,
            walks,
        }
    }

    /// The mean over the walks of several results of a gait, in one film or in several.
    pub fn together(results: &[Self], gait: &Gait) -> Self {
        let walks = results.iter().flat_map(|result| result.walks.clone());
        Self::of(walks.collect(), gait)
    }
}
