//! A part as a solid: flat faces, walls and slopes that share their edges.
//!
//! A stack of layers has walls along the outlines, and flat faces where a layer's top or bottom is not covered by its
//! neighbour. The outlines of two layers may coincide along a part of their length, so at each height both outlines are
//! cut where they intersect. Every piece is then one edge, which exactly two faces share. The STEP solid is therefore
//! valid and the mesh has no gaps.

use std::collections::BTreeMap;

use cavalier_contours::polyline::{PlineSegIntr, PlineVertex, pline_seg_intr};
use lizard_kinematics::Vector;

use crate::layers::body::Prism;
use crate::layers::outline::{self, Loop, Outline, SAME_POINT_MM, Segment};

/// A part as points, edges and faces. A `level` is the index of a height.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solid {
    /// Points seen from above, mm.
    pub points: Vec<Vector>,
    /// Heights of the boundaries between layers, ascending, mm.
    pub heights: Vec<f64>,
    /// Lines and arcs between points.
    pub edges: Vec<Edge>,
    /// Flat faces, walls and slopes.
    pub faces: Vec<Face>,
    /// Enclosed volume, mm^3.
    pub volume: f64,
}

/// An edge between two corners: at one height, vertical (one point, two heights), or sloping (two points, two heights).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// The two corners, each as the indices of a point and of a height.
    pub ends: [(usize, usize); 2],
    /// The bulge, as in [`Segment`]; 0 if straight.
    pub bulge: f64,
}

/// A face: loops of edges. Each edge has a flag: true if the loop runs in the edge's direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// The surface on which the face lies.
    pub surface: Surface,
    /// The outer loop, counter-clockwise seen from outside the part, then its holes.
    pub loops: Vec<Vec<(usize, bool)>>,
}

/// The plane, cylinder or cone on which a face lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    /// A horizontal plane seen from above, by the index of its height.
    Top(usize),
    /// A horizontal plane seen from below, by the index of its height.
    Bottom(usize),
    /// A wall along a side of an outline.
    Wall {
        /// The side.
        side: Segment,
        /// The side's end point.
        end: Vector,
    },
    /// A piece of a cone above an arc of an outline.
    Slope {
        /// The arc.
        side: Segment,
        /// The arc's end point.
        end: Vector,
        /// The index of the arc's height.
        level: usize,
        /// The cone's radius at the next height, mm.
        upper_radius: f64,
    },
}

/// A piece of an outline at a height. All numbers are indices.
#[derive(Clone, Copy)]
struct Piece {
    /// Start point.
    from: usize,
    /// End point.
    to: usize,
    /// Middle of the piece, in [`SolidBuilder::middles`].
    middle: usize,
    /// Edge of the solid on which the piece lies.
    edge: usize,
    /// True if the piece runs in the direction of its edge.
    is_forward: bool,
}

impl Solid {
    /// Builds the solid of a stack of prisms, the layers, listed from the lowest to the highest.
    pub fn from_prisms(prisms: &[Prism]) -> Self {
        let outlines_at = |fraction| {
            let to_outline = |prism: &Prism| Outline::from_prism(&prism.cross_section(fraction));
            prisms.iter().map(to_outline).collect::<Vec<_>>()
        };
        let (bottoms, tops) = (outlines_at(0.0), outlines_at(1.0));
        let mut builder = SolidBuilder::default();
        let top = prisms.last().map(|last| last.z[1]);
        let heights = prisms.iter().map(|prism| prism.z[0]).chain(top);
        builder.solid.heights = heights.collect();
        let empty_outline = Outline::default();
        let mut pieces_below: Vec<Vec<Piece>> = Vec::new();
        for level in 0..=prisms.len() {
            // The top outline of the layer below, and the bottom outline of the layer above.
            let lower = level.checked_sub(1).map_or(&empty_outline, |k| &tops[k]);
            let upper = bottoms.get(level).unwrap_or(&empty_outline);
            let lower_pieces = builder.split_outline(level, lower, upper);
            let upper_pieces = builder.split_outline(level, upper, lower);
            builder.add_flat_faces(level, (lower, &lower_pieces), (upper, &upper_pieces));
            if let Some(layer) = level.checked_sub(1) {
                let outlines = [&bottoms[layer], &tops[layer]];
                builder.add_walls_and_slopes(level, outlines, &pieces_below, &lower_pieces);
            }
            pieces_below = upper_pieces;
        }
        builder.solid.volume = prisms.iter().map(outline::compute_volume).sum();
        builder.solid
    }

