//! A part's surface as a closed mesh of triangles.
//!
//! Each edge of the solid is divided once, and both adjacent faces use the same points, so the triangles of
//! neighbouring faces match.

use std::collections::BTreeMap;

use lizard_kinematics::Vector;

use crate::build_error::BuildError;
use crate::files::solid::{Edge, Face, Solid, Surface, position_along};
use crate::layers::body::Prism;
use crate::layers::outline::Segment;

/// Largest distance between a chord and its arc, mm.
const MAX_CHORD_ERROR: f64 = 0.01;
/// Largest angle that a chord spans, rad: at least 36 chords to a circle.
const MAX_CHORD_ANGLE: f64 = std::f64::consts::TAU / 36.0;

/// A surface of triangles, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corners of all triangles, mm.
    pub corners: Vec<[f64; 3]>,
    /// Triangles, each as the indices of three corners.
    pub triangles: Vec<[usize; 3]>,
}

impl Mesh {
    /// Divides the surface of a solid into triangles.
    ///
    /// # Panics
    /// Never for a closed solid.
    pub fn from_solid(solid: &Solid) -> Self {
        let mut builder = MeshBuilder {
            solid,
            mesh: Self::default(),
            corner_indices: BTreeMap::new(),
            edge_corners: Vec::new(),
        };
        for edge in &solid.edges {
            let corners = builder.divide_edge(edge);
            builder.edge_corners.push(corners);
        }
        for face in &solid.faces {
            match face.surface {
                Surface::Top(_) => builder.add_flat_face(face, false),
                Surface::Bottom(_) => builder.add_flat_face(face, true),
                Surface::Wall { side, end } | Surface::Slope { side, end, .. } => {
                    builder.add_wall(face, side, end);
                }
            }
        }
        builder.mesh
    }

    /// Divides the surface of layers into triangles. `name` is the name of their part.
    ///
    /// # Errors
    /// Returns [`BuildError::OpenSurface`] if the layers do not form a closed surface.
    pub fn from_prisms(name: &str, prisms: &[Prism]) -> Result<Self, BuildError> {
        let solid = Solid::from_prisms(prisms);
        let mesh = solid.is_closed().then(|| Self::from_solid(&solid));
        let closed_mesh = mesh.filter(Self::is_closed);
        closed_mesh.ok_or_else(|| BuildError::OpenSurface(name.to_owned()))
    }

    /// Computes the enclosed volume, mm^3.
    pub fn volume(&self) -> f64 {
        let volumes = self.triangles.iter().map(|&triangle| {
            let [[ax, ay, az], [bx, by, bz], [cx, cy, cz]] = triangle.map(|i| self.corners[i]);
            ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        });
        volumes.sum::<f64>() / 6.0
    }

    /// True if every side of every triangle has exactly one neighbour.
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

/// A solid and the mesh built so far.
struct MeshBuilder<'a> {
    solid: &'a Solid,
    mesh: Mesh,
    /// Index in the mesh of each corner of the solid, by the indices of the corner's point and height.
    corner_indices: BTreeMap<(usize, usize), usize>,
    /// Indices of the corners along each edge of the solid, from its first end to its second.
    edge_corners: Vec<Vec<usize>>,
}

