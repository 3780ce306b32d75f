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
    /// Divides a surface into triangles.
    ///
    /// # Panics
    /// Never for a closed surface.
    pub fn of(solid: &Solid) -> Self {
        let mut maker = MeshBuilder {
            solid,
            mesh: Self::default(),
            corner_indices: BTreeMap::new(),
            lines: Vec::new(),
        };
        for edge in 0..solid.edges.len() {
            let line = maker.divide_edge(edge);
            maker.lines.push(line);
        }
        for face in &solid.faces {
            match face.surface {
                Surface::Top(_) => maker.add_flat(face, false),
                Surface::Bottom(_) => maker.add_flat(face, true),
                Surface::Wall(side, end) | Surface::Slope(side, end, ..) => {
                    maker.add_wall(face, side, end);
                }
            }
        }
        maker.mesh
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
        let mut all = sides.iter();
        all.all(|(&(a, b), count)| *count == 1 && sides.get(&(b, a)) == Some(&1))
    }
}

struct MeshBuilder<'a> {
    solid: &'a Solid,
    mesh: Mesh,
    /// Index in the mesh of each corner, by its point and its height.
    corner_indices: BTreeMap<(usize, usize), usize>,
    /// The corners of each edge, from its first end point to its second.
    lines: Vec<Vec<usize>>,
}

