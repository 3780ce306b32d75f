//! A part's surface as a closed mesh of triangles.
//!
//! Each edge of the solid is divided once, and both faces that share it use the same
//! points, so the triangles of neighbouring faces match.

use std::collections::BTreeMap;

use lizard_kinematics::Vector;

use crate::files::solid::{Face, Solid, Surface, position_along};
use crate::layers::outline::Segment;

/// Largest distance between a chord and its arc, mm.
const MAX_CHORD_ERROR: f64 = 0.01;
/// Largest angle of an arc that a chord spans, rad: at least 36 chords to a circle.
const MAX_CHORD_ANGLE: f64 = std::f64::consts::TAU / 36.0;

/// A surface of triangles, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The corners of all triangles, mm.
    pub corners: Vec<[f64; 3]>,
    /// The triangles, each by the indices of three corners.
    pub triangles: Vec<[usize; 3]>,
}

impl Mesh {
    /// Divides the surface of a solid into triangles.
    ///
    /// # Panics
    /// Never for a closed solid.
    pub fn of(solid: &Solid) -> Self {
        let mut builder = MeshBuilder {
            solid,
            mesh: Self::default(),
            corner_indices: BTreeMap::new(),
            lines: Vec::new(),
        };
        for edge in 0..solid.edges.len() {
            let line = builder.divide_edge(edge);
            builder.lines.push(line);
        }
        for face in &solid.faces {
            match face.surface {
                Surface::Top(_) => builder.add_flat(face, false),
                Surface::Bottom(_) => builder.add_flat(face, true),
                Surface::Wall(side, end) | Surface::Slope(side, end, ..) => {
                    builder.add_wall(face, side, end);
                }
            }
        }
        builder.mesh
    }

    /// The volume, mm^3.
    pub fn volume(&self) -> f64 {
        let volumes = self.triangles.iter().map(|&triangle| {
            let [[ax, ay, az], [bx, by, bz], [cx, cy, cz]] = triangle.map(|i| self.corners[i]);
            ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        });
        volumes.sum::<f64>() / 6.0
    }

    /// True if every side of a triangle has exactly one neighbour.
    pub fn is_closed(&self) -> bool {
        let mut sides = BTreeMap::new();
        for &[a, b, c] in &self.triangles {
            for side in [(a, b), (b, c), (c, a)] {
                *sides.entry(side).or_insert(0) += 1;
            }
        }
        let mut side_counts = sides.iter();
        side_counts.all(|(&(a, b), count)| *count == 1 && sides.get(&(b, a)) == Some(&1))
    }
}

/// A solid and its mesh as built so far.
struct MeshBuilder<'a> {
    solid: &'a Solid,
    mesh: Mesh,
    /// Index in the mesh of each of the solid's corners, by the indices of its point and of its height.
    corner_indices: BTreeMap<(usize, usize), usize>,
    /// The indices of the corners along each edge of the solid, from its first end to its second.
    lines: Vec<Vec<usize>>,
}

