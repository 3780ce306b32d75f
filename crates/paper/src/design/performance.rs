//! The performance of a five-bar of given proportions: workspace, maximal inscribed circle, and the local conditioning
//! index (LCI) over that circle.

use lizard_kinematics::{Circle, FiveBar, Vector, Workspace};
use serde::Serialize;

use crate::bisection::bisect;

/// The lower bound that the paper claims for the local conditioning index.
pub const CLAIMED_LCI: f64 = 0.7;

/// The performance of a design, in the unit of its lengths.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Performance {
    /// Area of the theoretical workspace, both halves.
    pub area: f64,
    /// Radius of the maximal inscribed circle; 0 if there is no circle.
    pub r_mic: f64,
    /// Height of the inscribed circle's centre above the base; 0 if there is no circle.
    pub y_mic: f64,
    /// Local conditioning index over the inscribed circle; `None` if there is no circle.
    pub lci: Option<LciStatistics>,
}

/// Statistics of the local conditioning index over the inscribed circle.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LciStatistics {
    /// Mean index over the circle's area (the global conditioning index).
    pub mean: f64,
    /// Smallest index; it is on the rim, and is 0 if the circle touches the workspace's edge.
    #[serde(rename = "least")]
    pub min: f64,
    /// Largest index in the circle.
    #[serde(rename = "most")]
    pub max: f64,
    /// Fraction of the circle's area in which the index is above 0.7, the paper's bound.
    pub share_above: f64,
    /// Radius of the concentric circle within which the index is at least 0.7, the paper's bound.
    pub radius_above: f64,
}

/// Computes the local conditioning index with the end point at `point` and outward elbows; 0 on the rim of the
/// workspace and outside it.
pub fn lci(five_bar: &FiveBar, point: Vector) -> f64 {
    let pose = five_bar.pose_at_point(point);
    pose.map_or(0.0, |pose| pose.conditioning_index())
}

impl Performance {
    /// Computes the performance of a five-bar. The inscribed circle is sampled on `ring_count` rings.
    pub fn compute(five_bar: &FiveBar, ring_count: usize) -> Self {
        let workspace = Workspace::for_five_bar(five_bar);
        let circle = workspace.inscribed_circle();
        Self {
            area: workspace.area(),
            r_mic: circle.map_or(0.0, |circle| circle.radius),
            y_mic: circle.map_or(0.0, |circle| circle.centre.y),
            lci: circle.map(|circle| LciStatistics::sample(five_bar, circle, ring_count)),
        }
    }
}

impl LciStatistics {
    /// Samples the circle on rings of equal area, and on its rim. Then refines the largest index, and searches outward
    /// for the radius at which the index first falls below the claimed bound.
    fn sample(five_bar: &FiveBar, circle: Circle, ring_count: usize) -> Self {
        let spoke_count = 4 * ring_count;
        let mut sum = 0.0;
        let mut count_above = 0;
        let mut min_index = f64::INFINITY;
        let (mut max_index, mut max_point) = (0.0_f64, circle.centre);
        for spoke in 0..spoke_count {
            let direction = Vector::from_angle((spoke as f64 + 0.5) * 360.0 / spoke_count as f64);
            for ring in 0..ring_count {
                let radius = circle.radius * ((ring as f64 + 0.5) / ring_count as f64).sqrt();
                let point = circle.centre + direction * radius;
                let index = lci(five_bar, point);
                sum += index;
                count_above += usize::from(index > CLAIMED_LCI);
                min_index = min_index.min(index);
                if index > max_index {
                    (max_index, max_point) = (index, point);
                }
            }
        }
        // The samples on the rim include the four points at which the circle may touch the workspace's edge.
        for spoke in 0..spoke_count {
            let direction = Vector::from_angle(spoke as f64 * 360.0 / spoke_count as f64);
            min_index = min_index.min(lci(five_bar, circle.centre + direction * circle.radius));
        }
        for shaft in [five_bar.left_shaft(), five_bar.right_shaft()] {
            let shaft_to_centre = circle.centre - shaft;
            for distance in [circle.radius, -circle.radius] {
                let touch_point =
                    circle.centre + shaft_to_centre * (distance / shaft_to_centre.length());
                min_index = min_index.min(lci(five_bar, touch_point));
            }
        }
        let sample_count = (ring_count * spoke_count) as f64;
        let first_step = circle.radius / ring_count as f64;
        Self {
            mean: sum / sample_count,
            min: min_index,
            max: find_max_index(five_bar, circle, (max_index, max_point), first_step),
            share_above: count_above as f64 / sample_count,
            radius_above: Self::find_radius_above(five_bar, circle, ring_count),
        }
    }

    /// Finds the radius of the concentric circle within which the index is at least the claimed bound.
    fn find_radius_above(five_bar: &FiveBar, circle: Circle, ring_count: usize) -> f64 {
        let step = circle.radius / (2 * ring_count) as f64;
        (0..4 * ring_count)
            .map(|spoke| {
                let direction = Vector::from_angle(spoke as f64 * 90.0 / ring_count as f64);
                let is_above_claim =
                    |radius: f64| lci(five_bar, circle.centre + direction * radius) >= CLAIMED_LCI;
                let Some(first_below) =
                    (0..=2 * ring_count).find(|&i| !is_above_claim(i as f64 * step))
                else {
                    return circle.radius;
                };
                if first_below == 0 {
                    return 0.0;
                }
                let inner_radius = (first_below as f64 - 1.0) * step;
                bisect(inner_radius, first_below as f64 * step, 30, is_above_claim)
            })
            .fold(circle.radius, f64::min)
    }
}

/// Searches for the largest index in the circle near a sample, by hill climbing. The step is halved if no neighbour is
/// better.
fn find_max_index(
    five_bar: &FiveBar,
    circle: Circle,
    start_sample: (f64, Vector),
    first_step: f64,
) -> f64 {
    let (mut value, mut point) = start_sample;
    let mut step = first_step;
    while step > 1e-5 * first_step {
        let directions = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
        let best_neighbour = directions
            .map(|(x, y)| point + Vector::new(x, y) * step)
            .into_iter()
            .filter(|point| (*point - circle.centre).length() <= circle.radius)
            .map(|point| (lci(five_bar, point), point))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        match best_neighbour {
            Some(best_neighbour) if best_neighbour.0 > value => (value, point) = best_neighbour,
            _ => step /= 2.0,
        }
    }
    value
}
