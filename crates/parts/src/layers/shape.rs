//! Flat convex shapes with round corners, of which all parts are made.
//!
//! A bar is a line with a width, a hub a point with a width, a plate a polygon with rounded corners. Each shape is the
//! convex hull of a few points, grown by a radius. The distance between two shapes is the distance between their
//! polygons minus both radii, which suits a collision test. The outlines are lines and arcs, which suits a drawing.

use lizard_kinematics::Vector;

use crate::layers::placement::Placement;

/// Creates a vector from its two components.
pub(crate) const fn vector(x: f64, y: f64) -> Vector {
    Vector::new(x, y)
}

/// The convex hull of some points, grown by a radius.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Corners of a convex polygon, counter-clockwise, mm; one for a disc, two for a bar.
    pub points: Vec<Vector>,
    /// Distance by which the hull is grown, mm; 0 for sharp corners.
    pub radius: f64,
}

impl Shape {
    /// Creates a disc about a centre.
    pub fn disc(centre: Vector, radius: f64) -> Self {
        let points = vec![centre];
        Self { points, radius }
    }

    /// Creates a bar with round ends about two points.
    pub fn bar(from: Vector, to: Vector, radius: f64) -> Self {
        if from == to {
            return Self::disc(from, radius);
        }
        let points = vec![from, to];
        Self { points, radius }
    }

    /// Creates a rectangle with rounded corners from its middle and its size.
    pub fn rectangle(middle: Vector, size: Vector, radius: f64) -> Self {
        let (x, y) = (size.x / 2.0 - radius, size.y / 2.0 - radius);
        let corners = [(-x, -y), (x, -y), (x, y), (-x, y)];
        Self::hull(&corners.map(|(x, y)| middle + Vector::new(x, y)), radius)
    }

    /// Creates a hexagon from its width across flats; one corner points along x.
    pub fn hexagon(centre: Vector, across_flats: f64) -> Self {
        let circumradius = across_flats / f64::sqrt(3.0);
        let angles = [0.0, 60.0, 120.0, 180.0, 240.0, 300.0];
        let corners = angles.map(|angle| centre + Vector::from_angle(angle) * circumradius);
        Self::hull(&corners, 0.0)
    }

    /// Creates the convex hull of any points, grown by a radius.
    pub fn hull(points: &[Vector], radius: f64) -> Self {
        let mut sorted_points = points.to_vec();
        sorted_points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        sorted_points.dedup();
        // Andrew's monotone chain: the lower half, then the upper half.
        let build_half_chain = |points: &mut dyn Iterator<Item = &Vector>| {
            let mut chain: Vec<Vector> = Vec::new();
            for &point in points {
                while let [.., a, b] = chain[..]
                    && (b - a).cross(point - b) <= 0.0
                {
                    chain.pop();
                }
                chain.push(point);
            }
            chain
        };
        let mut points = build_half_chain(&mut sorted_points.iter());
        let upper = build_half_chain(&mut sorted_points.iter().rev());
        if sorted_points.len() > 1 {
            points.pop();
            points.extend(&upper[..upper.len() - 1]);
        }
        Self { points, radius }
    }

    /// Returns the shape with its radius changed by `margin`, mm.
    pub(crate) fn grown(&self, margin: f64) -> Self {
        Self {
            radius: self.radius + margin,
            ..self.clone()
        }
    }

    /// Mean of the polygon's corners.
    pub fn middle(&self) -> Vector {
        let sum = self.points.iter().fold(Vector::default(), |a, b| a + *b);
        sum * (1.0 / self.points.len() as f64)
    }

    /// Largest distance between a point and any point of the shape, mm.
    pub fn max_distance_from(&self, from: Vector) -> f64 {
        let distances = self.points.iter().map(|&point| (point - from).length());
        distances.fold(0.0, f64::max) + self.radius
    }

    /// Largest distance between two points of the shape, mm.
    pub fn diameter(&self) -> f64 {
        let points = self.points.iter();
        let distances = points.map(|&point| self.max_distance_from(point));
        distances.fold(0.0, f64::max) + self.radius
    }

    /// Converts the shape from the body's frame to the placement's outer frame.
    pub fn placed(&self, placement: &Placement) -> Self {
        let points = self.points.iter();
        let points = points.map(|&point| placement.map(point)).collect();
        Self { points, ..*self }
    }

    /// Returns the mirror image about the x axis.
    pub fn mirrored(&self) -> Self {
        let points = self.points.iter().rev();
        let points = points.map(|point| point.mirrored_in_x_axis()).collect();
        Self { points, ..*self }
    }

