//! The workspace of the end point of a symmetrical five-bar: the intersection of two rings, one
//! about each shaft, with radii |l1 - l2| and l1 + l2.

use core::f64::consts::PI;

use crate::five_bar::FiveBar;
use crate::vector::Vector;

/// A circle in the five-bar's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Centre of the circle, mm.
    pub centre: Vector,
    /// Radius of the circle, mm.
    pub radius: f64,
}

/// The theoretical workspace of a five-bar with equal arms (l1 = l4, l2 = l3). In the
/// paper's equations of its four circles, y is a misprint for y^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Workspace {
    /// Half the base, mm.
    pub half_base: f64,
    /// Inner radius of each ring, mm.
    pub inner_radius: f64,
    /// Outer radius of each ring, mm.
    pub outer_radius: f64,
}

impl Workspace {
    /// Creates the workspace of a symmetrical five-bar. The lengths of the left arm are used for both arms.
    pub fn for_five_bar(five_bar: &FiveBar) -> Self {
        Self {
            half_base: five_bar.base / 2.0,
            inner_radius: (five_bar.left_crank_length - five_bar.left_coupler_length).abs(),
            outer_radius: five_bar.left_crank_length + five_bar.left_coupler_length,
        }
    }

    /// True if the end point can reach a point (mm, in the five-bar's own frame).
    pub fn contains(&self, point: Vector) -> bool {
        [-self.half_base, self.half_base].into_iter().all(|x| {
            let distance_squared = (point - Vector::new(x, 0.0)).length_squared();
            distance_squared >= self.inner_radius * self.inner_radius
                && distance_squared <= self.outer_radius * self.outer_radius
        })
    }

    /// The total area on both sides of the base, mm^2.
    pub fn area(&self) -> f64 {
        let distance = 2.0 * self.half_base;
        let (inner, outer) = (self.inner_radius, self.outer_radius);
        // The overlap of both large discs, minus the overlap of each small disc with the other large
        // disc. This subtracts the overlap of both small discs twice, so it is added once.
        lens_area(outer, outer, distance) - 2.0 * lens_area(inner, outer, distance)
            + lens_area(inner, inner, distance)
    }

    /// The largest circle within the workspace; of two mirror images, the one at y > 0. `None` if the
    /// two rings have no area in common.
    ///
    /// The radius of a circle within a ring is at most half the ring's width. If the centre lines of both rings
    /// intersect (l0/2 is at most the larger of l1 and l2), a circle centred on the intersection has that radius and
    /// touches all four circles: this is the paper's solution. With a wider base only the outer circles limit the
    /// inscribed circle: its centre is the middle of the base, and the paper's y is not real. If crank and coupler are
    /// equally long, the inner circles shrink to the shafts. An arm whose end point is at its own shaft is folded and
    /// singular; the inscribed circle therefore excludes the shafts, too.
    pub fn inscribed_circle(&self) -> Option<Circle> {
        let middle_radius = (self.outer_radius + self.inner_radius) / 2.0;
        let height_squared = (middle_radius - self.half_base) * (middle_radius + self.half_base);
        let (height, radius) = if height_squared >= 0.0 {
            (
                libm::sqrt(height_squared),
                (self.outer_radius - self.inner_radius) / 2.0,
            )
        } else {
            (0.0, self.outer_radius - self.half_base)
        };
        (radius > 0.0).then(|| Circle {
            centre: Vector::new(0.0, height),
            radius,
        })
    }
}

/// The common area of two discs with radii `a` and `b` and centres at this distance.
fn lens_area(a: f64, b: f64, distance: f64) -> f64 {
    let min_radius = a.min(b);
    if distance >= a + b {
        return 0.0;
    }
    if distance <= (a - b).abs() {
        return PI * min_radius * min_radius;
    }
    let half_angle = |r: f64, other_radius: f64| {
        let cosine =
            (distance * distance + r * r - other_radius * other_radius) / (2.0 * distance * r);
        libm::acos(cosine.clamp(-1.0, 1.0))
    };
    let segment_area = |angle: f64, r: f64| r * r * (angle - libm::sin(angle) * libm::cos(angle));
    segment_area(half_angle(a, b), a) + segment_area(half_angle(b, a), b)
}
