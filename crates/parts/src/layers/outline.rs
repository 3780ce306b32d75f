//! The outline of a layer: loops of lines and arcs.
//!
//! A layer is a union of shapes less some holes. The library that unites them keeps
//! arcs as arcs, so a hole stays a circle in every file.

use cavalier_contours::core::math::Vector2;
use cavalier_contours::polyline::{
    BooleanOp, BooleanResultInfo, PlineSource, PlineSourceMut, PlineVertex, Polyline,
    seg_arc_radius_and_center, seg_midpoint,
};
use lizard_kinematics::Vector;

use crate::layers::body::Prism;
use crate::layers::shape::Shape;

/// The smallest and the largest x and y of these points.
pub(crate) fn bounds(points: impl Iterator<Item = Vector>) -> [Vector; 2] {
    let [low, high] = [f64::INFINITY, f64::NEG_INFINITY].map(|end| Vector::new(end, end));
    points.fold([low, high], |[low, high], at| {
        [
            Vector::new(low.x.min(at.x), low.y.min(at.y)),
            Vector::new(high.x.max(at.x), high.y.max(at.y)),
        ]
    })
}

/// Points nearer to each other than this count as one, mm.
pub(crate) const SAME_POINT_MM: f64 = 1e-5;

/// A closed line of straight sides and arcs, with the material on its left:
/// counter-clockwise around a part, clockwise around a hole.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// The sides, each from its start point to the start point of the next side.
    pub sides: Vec<Segment>,
}

/// One side of a loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The start point, mm.
    pub from: Vector,
    /// The tangent of a quarter of the arc's angle: 0 for a straight side, 1 for a semicircle, positive for a left
    /// turn.
    pub bulge: f64,
}

/// The outline of a layer, as separate pieces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// The pieces, each as its outer loop and then the loops of its holes.
    pub pieces: Vec<Vec<Loop>>,
}

impl Outline {
    /// The outline of a layer.
    pub fn of(prism: &Prism) -> Self {
        let (is_outer, gaps) = unite(prism.filled_shapes.iter().map(polyline));
        let (mut cuts, _) = unite(
            gaps.into_iter()
                .chain(prism.cut_shapes.iter().map(polyline)),
        );
        let mut pieces = is_outer;
        // Cuts that open a piece change its outer loop; the others are holes.
        cuts.retain(|cut| {
            let mut is_opened = false;
            let mut left = Vec::new();
            for piece in pieces.drain(..) {
                let rest = piece.boolean(cut, BooleanOp::Not);
                match rest.result_info {
                    BooleanResultInfo::Intersected | BooleanResultInfo::Overlapping => {
                        is_opened = true;
                        left.extend(rest.pos_plines.into_iter().map(|part| part.pline));
                    }
                    BooleanResultInfo::Pline1InsidePline2 => is_opened = true,
                    _ => left.push(piece),
                }
            }
            pieces = left;
            !is_opened
        });
        let loops = |piece: Polyline<f64>| {
            let holes = cuts.iter().filter(|cut| {
                let inside = piece.boolean(*cut, BooleanOp::Not).result_info;
                matches!(inside, BooleanResultInfo::Pline2InsidePline1)
            });
            let holes = holes.map(|hole| Loop::of(hole, false));
            std::iter::once(Loop::of(&piece, true))
                .chain(holes)
                .collect()
        };
        let pieces = pieces.into_iter().map(loops).collect();
        Self { pieces }
    }

    /// All loops of all pieces.
    pub fn loops(&self) -> impl Iterator<Item = &Loop> {
        self.pieces.iter().flatten()
    }

    /// The enclosed area, mm^2.
    pub fn area(&self) -> f64 {
        self.loops().map(Loop::area).sum()
    }

    /// The area times its centroid: the first moment of area, mm^3.
    pub fn moment(&self) -> Vector {
        self.loops()
            .fold(Vector::default(), |sum, line| sum + line.moment())
    }

    /// True if a point is in the material.
    pub fn contains(&self, point: Vector) -> bool {
        let turns: i32 = self.loops().map(|line| line.winding_number(point)).sum();
        turns > 0
    }
}

impl Loop {
    fn of(line: &Polyline<f64>, is_outer: bool) -> Self {
        let mut line = line
            .remove_redundant(SAME_POINT_MM)
            .unwrap_or_else(|| line.clone());
        if (line.area() > 0.0) != is_outer {
            line.invert_direction_mut();
        }
        let side = |vertex: PlineVertex<f64>| {
            let straight = vertex.bulge.abs() < 1e-9;
            Segment {
                from: Vector::new(vertex.x, vertex.y),
                bulge: if straight { 0.0 } else { vertex.bulge },
            }
        };
        let sides = line.iter_vertexes().map(side).collect();
        Self { sides }
    }

    /// The sides, each with its end point.
    pub fn sides_with_end_points(&self) -> impl Iterator<Item = (Segment, Vector)> {
        let n = self.sides.len();
        (0..n).map(move |i| (self.sides[i], self.sides[(i + 1) % n].from))
    }

