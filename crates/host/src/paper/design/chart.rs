//! The performance charts: every figure over the whole (r1, r2, r3) triangle.

use indicatif::{ParallelProgressIterator, ProgressBar};
use rayon::prelude::*;
use serde::Serialize;

use super::performance::Performance;
use super::proportions::{Proportions, triangle};

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

/// Computes the charts on a grid of this step, on all cores. The numbers and their order are the same in every run.
pub fn chart(step: f64, rings: usize, progress: &ProgressBar) -> Vec<Point> {
    let points = triangle(step);
    progress.set_length(points.len() as u64);
    points
        .into_par_iter()
        .progress_with(progress.clone())
        .map(|proportions| Point {
            proportions,
            performance: Performance::of(&proportions.at_scale(1.0), rings),
        })
        .collect()
}
