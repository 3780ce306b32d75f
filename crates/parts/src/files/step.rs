//! A part as a STEP file (ISO 10303-21, AP214): a solid of planes, cylinders and cones.
//!
//! Existing writers convert circles to splines, so a CAD program would not recognise a hole as round or find its
//! centre. This module therefore has its own writer.

use std::fmt::Write;

use lizard_kinematics::Vector;

use crate::files::solid::{Face, Solid, Surface};
use crate::layers::outline::Segment;

/// Formats a solid as a STEP file.
pub fn format_step(name: &str, solid: &Solid) -> String {
    let mut writer = StepWriter::default();
    let solid_id = writer.add_solid(name, solid);
    writer.add_product(name, solid_id);
    let data_section = writer.text;
    format!(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('{name}, mm'),'2;1');\n\
         FILE_NAME('{name}.step','2000-01-01T00:00:00',(''),(''),'','lizard parts','');\n\
         FILE_SCHEMA(('AUTOMOTIVE_DESIGN {{ 1 0 10303 214 1 1 1 1 }}'));\nENDSEC;\nDATA;\n{data_section}ENDSEC;\n\
         END-ISO-10303-21;\n"
    )
}

/// The entities that describe the product and its units, one per line; see [`StepWriter::add_product`].
const PRODUCT: &str = include_str!("product.step");

/// The index of the entity PRODUCT_DEFINITION_SHAPE in [`PRODUCT`].
const PRODUCT_SHAPE_INDEX: usize = 7;

/// The data section of a STEP file. Each method that adds an entity returns the number of the entity.
#[derive(Default)]
struct StepWriter {
    text: String,
    /// Number of the entity added last.
    last_id: usize,
}

/// Formats a number as STEP requires: with a decimal point, and without an exponent, which some programs misread.
fn format_real(number: f64) -> String {
    let text = format!("{number:.9}");
    let text = text.trim_end_matches('0');
    if text == "-0." { "0." } else { text }.to_owned()
}

fn format_list(ids: &[usize]) -> String {
    let ids: Vec<_> = ids.iter().map(|id| format!("#{id}")).collect();
    format!("({})", ids.join(","))
}

impl StepWriter {
    fn add(&mut self, entity: &str) -> usize {
        self.last_id += 1;
        let _ = writeln!(self.text, "#{}={entity};", self.last_id);
        self.last_id
    }

    fn add_triple(&mut self, kind: &str, coordinates: [f64; 3]) -> usize {
        let [x, y, z] = coordinates.map(format_real);
        self.add(&format!("{kind}('',({x},{y},{z}))"))
    }

    /// Adds a frame with an origin, a z axis and an x axis.
    fn add_frame(&mut self, origin: [f64; 3], z: [f64; 3], x: [f64; 3]) -> usize {
        let origin = self.add_triple("CARTESIAN_POINT", origin);
        let z = self.add_triple("DIRECTION", z);
        let x = self.add_triple("DIRECTION", x);
        self.add(&format!("AXIS2_PLACEMENT_3D('',#{origin},#{z},#{x})"))
    }

    /// Adds a frame with its z axis up if `z` is 1, down if it is -1.
    fn add_vertical_frame(&mut self, origin: Vector, height: f64, z: f64) -> usize {
        self.add_frame([origin.x, origin.y, height], [0.0, 0.0, z], [1.0, 0.0, 0.0])
    }

    fn add_solid(&mut self, name: &str, solid: &Solid) -> usize {
        let mut corners = std::collections::BTreeMap::new();
        let mut edges = Vec::new();
        for edge in &solid.edges {
            let ends = edge.ends.map(|(point, level)| {
                let (position, z) = (solid.points[point], solid.heights[level]);
                [position.x, position.y, z]
            });
            let [from, to] = [0, 1].map(|i| {
                *corners.entry(edge.ends[i]).or_insert_with(|| {
                    let point_id = self.add_triple("CARTESIAN_POINT", ends[i]);
                    self.add(&format!("VERTEX_POINT('',#{point_id})"))
                })
            });
            let curve = self.add_curve(ends, edge.bulge);
            edges.push(self.add(&format!("EDGE_CURVE('',#{from},#{to},#{curve},.T.)")));
        }
        let add_face = |face| self.add_face(solid, face, &edges);
        let faces: Vec<_> = solid.faces.iter().map(add_face).collect();
        let shell_id = self.add(&format!("CLOSED_SHELL('',{})", format_list(&faces)));
        self.add(&format!("MANIFOLD_SOLID_BREP('{name}',#{shell_id})"))
    }