    /// Computes the distance to another shape, mm: 0 if the shapes touch; if they overlap, minus the length of the
    /// shortest shift that separates them. If points of one shape shift, the distance changes by at most the longest of
    /// their shifts.
    pub fn distance(&self, other: &Self) -> f64 {
        let mut distance = f64::INFINITY;
        if self.contains(other.points[0]) || other.contains(self.points[0]) {
            distance = 0.0;
        } else {
            for (a, b) in self.sides() {
                for (c, d) in other.sides() {
                    distance = distance.min(segment_distance(a, b, c, d));
                }
            }
        }
        if distance == 0.0 {
            let own_separation = self.max_side_separation(other);
            let separation = own_separation.max(other.max_side_separation(self));
            // Two discs have no sides.
            if separation.is_finite() {
                distance = separation.min(0.0);
            }
        }
        distance - self.radius - other.radius
    }

    /// Computes the depth of this shape in a hole, mm; negative if the shape protrudes. The result is a lower bound for
    /// all displacements of the points by up to `max_displacement` along x and y.
    pub fn depth_in(&self, hole: &Self, max_displacement: Vector) -> f64 {
        let sharp_hole = Self {
            radius: 0.0,
            ..hole.clone()
        };
        let clearance = hole.radius - self.radius;
        let outside_distance = |point: &Vector| Self::disc(*point, 0.0).distance(&sharp_hole);
        let outside_distances = self.points.iter().map(outside_distance);
        let max_outside = outside_distances.fold(f64::NEG_INFINITY, f64::max);
        let general_bound = clearance - max_outside - max_displacement.length();
        // A sharper bound for a shape that slides along a long hole.
        let outside_distances = hole.side_lines().flat_map(|(from, normal)| {
            let normal_displacement =
                normal.x.abs() * max_displacement.x + normal.y.abs() * max_displacement.y;
            let points = self.points.iter();
            points.map(move |&point| normal.dot(point - from) + normal_displacement)
        });
        let max_outside = outside_distances.fold(f64::NEG_INFINITY, f64::max);
        match hole.points.len() > 2 && max_outside <= 0.0 {
            true => general_bound.max(clearance - max_outside),
            false => general_bound,
        }
    }

    /// Returns the lines along the polygon's sides, each as a point and an outward unit normal. A bar has two lines,
    /// one for each direction; a disc has none.
    fn side_lines(&self) -> impl Iterator<Item = (Vector, Vector)> {
        let n = self.points.len();
        (0..if n > 1 { n } else { 0 }).map(move |i| {
            let (from, to) = (self.points[i], self.points[(i + 1) % n]);
            let side = to - from;
            (from, side.rotated_right() * (1.0 / side.length()))
        })
    }

    /// Computes the largest separation along this polygon's side normals (separating-axis test). A side's separation is
    /// the other polygon's smallest distance in front of the side's line. Minus infinity for a disc, which has no
    /// sides.
    fn max_side_separation(&self, other: &Self) -> f64 {
        let separations = self.side_lines().map(|(from, normal)| {
            let distances = other.points.iter().map(|&point| normal.dot(point - from));
            distances.fold(f64::INFINITY, f64::min)
        });
        separations.fold(f64::NEG_INFINITY, f64::max)
    }

    /// True if a point is inside the polygon or on its edge; always false for discs and bars.
    fn contains(&self, point: Vector) -> bool {
        self.points.len() > 2 && self.sides().all(|(a, b)| (b - a).cross(point - a) >= 0.0)
    }

    /// Returns the sides of the polygon; a bar has one, a disc has one of length 0.
    fn sides(&self) -> impl Iterator<Item = (Vector, Vector)> {
        let n = self.points.len();
        let side_count = if n == 2 { 1 } else { n };
        (0..side_count).map(move |i| (self.points[i], self.points[(i + 1) % n]))
    }
}

/// Computes the distance between two line segments, mm.
fn segment_distance(a: Vector, b: Vector, c: Vector, d: Vector) -> f64 {
    let orientation = |p: Vector, q: Vector, r: Vector| (q - p).cross(r - p);
    let are_on_both_sides = |p: Vector, q: Vector, from: Vector, to: Vector| {
        orientation(from, to, p) * orientation(from, to, q) < 0.0
    };
    if are_on_both_sides(c, d, a, b) && are_on_both_sides(a, b, c, d) {
        return 0.0;
    }
    let end_distance = segment_point_distance(a, c, d).min(segment_point_distance(b, c, d));
    end_distance
        .min(segment_point_distance(c, a, b))
        .min(segment_point_distance(d, a, b))
}

