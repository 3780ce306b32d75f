//! A part as a STEP file (ISO 10303-21, AP214): a solid of planes and cylinders.
//!
//! This is our own writer, because existing ones turn circles into splines: then a
//! drawing program no longer knows that a hole is round, or where its centre is.

use std::fmt::Write;

use lizard_kinematics::Vector;

use crate::files::solid::{Solid, Surface};
use crate::layers::outline::Side;

/// The text of a STEP file.
#[must_use]
pub fn step(name: &str, solid: &Solid) -> String {
    let mut file = File::default();
    let solid = file.solid(name, solid);
    file.product(name, solid);
    let data = file.text;
    format!(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('{name}, mm'),'2;1');\n\
         FILE_NAME('{name}.step','2000-01-01T00:00:00',(''),(''),'','lizard parts','');\n\
         FILE_SCHEMA(('AUTOMOTIVE_DESIGN {{ 1 0 10303 214 1 1 1 1 }}'));\nENDSEC;\nDATA;\n{data}ENDSEC;\n\
         END-ISO-10303-21;\n"
    )
}

#[derive(Default)]
struct File {
    text: String,
    last: usize,
}

/// A number in the format's notation: with a point, and without an exponent, which some
/// readers misread.
fn real(value: f64) -> String {
    let text = format!("{value:.9}");
    let text = text.trim_end_matches('0');
    if text == "-0." { "0." } else { text }.to_owned()
}

fn list(ids: &[usize]) -> String {
    let ids: Vec<_> = ids.iter().map(|id| format!("#{id}")).collect();
    format!("({})", ids.join(","))
}

impl File {
    fn add(&mut self, entity: &str) -> usize {
        self.last += 1;
        let _ = writeln!(self.text, "#{}={entity};", self.last);
        self.last
    }

    fn triple(&mut self, kind: &str, [x, y, z]: [f64; 3]) -> usize {
        self.add(&format!("{kind}('',({},{},{}))", real(x), real(y), real(z)))
    }

    /// A frame by its origin, its z axis and its x axis.
    fn frame(&mut self, origin: [f64; 3], z: [f64; 3], x: [f64; 3]) -> usize {
        let origin = self.triple("CARTESIAN_POINT", origin);
        let z = self.triple("DIRECTION", z);
        let x = self.triple("DIRECTION", x);
        self.add(&format!("AXIS2_PLACEMENT_3D('',#{origin},#{z},#{x})"))
    }

    fn solid(&mut self, name: &str, solid: &Solid) -> usize {
        let mut corners = std::collections::BTreeMap::new();
        let mut edges = Vec::new();
        for edge in &solid.edges {
            let places = edge.ends.map(|(point, level)| {
                let (at, z) = (solid.points[point], solid.heights[level]);
                [at.x, at.y, z]
            });
            let [from, to] = [0, 1].map(|i| {
                *corners.entry(edge.ends[i]).or_insert_with(|| {
                    let at = self.triple("CARTESIAN_POINT", places[i]);
                    self.add(&format!("VERTEX_POINT('',#{at})"))
                })
            });
            let curve = self.curve(places, edge.bulge);
            edges.push(self.add(&format!("EDGE_CURVE('',#{from},#{to},#{curve},.T.)")));
        }
        let faces: Vec<_> = solid
            .faces
            .iter()
            .map(|face| {
                let bounds: Vec<_> = face
                    .loops
                    .iter()
                    .enumerate()
                    .map(|(number, trail)| {
                        let trail: Vec<_> = trail
                            .iter()
                            .map(|&(edge, forward)| {
                                let way = if forward { "T" } else { "F" };
                                self.add(&format!("ORIENTED_EDGE('',*,*,#{},.{way}.)", edges[edge]))
                            })
                            .collect();
                        let trail = self.add(&format!("EDGE_LOOP('',{})", list(&trail)));
                        let kind = if number == 0 {
                            "FACE_OUTER_BOUND"
                        } else {
                            "FACE_BOUND"
                        };
                        self.add(&format!("{kind}('',#{trail},.T.)"))
                    })
                    .collect();
                let (surface, sense) = self.surface(solid, face.surface);
                let sense = if sense { "T" } else { "F" };
                self.add(&format!(
                    "ADVANCED_FACE('',{},#{surface},.{sense}.)",
                    list(&bounds)
                ))
            })
            .collect();
        let shell = self.add(&format!("CLOSED_SHELL('',{})", list(&faces)));
        self.add(&format!("MANIFOLD_SOLID_BREP('{name}',#{shell})"))
    }