    /// True if every edge belongs to exactly two faces, whose loops run along it in opposite directions.
    pub fn is_closed(&self) -> bool {
        let mut use_counts = vec![[0, 0]; self.edges.len()];
        for &(edge, is_forward) in self.faces.iter().flat_map(|face| &face.loops).flatten() {
            use_counts[edge][usize::from(is_forward)] += 1;
        }
        use_counts.iter().all(|uses| *uses == [1, 1])
    }
}

/// A layer's outline and its pieces at a height.
type OutlineAndPieces<'a> = (&'a Outline, &'a [Vec<Piece>]);

/// The solid built so far, and the indices of its edges.
#[derive(Default)]
struct SolidBuilder {
    solid: Solid,
    /// Indices of the horizontal edges. A key is the level, the two points, and the middle of the piece.
    edge_indices: BTreeMap<(usize, usize, usize, usize), usize>,
    /// Middles of pieces, which distinguish two arcs between the same points.
    middles: Vec<Vector>,
    /// Index of the edge from a height to the next one, by lower point, upper point and upper level.
    rising_edge_indices: BTreeMap<(usize, usize, usize), usize>,
}

/// Returns the index of a point in a list; adds the point if no point is within [`SAME_POINT_MM`].
fn find_or_add(points: &mut Vec<Vector>, point: Vector) -> usize {
    let is_near =
        |listed: &Vector| (*listed - point).length_squared() < SAME_POINT_MM * SAME_POINT_MM;
    points.iter().position(is_near).unwrap_or_else(|| {
        points.push(point);
        points.len() - 1
    })
}

impl SolidBuilder {
    /// Divides each side of an outline into pieces at its intersections with another outline.
    fn split_outline(
        &mut self,
        level: usize,
        outline: &Outline,
        other: &Outline,
    ) -> Vec<Vec<Piece>> {
        let other_sides = collect_sides(other);
        let sides = collect_sides(outline).into_iter();
        sides
            .map(|(side, to)| {
                let mut points_on_side = vec![side.from, to];
                for other_side in &other_sides {
                    add_intersections((side, to), *other_side, &mut points_on_side);
                }
                let points = &mut self.solid.points;
                let position_and_index =
                    |point| (position_along(side, to, point), find_or_add(points, point));
                let mut positions: Vec<(f64, usize)> =
                    points_on_side.into_iter().map(position_and_index).collect();
                // Rounding must not exchange the side's ends.
                positions[0].0 = 0.0;
                positions[1].0 = position_along(side, to, to).max(SAME_POINT_MM);
                positions.sort_by(|(a, _), (b, _)| a.total_cmp(b));
                positions.dedup_by_key(|(_, point)| *point);
                let is_uncut = positions.len() == 2;
                let to_piece = |pair: &[(f64, usize)]| {
                    let [(start, from), (end, to)] = [pair[0], pair[1]];
                    // On an arc, positions are angles.
                    let bulge = match is_uncut || side.bulge == 0.0 {
                        true => side.bulge,
                        false => libm::tan((end - start) / 4.0) * side.bulge.signum(),
                    };
                    self.add_piece(level, from, to, bulge)
                };
                positions.windows(2).map(to_piece).collect()
            })
            .collect()
    }

    /// Returns a piece between two points; adds its edge and its middle if they are new.
    fn add_piece(&mut self, level: usize, from: usize, to: usize, bulge: f64) -> Piece {
        let points = &self.solid.points;
        let midpoint = Segment::new(points[from], bulge).midpoint(points[to]);
        let middle = find_or_add(&mut self.middles, midpoint);
        let key = (level, from.min(to), from.max(to), middle);
        let edges = &mut self.solid.edges;
        let edge = *self.edge_indices.entry(key).or_insert_with(|| {
            let ends = [(from, level), (to, level)];
            edges.push(Edge { ends, bulge });
            edges.len() - 1
        });
        Piece {
            from,
            to,
            middle,
            edge,
            is_forward: edges[edge].ends[0].0 == from,
        }
    }

    /// Adds the flat faces at a height where only one of the two layers has material.
    fn add_flat_faces(&mut self, level: usize, lower: OutlineAndPieces, upper: OutlineAndPieces) {
        let tops = self.subtract(lower, upper);
        self.add_faces(tops, Surface::Top(level), false);
        let bottoms = self.subtract(upper, lower);
        self.add_faces(bottoms, Surface::Bottom(level), true);
    }

