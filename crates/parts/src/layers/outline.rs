//! The outline of a layer: loops of lines and arcs.
//!
//! A layer is a union of shapes minus some holes. The library that computes the union keeps arcs as arcs, so a round
//! hole stays a circle in every file.

use cavalier_contours::core::math::Vector2;
use cavalier_contours::polyline::{
    BooleanOp, BooleanResultInfo, PlineSource, PlineSourceMut, PlineVertex, Polyline,
    seg_arc_radius_and_center, seg_midpoint,
};
use lizard_kinematics::Vector;

use crate::layers::body::Prism;
use crate::layers::shape::Shape;

/// Computes the smallest and the largest x and y of these points.
pub(crate) fn compute_bounds(points: impl Iterator<Item = Vector>) -> [Vector; 2] {
    let [low, high] = [f64::INFINITY, f64::NEG_INFINITY].map(|bound| Vector::new(bound, bound));
    points.fold([low, high], |[low, high], point| {
        [
            Vector::new(low.x.min(point.x), low.y.min(point.y)),
            Vector::new(high.x.max(point.x), high.y.max(point.y)),
        ]
    })
}

/// Distance below which two points count as one, mm.
pub(crate) const SAME_POINT_MM: f64 = 1e-5;

/// A closed line of straight sides and arcs, with the material on its left: clockwise only around a hole.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// Sides, each from its start point to the start point of the next side.
    pub sides: Vec<Segment>,
}

/// One side of a loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Start point, mm.
    pub from: Vector,
    /// Tangent of a quarter of the arc's angle: 0 for a straight side, 1 for a semicircle, positive for a left turn.
    pub bulge: f64,
}

/// The outline of a layer: its islands, which are not connected to each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// Islands, each as its outer loop and then the loops of its holes.
    pub islands: Vec<Vec<Loop>>,
}

impl Outline {
    /// Computes the outline of a layer.
    pub fn from_prism(prism: &Prism) -> Self {
        let (mut islands, gaps) = unite(prism.filled_shapes.iter().map(to_polyline));
        let cut_lines = prism.cut_shapes.iter().map(to_polyline);
        let (mut cuts, _) = unite(gaps.into_iter().chain(cut_lines));
        // Cuts that open an island change its outer loop; the others are holes.
        cuts.retain(|cut| {
            let mut changes_island = false;
            let mut remaining_islands = Vec::new();
            for island in islands.drain(..) {
                let difference = island.boolean(cut, BooleanOp::Not);
                match difference.result_info {
                    BooleanResultInfo::Intersected | BooleanResultInfo::Overlapping => {
                        changes_island = true;
                        remaining_islands
                            .extend(difference.pos_plines.into_iter().map(|result| result.pline));
                    }
                    BooleanResultInfo::Pline1InsidePline2 => changes_island = true,
                    _ => remaining_islands.push(island),
                }
            }
            islands = remaining_islands;
            !changes_island
        });
        let to_loops = |island: Polyline<f64>| {
            let holes = cuts.iter().filter(|cut| {
                let result_info = island.boolean(*cut, BooleanOp::Not).result_info;
                matches!(result_info, BooleanResultInfo::Pline2InsidePline1)
            });
            let holes = holes.map(|hole| Loop::from_polyline(hole, false));
            std::iter::once(Loop::from_polyline(&island, true))
                .chain(holes)
                .collect()
        };
        let islands = islands.into_iter().map(to_loops).collect();
        Self { islands }
    }

    /// All loops of all islands.
    pub fn loops(&self) -> impl Iterator<Item = &Loop> {
        self.islands.iter().flatten()
    }

    /// Computes the enclosed area, mm^2.
    pub fn area(&self) -> f64 {
        self.loops().map(Loop::area).sum()
    }

    /// Computes the first moment of area (the area times its centroid), mm^3.
    pub fn first_moment(&self) -> Vector {
        self.loops().fold(Vector::default(), |sum, outline_loop| {
            sum + outline_loop.first_moment()
        })
    }

    /// True if a point is in the material.
    pub fn contains(&self, point: Vector) -> bool {
        let loops = self.loops();
        let winding_numbers = loops.map(|outline_loop| outline_loop.winding_number(point));
        winding_numbers.sum::<i32>() > 0
    }
}

