//! The search for the five-bar's best proportions for this robot, which the paper does not contain.
//!
//! The paper takes r1, r2, r3 from a gecko's head and checks the conditioning index afterwards. Here every point of
//! the design space becomes a robot with the given base. The robot's cranks are mounted at the neutral angle that
//! allows the largest sweep within all margins and the servos' travel. Within this sweep every combination of the four
//! servo angles is safe, so any gait of that amplitude is safe.

use lizard_kinematics::{Check, End, FiveBar, Limits, Slider};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::proportions::{Proportions, grid_points};
use crate::bisection::bisect;

/// The requirements for every design.
#[derive(Clone, Copy)]
pub struct Requirements {
    /// Base l0, mm.
    pub base_mm: f64,
    /// Chassis length l10, mm.
    pub chassis_length_mm: f64,
    /// Length of a leg's crank, mm, which determines the stride.
    pub leg_crank_mm: f64,
    /// Smallest allowed margins, and range of the slider travel.
    pub limits: Limits,
    /// Largest servo travel to either side of neutral, degrees.
    pub travel_deg: f64,
    /// Shortest link that can be made, mm.
    pub min_link_mm: f64,
    /// Sweep within which conditioning index and margin are compared, degrees to either side of neutral.
    pub sweep_deg: f64,
}

/// A design whose safe sweep is at least the required sweep.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub struct Design {
    /// The proportions of the five-bar.
    #[serde(flatten)]
    pub proportions: Proportions,
    /// Dimensional factor, mm.
    pub d: f64,
    /// theta1 at neutral, degrees. The other servo angles follow by symmetry.
    pub neutral: f64,
    /// Largest safe sweep to either side, degrees.
    pub sweep: f64,
    /// Stride of a foot with the largest safe sweep, mm.
    pub stride: f64,
    /// Smallest margin within the required sweep, a sine.
    pub margin: f64,
    /// Mean conditioning index within the required sweep.
    pub lci: f64,
    /// Geometric mean of conditioning index, margin and stride, each relative to the best value among all designs.
    pub score: f64,
    /// True if no other design is better in all three: conditioning index, margin and stride.
    #[serde(rename = "pareto")]
    pub is_pareto_optimal: bool,
}

/// Number of points in a piece, enough to occupy all cores.
const PIECE_SIZE: usize = 64;

/// The search, divided into pieces that do not depend on each other.
pub struct Search {
    points: Vec<Proportions>,
    requirements: Requirements,
}

impl Search {
    /// Prepares the search of the points of the design space on a grid with this step of r1 and r2.
    pub fn new(step: f64, requirements: Requirements) -> Self {
        Self {
            points: grid_points(step),
            requirements,
        }
    }

    /// The total number of pieces.
    pub fn piece_count(&self) -> usize {
        self.points.len().div_ceil(PIECE_SIZE)
    }

    /// The number of points in the first `piece_count` pieces.
    pub fn point_count(&self, piece_count: usize) -> usize {
        self.points.len().min(piece_count * PIECE_SIZE)
    }

    /// Computes the designs of one piece that meet the requirements. Calls `report_progress` after each point.
    pub fn compute_piece(&self, index: usize, report_progress: &(dyn Fn() + Sync)) -> Vec<Design> {
        let mut pieces = self.points.chunks(PIECE_SIZE);
        let points = pieces.nth(index).unwrap_or_default();
        let designs = points.par_iter().filter_map(|point| {
            let design = find_design(*point, &self.requirements);
            report_progress();
            design
        });
        designs.collect()
    }
}

/// Merges the designs of all pieces and ranks them, best first.
pub fn merge_and_rank(pieces: Vec<Vec<Design>>) -> Vec<Design> {
    let mut designs = pieces.concat();
    let best_values = BestValues::from_designs(designs.iter());
    let all_designs = designs.clone();
    for design in &mut designs {
        design.score = best_values.score(design);
        design.is_pareto_optimal = !all_designs.iter().any(|other| {
            other.lci > design.lci && other.margin > design.margin && other.stride > design.stride
        });
    }
    designs.sort_by(|a, b| b.score.total_cmp(&a.score));
    designs
}