    /// Computes the outline of `a` minus `b`, as pieces with the material on their left.
    fn subtract(
        &self,
        (a, a_pieces): OutlineAndPieces,
        (b, b_pieces): OutlineAndPieces,
    ) -> Vec<Piece> {
        let find_in_b = |edge: usize| b_pieces.iter().flatten().find(|piece| piece.edge == edge);
        let mut outline = Vec::new();
        for piece in a_pieces.iter().flatten() {
            let is_kept = match find_in_b(piece.edge) {
                Some(shared_piece) => shared_piece.is_forward != piece.is_forward,
                None => !b.contains(self.middles[piece.middle]),
            };
            if is_kept {
                outline.push(*piece);
            }
        }
        for piece in b_pieces.iter().flatten() {
            let mut all_a_pieces = a_pieces.iter().flatten();
            let is_shared = all_a_pieces.any(|a_piece| a_piece.edge == piece.edge);
            if !is_shared && a.contains(self.middles[piece.middle]) {
                outline.push(Piece {
                    from: piece.to,
                    to: piece.from,
                    is_forward: !piece.is_forward,
                    ..*piece
                });
            }
        }
        outline
    }

    /// Adds the faces whose boundaries are these pieces. Loops of a face seen from below run in the opposite direction.
    fn add_faces(&mut self, mut pieces: Vec<Piece>, surface: Surface, is_bottom: bool) {
        let mut outer_faces: Vec<(f64, Outline, Vec<Vec<Piece>>)> = Vec::new();
        let mut holes = Vec::new();
        while let Some(first_piece) = pieces.pop() {
            let mut piece_loop = vec![first_piece];
            let mut point = first_piece.to;
            while point != first_piece.from
                && let Some(index) = pieces.iter().position(|piece| piece.from == point)
            {
                let next_piece = pieces.swap_remove(index);
                point = next_piece.to;
                piece_loop.push(next_piece);
            }
            let outline_loop = self.build_loop(&piece_loop);
            let area = outline_loop.area();
            if area > 0.0 {
                let islands = vec![vec![outline_loop]];
                outer_faces.push((area, Outline { islands }, vec![piece_loop]));
            } else {
                holes.push(piece_loop);
            }
        }
        // A hole belongs to the smallest outline around it.
        outer_faces.sort_by(|(a, ..), (b, ..)| a.total_cmp(b));
        for hole in holes {
            let point_on_hole = self.middles[hole[0].middle];
            let mut faces = outer_faces.iter_mut();
            let face = faces.find(|(_, outline, _)| outline.contains(point_on_hole));
            if let Some((_, _, loops)) = face {
                loops.push(hole);
            }
        }
        for (_, _, loops) in outer_faces {
            let to_edges = |mut piece_loop: Vec<Piece>| {
                if is_bottom {
                    piece_loop.reverse();
                }
                let to_edge = |piece: Piece| (piece.edge, piece.is_forward != is_bottom);
                piece_loop.into_iter().map(to_edge).collect()
            };
            let loops = loops.into_iter().map(to_edges).collect();
            self.solid.faces.push(Face { surface, loops });
        }
    }

    /// Builds the loop of lines and arcs along these pieces.
    fn build_loop(&self, piece_loop: &[Piece]) -> Loop {
        let to_segment = |piece: &Piece| {
            let bulge = self.solid.edges[piece.edge].bulge;
            let bulge = if piece.is_forward { bulge } else { -bulge };
            Segment::new(self.solid.points[piece.from], bulge)
        };
        let sides = piece_loop.iter().map(to_segment).collect();
        Loop { sides }
    }

    /// Adds the walls and slopes of the layer below a height.
    fn add_walls_and_slopes(
        &mut self,
        level: usize,
        [bottom, top]: [&Outline; 2],
        bottom_pieces: &[Vec<Piece>],
        top_pieces: &[Vec<Piece>],
    ) {
        let sides = collect_sides(bottom).into_iter().zip(collect_sides(top));
        let pieces_by_side = bottom_pieces.iter().zip(top_pieces);
        for ((low, high), ((side, end), (top_side, top_end))) in pieces_by_side.zip(sides) {
            let end_points = |pieces: &[Piece]| Some((pieces.first()?.from, pieces.last()?.to));
            let (Some((low_from, low_to)), Some((high_from, high_to))) =
                (end_points(low), end_points(high))
            else {
                continue;
            };
            let rising_ends = [[low_to, high_to], [low_from, high_from]];
            let [up, down] = rising_ends.map(|ends| self.find_or_add_rising_edge(ends, level));
            let low_edges = low.iter().map(|piece| (piece.edge, piece.is_forward));
            let high_pieces = high.iter().rev();
            let high_edges = high_pieces.map(|piece| (piece.edge, !piece.is_forward));
            let edges = low_edges.chain([(up, true)]).chain(high_edges);
            let surface = match top_side.arc(top_end) {
                Some((_, upper_radius)) if low_from != high_from => Surface::Slope {
                    side,
                    end,
                    level: level - 1,
                    upper_radius,
                },
                _ => Surface::Wall { side, end },
            };
            let loops = vec![edges.chain([(down, false)]).collect()];
            self.solid.faces.push(Face { surface, loops });
        }
    }