impl MeshBuilder<'_> {
    /// Returns the index of a corner of the solid in the mesh; adds the corner if it is new.
    fn corner_index(&mut self, (point, level): (usize, usize)) -> usize {
        let (position, z) = (self.solid.points[point], self.solid.heights[level]);
        let corners = &mut self.mesh.corners;
        *self
            .corner_indices
            .entry((point, level))
            .or_insert_with(|| {
                corners.push([position.x, position.y, z]);
                corners.len() - 1
            })
    }

    /// Divides an edge into chords, and returns the indices of the corners along it.
    fn divide_edge(&mut self, edge: usize) -> Vec<usize> {
        let edge = self.solid.edges[edge];
        let [from, to] = edge.ends;
        let (first, last) = (self.corner_index(from), self.corner_index(to));
        let side = Segment {
            from: self.solid.points[from.0],
            bulge: edge.bulge,
        };
        let mut line = vec![first];
        let chord_count_of = |radius: f64, angle: f64| {
            let chord = 2.0 * libm::acos((1.0 - MAX_CHORD_ERROR / radius).clamp(-1.0, 1.0));
            (angle / chord.min(MAX_CHORD_ANGLE)).ceil() as u32
        };
        let z = self.solid.heights[from.1];
        for position in side.division_points(self.solid.points[to.0], chord_count_of) {
            line.push(self.mesh.corners.len());
            self.mesh.corners.push([position.x, position.y, z]);
        }
        line.push(last);
        line
    }

    /// The corners along a sequence of edges, without the last corner.
    fn trail_of(&self, edges: &[(usize, bool)]) -> Vec<usize> {
        let mut trail = Vec::new();
        for &(edge, is_forward) in edges {
            let line = &self.lines[edge];
            match is_forward {
                true => trail.extend(&line[..line.len() - 1]),
                false => trail.extend(line[1..].iter().rev()),
            }
        }
        trail
    }

    /// Adds a horizontal face. A face that is seen from below is triangulated as its mirror image.
    fn add_flat(&mut self, face: &Face, is_below: bool) {
        let mut corners: Vec<usize> = Vec::new();
        let mut hole_starts = Vec::new();
        for edges in &face.loops {
            let trail = self.trail_of(edges);
            if !corners.is_empty() {
                hole_starts.push(corners.len());
            }
            corners.extend(trail);
        }
        let corner_position_of = |&corner: &usize| {
            let [x, y, _] = self.mesh.corners[corner];
            (corner, Vector::new(if is_below { -x } else { x }, y))
        };
        let positions: Vec<_> = corners.iter().map(corner_position_of).collect();
        let coordinates: Vec<f64> = positions
            .iter()
            .flat_map(|(_, position)| [position.x, position.y])
            .collect();
        let indices = earcutr::earcut(&coordinates, &hole_starts, 2).expect("a loop has points");
        let triangle_of = |corner_indices: &[usize]| {
            let [(a, p), (b, q), (c, r)] = [0, 1, 2].map(|i| positions[corner_indices[i]]);
            match (q - p).cross(r - p) < 0.0 {
                true => [a, c, b],
                false => [a, b, c],
            }
        };
        let mut triangles: Vec<_> = indices.chunks_exact(3).map(triangle_of).collect();
        split_at_corners(&mut triangles, &positions);
        self.mesh.triangles.extend(triangles);
    }

    /// Adds a wall as a strip of triangles between its lower and its upper line of corners.
    fn add_wall(&mut self, face: &Face, side: Segment, end: Vector) {
        let levels_of = |edge: usize| self.solid.edges[edge].ends.map(|(_, level)| level);
        let edges = &face.loops[0];
        let is_vertical = |&(edge, _): &(usize, bool)| {
            let [low, high] = levels_of(edge);
            low != high
        };
        let first_vertical = edges.iter().position(is_vertical).unwrap_or(0);
        let mut low = self.trail_of(&edges[..first_vertical]);
        low.push(self.first_or_last_corner(edges[first_vertical], false));
        let mut high = self.trail_of(&edges[first_vertical + 1..edges.len() - 1]);
        high.push(self.first_or_last_corner(edges[edges.len() - 1], false));
        high.reverse();
        let position_of = |&corner: &usize| {
            let [x, y, _] = self.mesh.corners[corner];
            position_along(side, end, Vector::new(x, y))
        };
        let distances_of = |chain: &[usize]| {
            let mut distances: Vec<f64> = chain.iter().map(position_of).collect();
            distances[0] = 0.0;
            distances
        };
        let (low_distances, high_distances) = (distances_of(&low), distances_of(&high));
        let (mut i, mut j) = (0, 0);
        let mut triangles = Vec::new();
        while i + 1 < low.len() || j + 1 < high.len() {
            let is_low_next = j + 1 == high.len()
                || (i + 1 < low.len() && low_distances[i + 1] <= high_distances[j + 1]);
            if is_low_next {
                triangles.push([low[i], low[i + 1], high[j]]);
                i += 1;
            } else {
                triangles.push([low[i], high[j + 1], high[j]]);
                j += 1;
            }
        }
        self.mesh.triangles.extend(triangles);
    }

    /// The corner at which an edge of a loop begins or, if `is_last`, ends.
    fn first_or_last_corner(&self, (edge, is_forward): (usize, bool), is_last: bool) -> usize {
        let line = &self.lines[edge];
        if is_forward == is_last {
            line[line.len() - 1]
        } else {
            line[0]
        }
    }
}

/// Divides triangles at the corners that lie on their sides. The triangulation skips points in the middle of a straight
/// line, where walls and other triangles have corners.
fn split_at_corners(triangles: &mut Vec<[usize; 3]>, corners: &[(usize, Vector)]) {
    let mut index = 0;
    while index < triangles.len() {
        let triangle = triangles[index];
        let split = (0..3).find_map(|i| {
            let [a, b, c] = [0, 1, 2].map(|k| triangle[(i + k) % 3]);
            let inner_corners = corners_between(corners, a, b);
            (!inner_corners.is_empty()).then_some((a, inner_corners, b, c))
        });
        let Some((a, inner_corners, b, c)) = split else {
            index += 1;
            continue;
        };
        triangles.swap_remove(index);
        if inner_corners.contains(&c) {
            // The triangle has no area, and its neighbours touch each other without it.
            continue;
        }
        let chain = [&[a][..], &inner_corners, &[b]].concat();
        triangles.extend(chain.windows(2).map(|pair| [pair[0], pair[1], c]));
    }
}

/// The corners on the line between two others, in order; the two are not included.
fn corners_between(corners: &[(usize, Vector)], a: usize, b: usize) -> Vec<usize> {
    let position_of = |index: usize| corners.iter().find(|(corner, _)| *corner == index);
    let (Some(&(_, from)), Some(&(_, to))) = (position_of(a), position_of(b)) else {
        return Vec::new();
    };
    let (length, line) = ((to - from).length(), to - from);
    let distance_and_corner_of = |&(corner, position): &(usize, Vector)| {
        let distance = (position - from).dot(line) / length;
        let offset = line.cross(position - from) / length;
        let is_within = offset.abs() < 1e-7 && distance > 0.0 && distance < length;
        is_within.then_some((distance, corner))
    };
    let other_corners = corners
        .iter()
        .filter(|(corner, _)| *corner != a && *corner != b);
    let mut sorted_corners: Vec<(f64, usize)> =
        other_corners.filter_map(distance_and_corner_of).collect();
    sorted_corners.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    sorted_corners
        .into_iter()
        .map(|(_, corner)| corner)
        .collect()
}