/// Computes the distance between a point and a line segment, mm.
fn segment_point_distance(point: Vector, from: Vector, to: Vector) -> f64 {
    let line = to - from;
    let length_squared = line.length_squared();
    let fraction = match length_squared > 0.0 {
        true => ((point - from).dot(line) / length_squared).clamp(0.0, 1.0),
        false => 0.0,
    };
    (point - from - line * fraction).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_between_disc_and_bar_is_that_of_their_middles_minus_both_radii() {
        let disc = Shape::disc(vector(10.0, 3.0), 2.0);
        let bar = Shape::bar(vector(0.0, 0.0), vector(20.0, 0.0), 0.5);
        assert_eq!(disc.distance(&bar), 0.5);
        assert_eq!(bar.distance(&disc), 0.5);
        let far_disc = Shape::disc(vector(23.0, 4.0), 1.0);
        assert_eq!(bar.distance(&far_disc), 3.5);
    }

    #[test]
    fn the_distance_is_negative_for_overlapping_shapes_and_positive_for_separate_shapes() {
        let plate = Shape::rectangle(vector(0.0, 0.0), vector(10.0, 8.0), 0.0);
        assert_eq!(plate.distance(&Shape::disc(vector(1.0, 1.0), 0.5)), -3.5);
        let crossing_bar = Shape::bar(vector(-20.0, 0.0), vector(20.0, 0.0), 1.0);
        assert_eq!(plate.distance(&crossing_bar), -5.0);
        assert_eq!(crossing_bar.distance(&plate), -5.0);
        let side_plate = Shape::rectangle(vector(9.0, 1.0), vector(10.0, 8.0), 0.0);
        assert_eq!(plate.distance(&side_plate), -1.0);
        let vertical_bar = Shape::bar(vector(3.0, -9.0), vector(3.0, 2.0), 1.0);
        assert_eq!(crossing_bar.distance(&vertical_bar), -4.0);
        let [small_disc, disc] = [2.0, 3.0].map(|radius| Shape::disc(vector(1.0, 0.0), radius));
        assert_eq!(small_disc.distance(&disc), -5.0);
        assert_eq!(plate.distance(&Shape::disc(vector(8.0, 0.0), 1.0)), 2.0);
        assert_eq!(plate.distance(&Shape::disc(vector(8.0, 8.0), 1.0)), 4.0);
    }

    #[test]
    fn the_depth_in_a_hole_is_the_smallest_clearance_to_its_edge() {
        let assert_near = |value: f64, expected: f64| {
            let is_near = (value - expected).abs() < 1e-12;
            assert!(is_near, "expected {expected}, got {value}")
        };
        let no_displacement = vector(0.0, 0.0);
        let slot = Shape::bar(vector(0.0, 0.0), vector(5.0, 0.0), 1.6);
        let pin_depth_at =
            |x: f64, y: f64| Shape::disc(vector(x, y), 1.5).depth_in(&slot, no_displacement);
        assert_near(pin_depth_at(5.0, 0.0), 0.1);
        assert_near(pin_depth_at(2.0, 0.05), 0.05);
        assert_near(pin_depth_at(6.0, 0.0), -0.9);
        let bore = Shape::rectangle(vector(0.0, 0.0), vector(50.0, 6.4), 0.0);
        let rod = Shape::rectangle(vector(1.0, 0.0), vector(40.0, 6.0), 1.0);
        assert_near(rod.depth_in(&bore, no_displacement), 0.2);
        // A displacement along the bore keeps the clearance until the rod nears the bore's end; one across it does not.
        assert_near(rod.depth_in(&bore, vector(3.0, 0.1)), 0.1);
        assert_near(rod.depth_in(&bore, vector(3.9, 0.0)), 0.1);
        assert!(bore.depth_in(&rod, no_displacement) < 0.0);
    }

    #[test]
    fn a_hull_drops_inner_points_and_runs_counter_clockwise() {
        let corners = [(0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (1.0, 0.2), (1.0, 0.0)];
        let hull = Shape::hull(&corners.map(|(x, y)| vector(x, y)), 0.0);
        let expected = [(0.0, 0.0), (2.0, 0.0), (1.0, 1.0)];
        assert_eq!(hull.points, expected.map(|(x, y)| vector(x, y)));
        let point = Shape::hull(&[vector(1.0, 2.0); 3], 1.0);
        assert_eq!(point, Shape::disc(vector(1.0, 2.0), 1.0));
        let bar = Shape::hull(&[vector(0.0, 0.0), vector(4.0, 0.0), vector(2.0, 0.0)], 1.0);
        assert_eq!(bar, Shape::bar(vector(0.0, 0.0), vector(4.0, 0.0), 1.0));
    }
}
