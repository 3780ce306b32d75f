//! The performance charts: the performance of designs at points of the design space.

use rayon::prelude::*;
use serde::Serialize;

use super::performance::Performance;
use super::proportions::Proportions;

/// A point of the charts. Lengths are in the unit D: the sum of crank, coupler and half the base, divided by 0.9.
#[derive(Clone, Copy, Serialize)]
pub struct ChartPoint {
    /// The point of the design space.
    #[serde(flatten)]
    pub proportions: Proportions,
    /// The performance of a five-bar of these proportions.
    #[serde(flatten)]
    pub performance: Performance,
}

/// Computes the charts at these points, usually those of [`grid_points`](super::grid_points), on all cores. The
/// inscribed circle of each design is sampled on `ring_count` rings. The results and their order are the same in every
/// run. Calls `report_progress` after each point.
pub fn compute_chart_points(
    points: Vec<Proportions>,
    ring_count: usize,
    report_progress: &(dyn Fn() + Sync),
) -> Vec<ChartPoint> {
    let compute_point = |proportions: Proportions| {
        let performance = Performance::compute(&proportions.five_bar(1.0), ring_count);
        report_progress();
        ChartPoint {
            proportions,
            performance,
        }
    };
    points.into_par_iter().map(compute_point).collect()
}