impl Loop {
    /// Creates a loop from a polyline: counter-clockwise if `is_outer` is true, clockwise around a hole.
    fn from_polyline(line: &Polyline<f64>, is_outer: bool) -> Self {
        let mut line = line
            .remove_redundant(SAME_POINT_MM)
            .unwrap_or_else(|| line.clone());
        if (line.area() > 0.0) != is_outer {
            line.invert_direction_mut();
        }
        let to_segment = |vertex: PlineVertex<f64>| {
            let is_straight = vertex.bulge.abs() < 1e-9;
            let bulge = if is_straight { 0.0 } else { vertex.bulge };
            Segment::new(Vector::new(vertex.x, vertex.y), bulge)
        };
        let sides = line.iter_vertexes().map(to_segment).collect();
        Self { sides }
    }

    /// Returns the sides, each with its end point.
    pub fn sides_with_end_points(&self) -> impl Iterator<Item = (Segment, Vector)> {
        let n = self.sides.len();
        (0..n).map(move |i| (self.sides[i], self.sides[(i + 1) % n].from))
    }

    /// Returns centre and radius if the loop is a circle.
    pub fn circle(&self) -> Option<(Vector, f64)> {
        let mut arcs = self.sides_with_end_points().map(|(side, to)| side.arc(to));
        let (centre, radius) = arcs.next()??;
        let is_same_circle = |arc: Option<(Vector, f64)>| {
            arc.is_some_and(|(other_centre, other_radius)| {
                (other_centre - centre).length() < SAME_POINT_MM
                    && (other_radius - radius).abs() < SAME_POINT_MM
            })
        };
        arcs.all(is_same_circle).then_some((centre, radius))
    }

    /// Computes the enclosed area, mm^2; negative around a hole.
    pub fn area(&self) -> f64 {
        self.polyline().area()
    }

    /// Computes the enclosed area times its centroid, mm^3.
    fn first_moment(&self) -> Vector {
        let mut sum = Vector::default();
        for (side, to) in self.sides_with_end_points() {
            let (a, b) = (side.from, to);
            // A triangle from the origin, and the circular segment between arc and chord.
            sum = sum + (a + b) * (a.cross(b) / 6.0);
            if let Some((centre, radius)) = side.arc(to) {
                let half_angle = 2.0 * libm::atan(side.bulge.abs());
                let area =
                    radius * radius * (half_angle - libm::sin(half_angle) * libm::cos(half_angle));
                // The distance of the segment's centroid from the circle's centre is 2 half_chord^3 / (3 area).
                let half_chord = radius * libm::sin(half_angle);
                let centroid_distance = 2.0 / 3.0 * (half_chord * half_chord * half_chord) / area;
                let chord = (b - a) * (1.0 / (b - a).length());
                // A left turn bulges to the right of its chord.
                let outward_direction = chord.rotated_right() * side.bulge.signum();
                let centroid = centre + outward_direction * centroid_distance;
                sum = sum + centroid * (area * side.bulge.signum());
            }
        }
        sum
    }

    fn winding_number(&self, point: Vector) -> i32 {
        self.polyline()
            .winding_number(Vector2::new(point.x, point.y))
    }

    fn polyline(&self) -> Polyline<f64> {
        let mut line = Polyline::new_closed();
        for side in &self.sides {
            line.add(side.from.x, side.from.y, side.bulge);
        }
        line
    }
}

impl Segment {
    /// Creates a side from its start point and its bulge.
    pub(crate) const fn new(from: Vector, bulge: f64) -> Self {
        Self { from, bulge }
    }

    /// Converts the side to a vertex of the library's polylines.
    pub(crate) fn to_vertex(self) -> PlineVertex<f64> {
        PlineVertex::new(self.from.x, self.from.y, self.bulge)
    }

    /// Returns centre and radius of the side's arc to its end point; `None` for a straight side.
    pub fn arc(&self, to: Vector) -> Option<(Vector, f64)> {
        (self.bulge != 0.0).then(|| {
            let end = PlineVertex::new(to.x, to.y, 0.0);
            let (radius, centre) = seg_arc_radius_and_center(self.to_vertex(), end);
            (Vector::new(centre.x, centre.y), radius)
        })
    }