impl MeshBuilder<'_> {
    /// Returns the index in the mesh of a corner of the solid; adds the corner if it is new.
    fn find_or_add_corner(&mut self, (point, level): (usize, usize)) -> usize {
        let (position, z) = (self.solid.points[point], self.solid.heights[level]);
        let corners = &mut self.mesh.corners;
        let index = self.corner_indices.entry((point, level));
        *index.or_insert_with(|| {
            corners.push([position.x, position.y, z]);
            corners.len() - 1
        })
    }

    /// Divides an edge into chords, and returns the indices of the corners along it.
    fn divide_edge(&mut self, edge: &Edge) -> Vec<usize> {
        let [from, to] = edge.ends;
        let (first, last) = (self.find_or_add_corner(from), self.find_or_add_corner(to));
        let side = Segment::new(self.solid.points[from.0], edge.bulge);
        let mut corners = vec![first];
        let count_chords = |radius: f64, angle: f64| {
            let chord = 2.0 * libm::acos((1.0 - MAX_CHORD_ERROR / radius).clamp(-1.0, 1.0));
            (angle / chord.min(MAX_CHORD_ANGLE)).ceil() as u32
        };
        let z = self.solid.heights[from.1];
        for position in side.division_points(self.solid.points[to.0], count_chords) {
            corners.push(self.mesh.corners.len());
            self.mesh.corners.push([position.x, position.y, z]);
        }
        corners.push(last);
        corners
    }

    /// Collects the corners along a sequence of edges, without the last corner.
    fn collect_corners(&self, edges: &[(usize, bool)]) -> Vec<usize> {
        let mut corners = Vec::new();
        for &(edge, is_forward) in edges {
            let edge_corners = &self.edge_corners[edge];
            match is_forward {
                true => corners.extend(&edge_corners[..edge_corners.len() - 1]),
                false => corners.extend(edge_corners[1..].iter().rev()),
            }
        }
        corners
    }

    /// Adds a horizontal face; a face seen from below is triangulated as its mirror image.
    fn add_flat_face(&mut self, face: &Face, is_bottom: bool) {
        let mut corners: Vec<usize> = Vec::new();
        let mut hole_starts = Vec::new();
        for edges in &face.loops {
            if !corners.is_empty() {
                hole_starts.push(corners.len());
            }
            corners.extend(self.collect_corners(edges));
        }
        let to_position = |&corner: &usize| {
            let [x, y, _] = self.mesh.corners[corner];
            (corner, Vector::new(if is_bottom { -x } else { x }, y))
        };
        let positions: Vec<_> = corners.iter().map(to_position).collect();
        let coordinates = positions.iter().flat_map(|(_, point)| [point.x, point.y]);
        let coordinates: Vec<f64> = coordinates.collect();
        let indices = earcutr::earcut(&coordinates, &hole_starts, 2).expect("a loop has points");
        let to_triangle = |corner_indices: &[usize]| {
            let [(a, p), (b, q), (c, r)] = [0, 1, 2].map(|i| positions[corner_indices[i]]);
            let is_clockwise = (q - p).cross(r - p) < 0.0;
            if is_clockwise { [a, c, b] } else { [a, b, c] }
        };
        let mut triangles: Vec<_> = indices.chunks_exact(3).map(to_triangle).collect();
        split_at_corners(&mut triangles, &positions);
        self.mesh.triangles.extend(triangles);
    }

    /// Adds a wall as a strip of triangles between its lower and its upper corners.
    fn add_wall(&mut self, face: &Face, side: Segment, end: Vector) {
        let edges = &face.loops[0];
        let is_rising = |&(edge, _): &(usize, bool)| {
            let [(_, first_level), (_, last_level)] = self.solid.edges[edge].ends;
            first_level != last_level
        };
        let first_rising = edges.iter().position(is_rising).unwrap_or(0);
        let mut low = self.collect_corners(&edges[..first_rising]);
        low.push(self.start_corner(edges[first_rising]));
        let mut high = self.collect_corners(&edges[first_rising + 1..edges.len() - 1]);
        high.push(self.start_corner(edges[edges.len() - 1]));
        high.reverse();
        let compute_position = |&corner: &usize| {
            let [x, y, _] = self.mesh.corners[corner];
            position_along(side, end, Vector::new(x, y))
        };
        let compute_positions = |corners: &[usize]| {
            let mut positions: Vec<f64> = corners.iter().map(compute_position).collect();
            positions[0] = 0.0;
            positions
        };
        let (low_positions, high_positions) = (compute_positions(&low), compute_positions(&high));
        let (mut i, mut j) = (0, 0);
        let mut triangles = Vec::new();
        while i + 1 < low.len() || j + 1 < high.len() {
            let is_low_next = j + 1 == high.len()
                || (i + 1 < low.len() && low_positions[i + 1] <= high_positions[j + 1]);
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

    /// Index of the corner at which an edge of a loop begins.
    fn start_corner(&self, (edge, is_forward): (usize, bool)) -> usize {
        let corners = &self.edge_corners[edge];
        corners[if is_forward { 0 } else { corners.len() - 1 }]
    }
}

/// Divides triangles at the corners that lie on their sides. The triangulation skips points within a straight side,
/// where walls and other triangles have corners.
fn split_at_corners(triangles: &mut Vec<[usize; 3]>, corners: &[(usize, Vector)]) {
    let mut index = 0;
    while index < triangles.len() {
        let triangle = triangles[index];
        let split = (0..3).find_map(|i| {
            let [a, b, c] = [0, 1, 2].map(|k| triangle[(i + k) % 3]);
            let inner_corners = find_corners_between(corners, a, b);
            (!inner_corners.is_empty()).then_some((a, inner_corners, b, c))
        });
        let Some((a, inner_corners, b, c)) = split else {
            index += 1;
            continue;
        };
        triangles.swap_remove(index);
        if inner_corners.contains(&c) {
            // The triangle has no area; its neighbours touch each other without it.
            continue;
        }
        let chain = [&[a][..], &inner_corners, &[b]].concat();
        triangles.extend(chain.windows(2).map(|pair| [pair[0], pair[1], c]));
    }
}

/// Finds the corners on the line between two others, in order, without these two.
fn find_corners_between(corners: &[(usize, Vector)], a: usize, b: usize) -> Vec<usize> {
    let find_position = |index: usize| corners.iter().find(|(corner, _)| *corner == index);
    let (Some(&(_, from)), Some(&(_, to))) = (find_position(a), find_position(b)) else {
        return Vec::new();
    };
    let line = to - from;
    let length = line.length();
    let locate_corner = |&(corner, position): &(usize, Vector)| {
        let distance = (position - from).dot(line) / length;
        let offset = line.cross(position - from) / length;
        let is_within = offset.abs() < 1e-7 && distance > 0.0 && distance < length;
        is_within.then_some((distance, corner))
    };
    let is_other = |(corner, _): &&(usize, Vector)| *corner != a && *corner != b;
    let other_corners = corners.iter().filter(is_other);
    let mut sorted_corners: Vec<(f64, usize)> = other_corners.filter_map(locate_corner).collect();
    sorted_corners.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let sorted_corners = sorted_corners.into_iter();
    sorted_corners.map(|(_, corner)| corner).collect()
}