    fn curve(&mut self, [from, to]: [[f64; 3]; 2], bulge: f64) -> usize {
        let side = Side {
            from: Vector::new(from[0], from[1]),
            bulge,
        };
        if let Some((centre, radius)) = side.arc(Vector::new(to[0], to[1])) {
            let frame = self.frame(
                [centre.x, centre.y, from[2]],
                [0.0, 0.0, bulge.signum()],
                [1.0, 0.0, 0.0],
            );
            return self.add(&format!("CIRCLE('',#{frame},{})", real(radius)));
        }
        let way = [0, 1, 2].map(|i| to[i] - from[i]);
        let long = way.iter().map(|part| part * part).sum::<f64>().sqrt();
        let origin = self.triple("CARTESIAN_POINT", from);
        let way = self.triple("DIRECTION", way.map(|part| part / long));
        let vector = self.add(&format!("VECTOR('',#{way},1.)"));
        self.add(&format!("LINE('',#{origin},#{vector})"))
    }

    /// A face's surface, and true if the face's outside is where the surface's normal points.
    fn surface(&mut self, solid: &Solid, surface: Surface) -> (usize, bool) {
        match surface {
            Surface::Top(level) | Surface::Bottom(level) => {
                let up = matches!(surface, Surface::Top(_));
                let frame = self.frame(
                    [0.0, 0.0, solid.heights[level]],
                    [0.0, 0.0, if up { 1.0 } else { -1.0 }],
                    [1.0, 0.0, 0.0],
                );
                (self.add(&format!("PLANE('',#{frame})")), true)
            }
            Surface::Wall(side, end) => match side.arc(end) {
                Some((centre, radius)) => {
                    let frame =
                        self.frame([centre.x, centre.y, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
                    let round = format!("CYLINDRICAL_SURFACE('',#{frame},{})", real(radius));
                    (self.add(&round), side.bulge > 0.0)
                }
                None => {
                    let along = (end - side.from) * (1.0 / (end - side.from).length());
                    let out = along.right();
                    let frame = self.frame(
                        [side.from.x, side.from.y, 0.0],
                        [out.x, out.y, 0.0],
                        [along.x, along.y, 0.0],
                    );
                    (self.add(&format!("PLANE('',#{frame})")), true)
                }
            },
        }
    }

    /// The product's header, which readers require, and its units.
    fn product(&mut self, name: &str, solid: usize) {
        let context = self.add("APPLICATION_CONTEXT('automotive design')");
        self.add(&format!(
            "APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#{context})"
        ));
        let of = self.add(&format!("PRODUCT_CONTEXT('',#{context},'mechanical')"));
        let product = self.add(&format!("PRODUCT('{name}','{name}','',(#{of}))"));
        let formation = self.add(&format!("PRODUCT_DEFINITION_FORMATION('','',#{product})"));
        let stage = self.add(&format!(
            "PRODUCT_DEFINITION_CONTEXT('part definition',#{context},'design')"
        ));
        let definition = self.add(&format!(
            "PRODUCT_DEFINITION('design','',#{formation},#{stage})"
        ));
        let shape = self.add(&format!("PRODUCT_DEFINITION_SHAPE('','',#{definition})"));
        let mm = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
        let rad = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
        let sr = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
        let fine = self.add(&format!(
            "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-05),#{mm},'distance_accuracy_value','')"
        ));
        let space = self.add(&format!(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{fine}))\
             GLOBAL_UNIT_ASSIGNED_CONTEXT((#{mm},#{rad},#{sr}))REPRESENTATION_CONTEXT('',''))"
        ));
        let frame = self.frame([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        let body = self.add(&format!(
            "ADVANCED_BREP_SHAPE_REPRESENTATION('',(#{frame},#{solid}),#{space})"
        ));
        self.add(&format!(
            "SHAPE_DEFINITION_REPRESENTATION(#{shape},#{body})"
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_point_and_no_exponent() {
        for (value, text) in [
            (0.0, "0."),
            (-1e-16, "0."),
            (12.0, "12."),
            (-0.5, "-0.5"),
            (1e-7, "0.0000001"),
            (138.590378, "138.590378"),
        ] {
            assert_eq!(real(value), text);
        }
    }
}