/// Finds the best design with these proportions, without a score. Returns `None` if the safe sweep is smaller than
/// required, or if a link is too short.
pub fn find_design(proportions: Proportions, requirements: &Requirements) -> Option<Design> {
    let d = proportions.factor_for_base(requirements.base_mm);
    let five_bar = proportions.five_bar(d);
    if five_bar.left_crank_length.min(five_bar.left_coupler_length) < requirements.min_link_mm {
        return None;
    }
    let sweep_at = |neutral: f64| (neutral, find_max_sweep(&five_bar, neutral, requirements));
    let sweeps = (90..=170).map(f64::from).map(sweep_at);
    let (neutral, sweep) = sweeps.reduce(|best, next| if next.1 > best.1 { next } else { best })?;
    if sweep < requirements.sweep_deg {
        return None;
    }
    let (margin, lci) = compute_margin_and_lci(&five_bar, neutral, requirements.sweep_deg);
    Some(Design {
        proportions,
        d,
        neutral,
        sweep,
        stride: 2.0 * requirements.leg_crank_mm * sweep.to_radians().sin(),
        margin,
        lci,
        score: 0.0,
        is_pareto_optimal: false,
    })
}

/// Finds the largest sweep about a neutral angle within all limits, degrees.
fn find_max_sweep(five_bar: &FiveBar, neutral: f64, requirements: &Requirements) -> f64 {
    let is_safe = |sweep_deg: f64| is_within_limits(five_bar, neutral, sweep_deg, requirements);
    match is_safe(0.0) {
        true => bisect(0.0, requirements.travel_deg.min(89.9), 9, is_safe),
        false => 0.0,
    }
}

/// Sample positions across the sweep, from -1 to 1.
const SWEEP_SAMPLES: [f64; 9] = [-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0];

/// True if the five-bar and the sliders are within the limits at all sampled angles of the sweep.
fn is_within_limits(
    five_bar: &FiveBar,
    neutral: f64,
    sweep: f64,
    requirements: &Requirements,
) -> bool {
    let limits = &requirements.limits;
    // The slider of a side, whose arms are as long as the cranks, as in the paper.
    let slider = Slider {
        front_offset: 0.0,
        base: requirements.chassis_length_mm,
        front_arm: five_bar.left_crank_length,
        rear_arm: five_bar.left_crank_length,
        nominal_length: 0.0,
    };
    // theta5 in the tail's frame equals theta1, because the tail mirrors the head.
    let slider_span = |front: f64, rear: f64| {
        let pose = slider.forward(-rear - 90.0, front + 90.0);
        pose.map_or(f64::NAN, |pose| pose.d)
    };
    let nominal_span = slider_span(neutral, neutral);
    SWEEP_SAMPLES.iter().all(|&left_fraction| {
        let left_angle = neutral + left_fraction * sweep;
        SWEEP_SAMPLES.iter().all(|&right_fraction| {
            let right_angle = 180.0 - neutral + right_fraction * sweep;
            let travel = slider_span(left_angle, neutral + right_fraction * sweep) - nominal_span;
            limits.violation(Check::StrokeLeft, travel).is_none()
                && five_bar
                    .forward(left_angle, right_angle)
                    .is_ok_and(|pose| limits.end_violations(End::Head, &pose).next().is_none())
        })
    })
}

/// Computes the smallest margin and the mean conditioning index within a sweep.
fn compute_margin_and_lci(five_bar: &FiveBar, neutral: f64, sweep: f64) -> (f64, f64) {
    let mut min_margin = f64::INFINITY;
    let mut lci_sum = 0.0;
    for left_fraction in SWEEP_SAMPLES {
        let left_angle = neutral + left_fraction * sweep;
        // The margin of the leg on this crank.
        min_margin = min_margin.min(left_angle.to_radians().sin());
        for right_fraction in SWEEP_SAMPLES {
            if let Ok(pose) = five_bar.forward(left_angle, 180.0 - neutral + right_fraction * sweep)
            {
                min_margin = min_margin.min(pose.margin());
                lci_sum += pose.conditioning_index();
            }
        }
    }
    let sample_count = (SWEEP_SAMPLES.len() * SWEEP_SAMPLES.len()) as f64;
    (min_margin, lci_sum / sample_count)
}

/// The best value of each criterion among designs, to which their scores are relative.
pub struct BestValues {
    lci: f64,
    margin: f64,
    stride: f64,
}

impl BestValues {
    /// Finds the best values among designs.
    pub fn from_designs<'a>(designs: impl Iterator<Item = &'a Design> + Clone) -> Self {
        let best = |value: fn(&Design) -> f64| {
            designs.clone().map(value).fold(f64::MIN_POSITIVE, f64::max)
        };
        Self {
            lci: best(|design| design.lci),
            margin: best(|design| design.margin),
            stride: best(|design| design.stride),
        }
    }

    /// Computes the score of one of the designs.
    pub fn score(&self, design: &Design) -> f64 {
        let lci_ratio = design.lci / self.lci;
        let margin_ratio = design.margin.max(0.0) / self.margin;
        let stride_ratio = design.stride / self.stride;
        (lci_ratio * margin_ratio * stride_ratio).cbrt()
    }
}