    /// Returns the midpoint of the side, given its end point.
    pub fn midpoint(&self, to: Vector) -> Vector {
        let midpoint = seg_midpoint(self.to_vertex(), PlineVertex::new(to.x, to.y, 0.0));
        Vector::new(midpoint.x, midpoint.y)
    }

    /// Returns the points that divide the arc to the side's end point into equal parts. `count_parts` returns the
    /// number of parts from the arc's radius and angle, rad. A straight side has no such points.
    pub(crate) fn division_points(
        &self,
        to: Vector,
        count_parts: impl Fn(f64, f64) -> u32,
    ) -> Vec<Vector> {
        let Some((centre, radius)) = self.arc(to) else {
            return Vec::new();
        };
        let angle = 4.0 * libm::atan(self.bulge);
        let count = count_parts(radius, angle.abs());
        let arm = self.from - centre;
        let point_at = |i: u32| {
            let angle = angle * f64::from(i) / f64::from(count);
            centre + arm * libm::cos(angle) + arm.rotated_left() * libm::sin(angle)
        };
        (1..count).map(point_at).collect()
    }
}

/// Closed polylines.
type Polylines = Vec<Polyline<f64>>;

/// Unites outlines. Returns the outer lines of the union, and the gaps that these lines enclose.
fn unite(outlines: impl Iterator<Item = Polyline<f64>>) -> (Polylines, Polylines) {
    let (mut islands, mut gaps) = (Polylines::new(), Polylines::new());
    for outline in outlines {
        let mut union_line = outline.clone();
        let mut separate_islands = Vec::new();
        let mut enclosed_gaps = Vec::new();
        for island in islands {
            let mut union = island.boolean(&union_line, BooleanOp::Or);
            let is_disjoint = matches!(union.result_info, BooleanResultInfo::Disjoint);
            if is_disjoint || union.pos_plines.len() != 1 {
                separate_islands.push(island);
            } else {
                union_line = union.pos_plines.remove(0).pline;
                enclosed_gaps.extend(union.neg_plines.into_iter().map(|gap| gap.pline));
            }
        }
        let cut_gap = |gap: Polyline<f64>| gap.boolean(&outline, BooleanOp::Not).pos_plines;
        let remaining_gaps = gaps.into_iter().flat_map(cut_gap);
        let remaining_gaps = remaining_gaps.map(|result| result.pline);
        gaps = remaining_gaps.chain(enclosed_gaps).collect();
        separate_islands.push(union_line);
        islands = separate_islands;
    }
    (islands, gaps)
}