    /// Centre and radius if the loop is a circle.
    pub fn circle(&self) -> Option<(Vector, f64)> {
        let mut arcs = self.sides_with_end_points().map(|(side, to)| side.arc(to));
        let (centre, radius) = arcs.next()??;
        let is_same_circle = |arc: Option<(Vector, f64)>| {
            let near = |(at, size): (Vector, f64)| {
                (at - centre).length() < SAME_POINT_MM && (size - radius).abs() < SAME_POINT_MM
            };
            arc.is_some_and(near)
        };
        arcs.all(is_same_circle).then_some((centre, radius))
    }

    /// The enclosed area, mm^2; negative around a hole.
    pub fn area(&self) -> f64 {
        self.polyline().area()
    }

    /// The enclosed area times its centroid, mm^3.
    fn moment(&self) -> Vector {
        let mut sum = Vector::default();
        for (side, to) in self.sides_with_end_points() {
            let (a, b) = (side.from, to);
            // A triangle from the origin, and the arc's segment beside its chord.
            sum = sum + (a + b) * (a.cross(b) / 6.0);
            if let Some((centre, radius)) = side.arc(to) {
                let half = 2.0 * libm::atan(side.bulge.abs());
                let area = radius * radius * (half - libm::sin(half) * libm::cos(half));
                // Half the chord's length; with it, the distance of the segment's centroid from the centre is 2 r^3
                // sin^3 / (3 area).
                let reach = radius * libm::sin(half);
                let out = 2.0 / 3.0 * (reach * reach * reach) / area;
                let chord = (b - a) * (1.0 / (b - a).length());
                // A left turn bulges out to the right of its chord.
                let beyond = chord.rotated_right() * side.bulge.signum();
                let far = centre + beyond * out;
                sum = sum + far * (area * side.bulge.signum());
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
    /// The side as a vertex of the library's polylines.
    pub(crate) fn vertex(&self) -> PlineVertex<f64> {
        PlineVertex::new(self.from.x, self.from.y, self.bulge)
    }

    /// Centre and radius of the side's arc to its end point; `None` for a straight side.
    pub fn arc(&self, to: Vector) -> Option<(Vector, f64)> {
        (self.bulge != 0.0).then(|| {
            let end = PlineVertex::new(to.x, to.y, 0.0);
            let (radius, centre) = seg_arc_radius_and_center(self.vertex(), end);
            (Vector::new(centre.x, centre.y), radius)
        })
    }

    /// The midpoint of the side, given its end point.
    pub fn middle(&self, to: Vector) -> Vector {
        let middle = seg_midpoint(self.vertex(), PlineVertex::new(to.x, to.y, 0.0));
        Vector::new(middle.x, middle.y)
    }

    /// Points that divide the arc to the side's end point into as many parts as `count` returns for its radius and
    /// its angle, rad. The start and end points are left out; a straight side has no such points.
    pub(crate) fn along(&self, to: Vector, count: impl Fn(f64, f64) -> u32) -> Vec<Vector> {
        let Some((centre, radius)) = self.arc(to) else {
            return Vec::new();
        };
        let angle = 4.0 * libm::atan(self.bulge);
        let count = count(radius, angle.abs());
        let arm = self.from - centre;
        let point = |i: u32| {
            let angle = angle * f64::from(i) / f64::from(count);
            centre + arm * libm::cos(angle) + arm.rotated_left() * libm::sin(angle)
        };
        (1..count).map(point).collect()
    }
}

type Lines = Vec<Polyline<f64>>;

/// The union of outlines: its outer lines, and the gaps that these enclose.
fn unite(outlines: impl Iterator<Item = Polyline<f64>>) -> (Lines, Lines) {
    let (mut pieces, mut gaps) = (Lines::new(), Lines::new());
    for outline in outlines {
        let mut joined = outline.clone();
        let mut apart = Vec::new();
        let mut enclosed = Vec::new();
        for piece in pieces {
            let mut union = piece.boolean(&joined, BooleanOp::Or);
            let disjoint = matches!(union.result_info, BooleanResultInfo::Disjoint);
            if disjoint || union.pos_plines.len() != 1 {
                apart.push(piece);
            } else {
                joined = union.pos_plines.remove(0).pline;
                enclosed.extend(union.neg_plines.into_iter().map(|gap| gap.pline));
            }
        }
        let rest = |gap: Polyline<f64>| gap.boolean(&outline, BooleanOp::Not).pos_plines;
        let left = gaps.into_iter().flat_map(rest).map(|part| part.pline);
        gaps = left.chain(enclosed).collect();
        apart.push(joined);
        pieces = apart;
    }
    (pieces, gaps)
}

/// The outline of one shape, counter-clockwise.
fn polyline(shape: &Shape) -> Polyline<f64> {
    let Shape { points, radius } = shape;
    let mut line = Polyline::new_closed();
    let n = points.len();
    if n == 1 {
        line.add(points[0].x - radius, points[0].y, 1.0);
        line.add(points[0].x + radius, points[0].y, 1.0);
        return line;
    }
    let unit = |from: Vector, to: Vector| (to - from) * (1.0 / (to - from).length());
    for i in 0..n {
        let (before, at, after) = (points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
        let (incoming, outgoing) = (unit(before, at), unit(at, after));
        if *radius == 0.0 {
            line.add(at.x, at.y, 0.0);
            continue;
        }
        let [begin, end] = [incoming, outgoing].map(|way| at + way.rotated_right() * *radius);
        // Tangent of a quarter of the turn: the half-angle formula, applied twice.
        let (sin, cos) = (incoming.cross(outgoing), incoming.dot(outgoing));
        let bulge = if n == 2 {
            1.0
        } else {
            let half = sin / (1.0 + cos);
            half / (1.0 + (1.0 + half * half).sqrt())
        };
        line.add(begin.x, begin.y, bulge);
        line.add(end.x, end.y, 0.0);
    }
    line
}

/// The volume of a layer, mm^3.
pub(crate) fn volume(prism: &Prism) -> f64 {
    let area = |share| Outline::of(&prism.cross_section(share)).area();
    let mean = match prism.inset[0] == prism.inset[1] {
        true => area(0.0),
        // Simpson's rule, exact for the area of a cone.
        false => (area(0.0) + 4.0 * area(0.5) + area(1.0)) / 6.0,
    };
    mean * (prism.z[1] - prism.z[0])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn at(x: f64, y: f64) -> Vector {
        Vector::new(x, y)
    }

    fn outline(add: Vec<Shape>, cut: Vec<Shape>) -> Outline {
        let z = [0.0, 1.0];
        Outline::of(&Prism::new(add, cut, z))
    }

    #[test]
    fn a_bar_with_two_holes_has_their_area_and_their_circles() {
        let (a, b) = (at(0.0, 0.0), at(30.0, 10.0));
        let bar = outline(
            vec![Shape::bar(a, b, 4.5)],
            vec![Shape::disc(a, 1.6), Shape::disc(b, 1.6)],
        );
        let area = 1000f64.sqrt() * 9.0 + PI * (4.5 * 4.5 - 2.0 * 1.6 * 1.6);
        assert!((bar.area() - area).abs() < 1e-9);
        let circles: Vec<_> = bar.loops().filter_map(Loop::circle).collect();
        assert_eq!(circles.len(), 2);
        assert!((circles[1].0 - b).length() < 1e-9 && (circles[1].1 - 1.6).abs() < 1e-9);
        let middle = bar.moment() * (1.0 / bar.area());
        assert!((middle - at(15.0, 5.0)).length() < 1e-9, "{middle:?}");
        assert!(bar.contains(at(15.0, 5.0)) && !bar.contains(a) && !bar.contains(at(0.0, 9.0)));
    }

    #[test]
    fn a_ring_of_bars_encloses_a_gap_that_a_later_shape_may_fill() {
        let corners = [at(0.0, 0.0), at(20.0, 0.0), at(20.0, 20.0), at(0.0, 20.0)];
        let bars: Vec<_> = (0..4)
            .map(|i| Shape::bar(corners[i], corners[(i + 1) % 4], 2.0 + 0.01 * i as f64))
            .collect();
        let ring = outline(bars.clone(), Vec::new());
        assert_eq!(ring.pieces.len(), 1);
        assert_eq!(ring.pieces[0].len(), 2);
        assert!(!ring.contains(at(10.0, 10.0)) && ring.contains(at(10.0, 0.0)));
        let across = Shape::bar(at(10.0, 0.0), at(10.0, 20.0), 1.0);
        let filled = outline([&bars[..], &[across]].concat(), Vec::new());
        assert_eq!(filled.pieces[0].len(), 3);
        assert!(filled.contains(at(10.0, 10.0)) && !filled.contains(at(5.0, 10.0)));
    }

    #[test]
    fn a_slot_across_a_plate_leaves_two_pieces() {
        let plate = Shape::rectangle(at(0.0, 0.0), at(20.0, 10.0), 1.0);
        let slot = Shape::rectangle(at(0.0, 0.0), at(30.0, 2.0), 0.0);
        let hole = Shape::disc(at(3.0, 3.0), 1.0);
        let halves = outline(vec![plate], vec![slot, hole]);
        assert_eq!(halves.pieces.len(), 2);
        let area = 200.0 - (4.0 - PI) - 40.0 - PI;
        assert!((halves.area() - area).abs() < 1e-9);
        assert_eq!(halves.pieces.iter().map(Vec::len).sum::<usize>(), 3);
    }

    #[test]
    fn the_middle_of_half_a_disc_is_where_it_should_be() {
        let disc = Shape::disc(at(5.0, 2.0), 3.0);
        let below = Shape::rectangle(at(5.0, -8.0), at(20.0, 20.0), 0.0);
        let half = outline(vec![disc], vec![below]);
        let middle = half.moment() * (1.0 / half.area());
        assert!((middle - at(5.0, 2.0 + 4.0 * 3.0 / (3.0 * PI))).length() < 1e-9);
    }
}
