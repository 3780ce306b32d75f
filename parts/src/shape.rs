//! Flat convex shapes with round corners: of these all parts are made.
//!
//! A bar is a line that has a width; a hub is a point that has one; a plate is a
//! polygon whose corners are rounded. All three are the same: the convex hull of a few
//! points, grown by a radius. The distance of two such shapes is that of two polygons,
//! less both radii, which is what a test for collisions wants; their outlines are
//! lines and arcs, which is what a drawing wants.

use lizard_kinematics::Vector;

use crate::place::Place;

/// The convex hull of some points, grown by a radius; mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Corners of a convex polygon, counter-clockwise; one of a disc, two of a bar.
    pub points: Vec<Vector>,
    /// What the hull is grown by: 0 for sharp corners.
    pub radius: f64,
}

impl Shape {
    /// A disc.
    #[must_use]
    pub fn disc(centre: Vector, radius: f64) -> Self {
        Self {
            points: vec![centre],
            radius,
        }
    }

    /// A bar with round ends around two points.
    #[must_use]
    pub fn bar(from: Vector, to: Vector, radius: f64) -> Self {
        if from == to {
            return Self::disc(from, radius);
        }
        Self {
            points: vec![from, to],
            radius,
        }
    }

    /// A rectangle by its middle and its size, whose corners have a radius.
    #[must_use]
    pub fn rectangle(middle: Vector, size: Vector, radius: f64) -> Self {
        let (x, y) = (size.x / 2.0 - radius, size.y / 2.0 - radius);
        Self::hull(
            &[(-x, -y), (x, -y), (x, y), (-x, y)].map(|(x, y)| middle + Vector::new(x, y)),
            radius,
        )
    }

    /// A nut's hexagon by its width over flats; a corner points along x.
    #[must_use]
    pub fn hexagon(centre: Vector, flats: f64) -> Self {
        let reach = flats / f64::sqrt(3.0);
        let corners = [0.0, 60.0, 120.0, 180.0, 240.0, 300.0];
        Self::hull(
            &corners.map(|angle| centre + Vector::direction(angle) * reach),
            0.0,
        )
    }

    /// The hull of any points.
    #[must_use]
    pub fn hull(points: &[Vector], radius: f64) -> Self {
        let mut sorted = points.to_vec();
        sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        sorted.dedup();
        // Andrew's monotone chain: the lower half, then the upper one.
        let half = |points: &mut dyn Iterator<Item = &Vector>| {
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
        let mut chain = half(&mut sorted.iter());
        let upper = half(&mut sorted.iter().rev());
        if sorted.len() > 1 {
            chain.pop();
            chain.extend(&upper[..upper.len() - 1]);
        }
        Self {
            points: chain,
            radius,
        }
    }

    /// The same shape elsewhere.
    #[must_use]
    pub fn placed(&self, place: &Place) -> Self {
        Self {
            points: self.points.iter().map(|&point| place.map(point)).collect(),
            radius: self.radius,
        }
    }

    /// The mirror image in the x axis.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self {
            points: self.points.iter().rev().map(|p| p.mirrored()).collect(),
            radius: self.radius,
        }
    }

    /// The distance to another shape, mm: 0 where they touch, and below where they
    /// overlap, down to less both radii where even the polygons do.
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        let between = if self.holds(other.points[0]) || other.holds(self.points[0]) {
            0.0
        } else {
            let mut least = f64::INFINITY;
            for (a, b) in self.edges() {
                for (c, d) in other.edges() {
                    least = least.min(segments(a, b, c, d));
                }
            }
            least
        };
        between - self.radius - other.radius
    }

    /// Whether the polygon holds a point.
    fn holds(&self, point: Vector) -> bool {
        self.points.len() > 2 && self.edges().all(|(a, b)| (b - a).cross(point - a) >= 0.0)
    }

    /// The sides of the polygon; of a disc one of length 0.
    fn edges(&self) -> impl Iterator<Item = (Vector, Vector)> {
        let n = self.points.len();
        let sides = if n == 2 { 1 } else { n };
        (0..sides).map(move |i| (self.points[i], self.points[(i + 1) % n]))
    }
}

/// The distance of two lines of a length, mm.
fn segments(a: Vector, b: Vector, c: Vector, d: Vector) -> f64 {
    let side = |p: Vector, q: Vector, r: Vector| (q - p).cross(r - p);
    let crosses = side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
    if crosses {
        return 0.0;
    }
    to_line(a, c, d)
        .min(to_line(b, c, d))
        .min(to_line(c, a, b))
        .min(to_line(d, a, b))
}

/// The distance of a point from a line of a length, mm.
fn to_line(point: Vector, from: Vector, to: Vector) -> f64 {
    let along = to - from;
    let square = along.square();
    let share = if square > 0.0 {
        ((point - from).dot(along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (point - from - along * share).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> Vector {
        Vector::new(x, y)
    }

    #[test]
    fn discs_and_bars_are_apart_by_their_middles_less_their_radii() {
        let disc = Shape::disc(at(10.0, 3.0), 2.0);
        let bar = Shape::bar(at(0.0, 0.0), at(20.0, 0.0), 0.5);
        assert_eq!(disc.distance(&bar), 0.5);
        assert_eq!(bar.distance(&disc), 0.5);
        let beyond = Shape::disc(at(23.0, 4.0), 1.0);
        assert_eq!(bar.distance(&beyond), 3.5);
    }

    #[test]
    fn what_lies_in_a_polygon_or_crosses_it_overlaps() {
        let plate = Shape::rectangle(at(0.0, 0.0), at(10.0, 8.0), 0.0);
        assert_eq!(plate.distance(&Shape::disc(at(1.0, 1.0), 0.5)), -0.5);
        let across = Shape::bar(at(-20.0, 0.0), at(20.0, 0.0), 1.0);
        assert_eq!(plate.distance(&across), -1.0);
        assert_eq!(plate.distance(&Shape::disc(at(8.0, 0.0), 1.0)), 2.0);
        assert_eq!(plate.distance(&Shape::disc(at(8.0, 8.0), 1.0)), 4.0);
    }

    #[test]
    fn a_hull_drops_what_lies_within_and_turns_counter_clockwise() {
        let hull = Shape::hull(
            &[
                at(0.0, 0.0),
                at(1.0, 1.0),
                at(2.0, 0.0),
                at(1.0, 0.2),
                at(1.0, 0.0),
            ],
            0.0,
        );
        assert_eq!(hull.points, [at(0.0, 0.0), at(2.0, 0.0), at(1.0, 1.0)]);
        assert_eq!(
            Shape::hull(&[at(1.0, 2.0); 3], 1.0),
            Shape::disc(at(1.0, 2.0), 1.0)
        );
        let bar = Shape::hull(&[at(0.0, 0.0), at(4.0, 0.0), at(2.0, 0.0)], 1.0);
        assert_eq!(bar, Shape::bar(at(0.0, 0.0), at(4.0, 0.0), 1.0));
    }
}
