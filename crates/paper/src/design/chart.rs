//! The performance charts: every figure over the whole (r1, r2, r3) triangle.

use rayon::prelude::*;
use serde::Serialize;

use super::performance::Performance;
use super::proportions::Proportions;

/// A point of the charts. Lengths in units of D.
#[derive(Clone, Copy, Serialize)]
pub struct Point {
    /// The point in the triangle of proportions.
    #[serde(flatten)]
    pub proportions: Proportions,
    /// The performance of a five-bar of these proportions.
    #[serde(flatten)]
    pub performance: Performance,
}

/// Computes the charts at the points of [`triangle`](super::triangle), on all cores. The numbers and their order are
/// the same in every run. `progress` is called after each point.
pub fn chart(points: Vec<Proportions>, rings: usize, progress: &(dyn Fn() + Sync)) -> Vec<Point> {
    let compute = |proportions: Proportions| {
        let performance = Performance::of(&proportions.at_scale(1.0), rings);
        progress();
        Point {
            proportions,
            performance,
        }
    };
    points.into_par_iter().map(compute).collect()
}
