//! The performance charts: the performance of every design in the triangle of r1, r2 and r3.

use rayon::prelude::*;
use serde::Serialize;

use super::performance::Performance;
use super::proportions::Proportions;

/// A point of the charts, with lengths in units of D.
#[derive(Clone, Copy, Serialize)]
pub struct ChartPoint {
    /// The point in the triangle of proportions.
    #[serde(flatten)]
    pub proportions: Proportions,
    /// The performance of a five-bar of these proportions.
    #[serde(flatten)]
    pub performance: Performance,
}

/// Computes the charts at the points of [`grid_points`](super::grid_points), on all cores. The results and
/// their order are the same in every run. Calls `report_progress` after each point.
pub fn compute_chart_points(
    points: Vec<Proportions>,
    ring_count: usize,
    report_progress: &(dyn Fn() + Sync),
) -> Vec<ChartPoint> {
    let compute = |proportions: Proportions| {
        let performance = Performance::compute(&proportions.five_bar(1.0), ring_count);
        report_progress();
        ChartPoint {
            proportions,
            performance,
        }
    };
    points.into_par_iter().map(compute).collect()
}