    /// Returns the edge from a point at the previous height to a point at this height, vertical or along a slope; adds
    /// the edge if it is new.
    fn find_or_add_rising_edge(&mut self, [from, to]: [usize; 2], level: usize) -> usize {
        let edges = &mut self.solid.edges;
        let index = self.rising_edge_indices.entry((from, to, level));
        *index.or_insert_with(|| {
            let ends = [(from, level - 1), (to, level)];
            edges.push(Edge { ends, bulge: 0.0 });
            edges.len() - 1
        })
    }
}

/// Collects the sides of an outline, each with its end point.
fn collect_sides(outline: &Outline) -> Vec<(Segment, Vector)> {
    let sides = outline.loops().flat_map(Loop::sides_with_end_points);
    sides.collect()
}

/// The distance of a point from a side's start, measured along the side: mm, or rad on an arc.
pub(crate) fn position_along(side: Segment, to: Vector, point: Vector) -> f64 {
    let Some((centre, _)) = side.arc(to) else {
        return (point - side.from).length();
    };
    let (a, b) = (side.from - centre, point - centre);
    let angle = libm::atan2(a.cross(b), a.dot(b)) * side.bulge.signum();
    // Rounding may give the start point a slightly negative angle.
    match angle < -1e-6 {
        true => angle + std::f64::consts::TAU,
        false => angle.max(0.0),
    }
}

/// Adds the points at which two sides intersect, or the two ends of their overlap.
fn add_intersections(
    (a, a_end): (Segment, Vector),
    (b, b_end): (Segment, Vector),
    intersections: &mut Vec<Vector>,
) {
    let vertex_at = |position: Vector| PlineVertex::new(position.x, position.y, 0.0);
    let [a_end, b_end] = [a_end, b_end].map(vertex_at);
    let points = match pline_seg_intr(a.to_vertex(), a_end, b.to_vertex(), b_end, SAME_POINT_MM) {
        PlineSegIntr::NoIntersect => [None, None],
        PlineSegIntr::TangentIntersect { point } | PlineSegIntr::OneIntersect { point } => {
            [Some(point), None]
        }
        PlineSegIntr::TwoIntersects { point1, point2 }
        | PlineSegIntr::OverlappingLines { point1, point2 }
        | PlineSegIntr::OverlappingArcs { point1, point2 } => [Some(point1), Some(point2)],
    };
    let points = points.into_iter().flatten();
    intersections.extend(points.map(|point| Vector::new(point.x, point.y)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::shape::{Shape, vector};

    #[test]
    fn a_plate_with_a_hole_has_eight_faces() {
        let rectangle = Shape::rectangle(vector(0.0, 0.0), vector(20.0, 10.0), 0.0);
        let hole = Shape::disc(vector(1.0, 1.0), 2.0);
        let plate = Prism::new([rectangle], [hole], [0.0, 3.0]);
        let solid = Solid::from_prisms(&[plate]);
        assert!(solid.is_closed());
        // Four walls, the two halves of the hole, top and bottom.
        assert_eq!(solid.faces.len(), 8);
        assert_eq!(solid.edges.len(), 2 * (4 + 2) + 4 + 2);
    }

    #[test]
    fn layers_with_partly_coinciding_outlines_have_a_closed_surface() {
        // A sleeve: floor, two walls, roof.
        let case = Shape::rectangle(vector(0.0, 0.0), vector(40.0, 10.0), 1.0);
        let bore = Shape::rectangle(vector(0.0, 0.0), vector(60.0, 6.0), 0.0);
        let eye = Shape::disc(vector(-15.0, -6.0), 4.0);
        let sleeve = [
            Prism::solid([case.clone(), eye.clone()], [0.0, 1.0]),
            Prism::new([case.clone(), eye], [bore.clone()], [1.0, 3.0]),
            Prism::new([case.clone()], [bore], [3.0, 5.0]),
            Prism::solid([case], [5.0, 6.0]),
        ];
        assert!(Solid::from_prisms(&sleeve).is_closed());
    }
}