    fn add_face(&mut self, solid: &Solid, face: &Face, edges: &[usize]) -> usize {
        let format_logical = |value: bool| if value { "T" } else { "F" };
        let mut bounds = Vec::new();
        for edge_loop in &face.loops {
            let mut oriented_edges = Vec::new();
            for &(edge, is_forward) in edge_loop {
                let (edge, orientation) = (edges[edge], format_logical(is_forward));
                oriented_edges
                    .push(self.add(&format!("ORIENTED_EDGE('',*,*,#{edge},.{orientation}.)")));
            }
            let edge_loop = self.add(&format!("EDGE_LOOP('',{})", format_list(&oriented_edges)));
            let kind = match bounds.is_empty() {
                true => "FACE_OUTER_BOUND",
                false => "FACE_BOUND",
            };
            bounds.push(self.add(&format!("{kind}('',#{edge_loop},.T.)")));
        }
        let (surface, sense) = self.add_surface(solid, face.surface);
        let (bounds, sense) = (format_list(&bounds), format_logical(sense));
        self.add(&format!("ADVANCED_FACE('',{bounds},#{surface},.{sense}.)"))
    }

    fn add_curve(&mut self, [from, to]: [[f64; 3]; 2], bulge: f64) -> usize {
        let side = Segment::new(Vector::new(from[0], from[1]), bulge);
        if let Some((centre, radius)) = side.arc(Vector::new(to[0], to[1])) {
            let frame = self.add_vertical_frame(centre, from[2], bulge.signum());
            return self.add(&format!("CIRCLE('',#{frame},{})", format_real(radius)));
        }
        let direction = [0, 1, 2].map(|i| to[i] - from[i]);
        let squares = direction.map(|component| component * component);
        let length = squares.iter().sum::<f64>().sqrt();
        let origin = self.add_triple("CARTESIAN_POINT", from);
        let direction = self.add_triple("DIRECTION", direction.map(|component| component / length));
        let vector = self.add(&format!("VECTOR('',#{direction},1.)"));
        self.add(&format!("LINE('',#{origin},#{vector})"))
    }

    /// Adds the surface of a face. Also returns true if the surface's normal points out of the part.
    fn add_surface(&mut self, solid: &Solid, surface: Surface) -> (usize, bool) {
        match surface {
            Surface::Top(level) | Surface::Bottom(level) => {
                let is_top = matches!(surface, Surface::Top(_));
                let (height, z) = (solid.heights[level], if is_top { 1.0 } else { -1.0 });
                let frame = self.add_vertical_frame(Vector::default(), height, z);
                (self.add(&format!("PLANE('',#{frame})")), true)
            }
            Surface::Slope {
                side,
                end,
                level,
                upper_radius,
            } => {
                let (centre, radius) = side.arc(end).expect("a slope's side is an arc");
                let [low, high] = [level, level + 1].map(|level| solid.heights[level]);
                // A cone's angle is positive in STEP, so a cone that narrows upward gets a frame that points down.
                let z_direction = if radius > upper_radius { -1.0 } else { 1.0 };
                let frame = self.add_vertical_frame(centre, low, z_direction);
                let angle = libm::atan((upper_radius - radius).abs() / (high - low));
                let (radius, angle) = (format_real(radius), format_real(angle));
                let cone = format!("CONICAL_SURFACE('',#{frame},{radius},{angle})");
                (self.add(&cone), side.bulge > 0.0)
            }
            Surface::Wall { side, end } => match side.arc(end) {
                Some((centre, radius)) => {
                    let frame = self.add_vertical_frame(centre, 0.0, 1.0);
                    let radius = format_real(radius);
                    let cylinder = format!("CYLINDRICAL_SURFACE('',#{frame},{radius})");
                    (self.add(&cylinder), side.bulge > 0.0)
                }
                None => {
                    let direction = (end - side.from) * (1.0 / (end - side.from).length());
                    let [origin, normal, direction] =
                        [side.from, direction.rotated_right(), direction]
                            .map(|point| [point.x, point.y, 0.0]);
                    let frame = self.add_frame(origin, normal, direction);
                    (self.add(&format!("PLANE('',#{frame})")), true)
                }
            },
        }
    }

    /// Adds the entities of the product, which CAD programs require, and the units.
    fn add_product(&mut self, name: &str, solid_id: usize) {
        let first_id = self.last_id + 1;
        // `#+3` stands for the third entity of the list, `#NAME` for the part's name.
        for entity in PRODUCT.lines() {
            let mut entity = entity.replace("#NAME", name);
            for number in (0..12).rev() {
                let local_id = format!("#+{}", number + 1);
                entity = entity.replace(&local_id, &format!("#{}", first_id + number));
            }
            self.add(&entity);
        }
        let (shape_id, context_id) = (first_id + PRODUCT_SHAPE_INDEX, self.last_id);
        let frame = self.add_vertical_frame(Vector::default(), 0.0, 1.0);
        let body_id = self.add(&format!(
            "ADVANCED_BREP_SHAPE_REPRESENTATION('',(#{frame},#{solid_id}),#{context_id})"
        ));
        self.add(&format!(
            "SHAPE_DEFINITION_REPRESENTATION(#{shape_id},#{body_id})"
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_formatted_with_a_point_and_without_exponent_or_negative_zero() {
        for (value, text) in [
            (0.0, "0."),
            (-1e-16, "0."),
            (12.0, "12."),
            (-0.5, "-0.5"),
            (1e-7, "0.0000001"),
            (138.590378, "138.590378"),
        ] {
            assert_eq!(format_real(value), text);
        }
    }
}