impl MeshBuilder<'_> {
    fn corner(&mut self, (point, level): (usize, usize)) -> usize {
        let (at, z) = (self.solid.points[point], self.solid.heights[level]);
        let corners = &mut self.mesh.corners;
        *self
            .corner_indices
            .entry((point, level))
            .or_insert_with(|| {
                corners.push([at.x, at.y, z]);
                corners.len() - 1
            })
    }

    fn divide_edge(&mut self, edge: usize) -> Vec<usize> {
        let edge = self.solid.edges[edge];
        let [from, to] = edge.ends;
        let (first, last) = (self.corner(from), self.corner(to));
        let side = Segment {
            from: self.solid.points[from.0],
            bulge: edge.bulge,
        };
        let mut line = vec![first];
        let count = |radius: f64, angle: f64| {
            let chord = 2.0 * libm::acos((1.0 - MAX_CHORD_ERROR / radius).clamp(-1.0, 1.0));
            (angle / chord.min(MAX_CHORD_ANGLE)).ceil() as u32
        };
        let z = self.solid.heights[from.1];
        for at in side.along(self.solid.points[to.0], count) {
            line.push(self.mesh.corners.len());
            self.mesh.corners.push([at.x, at.y, z]);
        }
        line.push(last);
        line
    }

    /// The corners of a sequence of edges, without the last corner.
    fn trail(&self, edges: &[(usize, bool)]) -> Vec<usize> {
        let mut trail = Vec::new();
        for &(edge, forward) in edges {
            let line = &self.lines[edge];
            match forward {
                true => trail.extend(&line[..line.len() - 1]),
                false => trail.extend(line[1..].iter().rev()),
            }
        }
        trail
    }

    fn add_flat(&mut self, face: &Face, is_below: bool) {
        let mut corners: Vec<usize> = Vec::new();
        let mut starts = Vec::new();
        for edges in &face.loops {
            let trail = self.trail(edges);
            if !corners.is_empty() {
                starts.push(corners.len());
            }
            corners.extend(trail);
        }
        let place = |&corner: &usize| {
            let [x, y, _] = self.mesh.corners[corner];
            (corner, Vector::new(if is_below { -x } else { x }, y))
        };
        let known: Vec<_> = corners.iter().map(place).collect();
        let flat: Vec<f64> = known
            .iter()
            .flat_map(|(_, corner_index)| [corner_index.x, corner_index.y])
            .collect();
        let found = earcutr::earcut(&flat, &starts, 2).expect("a loop has points");
        let triangle = |three: &[usize]| {
            let [(a, p), (b, q), (c, r)] = [0, 1, 2].map(|i| known[three[i]]);
            match (q - p).cross(r - p) < 0.0 {
                true => [a, c, b],
                false => [a, b, c],
            }
        };
        let mut triangles: Vec<_> = found.chunks_exact(3).map(triangle).collect();
        split_at_corners(&mut triangles, &known);
        self.mesh.triangles.extend(triangles);
    }

    fn add_wall(&mut self, face: &Face, side: Segment, end: Vector) {
        let level = |edge: usize| self.solid.edges[edge].ends.map(|(_, level)| level);
        let edges = &face.loops[0];
        let upright = |&(edge, _): &(usize, bool)| {
            let [low, high] = level(edge);
            low != high
        };
        let first = edges.iter().position(upright).unwrap_or(0);
        let mut low = self.trail(&edges[..first]);
        low.push(self.first_or_last_corner(edges[first], false));
        let mut high = self.trail(&edges[first + 1..edges.len() - 1]);
        high.push(self.first_or_last_corner(edges[edges.len() - 1], false));
        high.reverse();
        let along = |&corner: &usize| {
            let [x, y, _] = self.mesh.corners[corner];
            position_along(side, end, Vector::new(x, y))
        };
        let distances = |chain: &[usize]| {
            let mut ways: Vec<f64> = chain.iter().map(along).collect();
            ways[0] = 0.0;
            ways
        };
        let (low_ways, high_ways) = (distances(&low), distances(&high));
        let (mut i, mut j) = (0, 0);
        let mut triangles = Vec::new();
        while i + 1 < low.len() || j + 1 < high.len() {
            let is_low_next =
                j + 1 == high.len() || (i + 1 < low.len() && low_ways[i + 1] <= high_ways[j + 1]);
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
    fn first_or_last_corner(&self, (edge, forward): (usize, bool), is_last: bool) -> usize {
        let line = &self.lines[edge];
        if forward == is_last {
            line[line.len() - 1]
        } else {
            line[0]
        }
    }
}

/// Divides triangles at the corners that lie on their sides. The triangulation leaves out points on a straight
/// line, but walls and other triangles have corners at these points.
fn split_at_corners(triangles: &mut Vec<[usize; 3]>, corners: &[(usize, Vector)]) {
    let mut done = 0;
    while done < triangles.len() {
        let triangle = triangles[done];
        let found = (0..3).find_map(|i| {
            let [a, b, c] = [0, 1, 2].map(|k| triangle[(i + k) % 3]);
            let within = corners_between(corners, a, b);
            (!within.is_empty()).then_some((a, within, b, c))
        });
        let Some((a, within, b, c)) = found else {
            done += 1;
            continue;
        };
        triangles.swap_remove(done);
        if within.contains(&c) {
            // The triangle has no area, and its neighbours touch each other without it.
            continue;
        }
        let chain = [&[a][..], &within, &[b]].concat();
        triangles.extend(chain.windows(2).map(|pair| [pair[0], pair[1], c]));
    }
}

/// The corners on the line between two others, in order; the two are not included.
fn corners_between(corners: &[(usize, Vector)], a: usize, b: usize) -> Vec<usize> {
    let find = |which: usize| corners.iter().find(|(corner, _)| *corner == which);
    let (Some(&(_, from)), Some(&(_, to))) = (find(a), find(b)) else {
        return Vec::new();
    };
    let (long, line) = ((to - from).length(), to - from);
    let along = |&(corner, at): &(usize, Vector)| {
        let along = (at - from).dot(line) / long;
        let beside = line.cross(at - from) / long;
        let within = beside.abs() < 1e-7 && along > 0.0 && along < long;
        within.then_some((along, corner))
    };
    let others = corners
        .iter()
        .filter(|(corner, _)| *corner != a && *corner != b);
    let mut found: Vec<(f64, usize)> = others.filter_map(along).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, corner)| corner).collect()
}