/// Converts a shape to its outline, counter-clockwise.
fn to_polyline(shape: &Shape) -> Polyline<f64> {
    let Shape { points, radius } = shape;
    let mut line = Polyline::new_closed();
    let n = points.len();
    if n == 1 {
        line.add(points[0].x - radius, points[0].y, 1.0);
        line.add(points[0].x + radius, points[0].y, 1.0);
        return line;
    }
    for i in 0..n {
        let (previous, corner, next) = (points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
        let [incoming, outgoing] =
            [corner - previous, next - corner].map(|side| side * (1.0 / side.length()));
        if *radius == 0.0 {
            line.add(corner.x, corner.y, 0.0);
            continue;
        }
        let [arc_start, arc_end] =
            [incoming, outgoing].map(|direction| corner + direction.rotated_right() * *radius);
        // The half-angle formula, applied twice, gives the tangent of a quarter of the turn.
        let (sin, cos) = (incoming.cross(outgoing), incoming.dot(outgoing));
        let bulge = if n == 2 {
            1.0
        } else {
            let half_tangent = sin / (1.0 + cos);
            half_tangent / (1.0 + (1.0 + half_tangent * half_tangent).sqrt())
        };
        line.add(arc_start.x, arc_start.y, bulge);
        line.add(arc_end.x, arc_end.y, 0.0);
    }
    line
}

/// Computes the volume of a layer, mm^3.
pub(crate) fn compute_volume(prism: &Prism) -> f64 {
    let area_at = |fraction| Outline::from_prism(&prism.cross_section(fraction)).area();
    let mean_area = match prism.insets[0] == prism.insets[1] {
        true => area_at(0.0),
        // Simpson's rule, which is exact for a cone.
        false => (area_at(0.0) + 4.0 * area_at(0.5) + area_at(1.0)) / 6.0,
    };
    mean_area * (prism.z[1] - prism.z[0])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::layers::shape::vector;

    fn build_outline(filled: Vec<Shape>, cut: Vec<Shape>) -> Outline {
        Outline::from_prism(&Prism::new(filled, cut, [0.0, 1.0]))
    }

    #[test]
    fn a_bar_with_two_holes_has_the_exact_area_and_two_circles() {
        let (a, b) = (vector(0.0, 0.0), vector(30.0, 10.0));
        let bar = build_outline(
            vec![Shape::bar(a, b, 4.5)],
            vec![Shape::disc(a, 1.6), Shape::disc(b, 1.6)],
        );
        let area = 1000f64.sqrt() * 9.0 + PI * (4.5 * 4.5 - 2.0 * 1.6 * 1.6);
        assert!((bar.area() - area).abs() < 1e-9, "{} mm^2", bar.area());
        let circles: Vec<_> = bar.loops().filter_map(Loop::circle).collect();
        assert_eq!(circles.len(), 2);
        assert!((circles[1].0 - b).length() < 1e-9 && (circles[1].1 - 1.6).abs() < 1e-9);
        let centroid = bar.first_moment() * (1.0 / bar.area());
        let error = (centroid - vector(15.0, 5.0)).length();
        assert!(error < 1e-9, "{centroid:?}");
        assert!(bar.contains(vector(15.0, 5.0)));
        assert!(!bar.contains(a) && !bar.contains(vector(0.0, 9.0)));
    }

    #[test]
    fn a_ring_of_bars_encloses_a_gap_until_a_later_shape_fills_it() {
        let corners = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)];
        let corners = corners.map(|(x, y)| vector(x, y));
        let bar_from =
            |i: usize| Shape::bar(corners[i], corners[(i + 1) % 4], 2.0 + 0.01 * i as f64);
        let bars = [0, 1, 2, 3].map(bar_from);
        let ring = build_outline(bars.to_vec(), Vec::new());
        assert_eq!(ring.islands.len(), 1);
        assert_eq!(ring.islands[0].len(), 2);
        assert!(!ring.contains(vector(10.0, 10.0)) && ring.contains(vector(10.0, 0.0)));
        let crossing_bar = Shape::bar(vector(10.0, 0.0), vector(10.0, 20.0), 1.0);
        let filled = build_outline([&bars[..], &[crossing_bar]].concat(), Vec::new());
        assert_eq!(filled.islands[0].len(), 3);
        assert!(filled.contains(vector(10.0, 10.0)) && !filled.contains(vector(5.0, 10.0)));
    }

    #[test]
    fn a_slot_across_a_plate_leaves_two_islands() {
        let plate = Shape::rectangle(vector(0.0, 0.0), vector(20.0, 10.0), 1.0);
        let slot = Shape::rectangle(vector(0.0, 0.0), vector(30.0, 2.0), 0.0);
        let hole = Shape::disc(vector(3.0, 3.0), 1.0);
        let halves = build_outline(vec![plate], vec![slot, hole]);
        assert_eq!(halves.islands.len(), 2);
        let area = 200.0 - (4.0 - PI) - 40.0 - PI;
        assert!((halves.area() - area).abs() < 1e-9);
        assert_eq!(halves.islands.iter().map(Vec::len).sum::<usize>(), 3);
    }

    #[test]
    fn the_centroid_of_a_half_disc_is_4_r_over_3_pi_from_the_centre() {
        let disc = Shape::disc(vector(5.0, 2.0), 3.0);
        let lower_half = Shape::rectangle(vector(5.0, -8.0), vector(20.0, 20.0), 0.0);
        let half = build_outline(vec![disc], vec![lower_half]);
        let centroid = half.first_moment() * (1.0 / half.area());
        assert!((centroid - vector(5.0, 2.0 + 4.0 * 3.0 / (3.0 * PI))).length() < 1e-9);
    }
}
