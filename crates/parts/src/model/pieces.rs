//! Shapes and masses of the parts, grouped by the rigid bodies of the model.

use lizard_kinematics::Vector;
use lizard_robot::servo::LEG_NAMES;

use super::Pieces;
use super::inertia::Inertia;
use super::node::Node;
use super::scene::Scene;
use crate::bill;
use crate::bodies::assembly::Assembly;
use crate::build_error::BuildError;
use crate::files::mesh::Mesh;
use crate::files::solid::Solid;
use crate::layers::body::{Body, Kind, Mount, Prism};
use crate::layers::outline::Outline;
use crate::layers::shape::Shape;
use crate::part::compute_volume;

/// Radius of a foot's post about its middle, mm. Layers of the foot that are farther away belong to leaf or column.
const POST_RADIUS: f64 = 8.0;

/// The layers of a part that move with one body of the model.
pub(super) struct Piece {
    /// Name of the part, which also names the mesh.
    pub name: String,
    /// Body of the model with which the layers move.
    pub node: Node,
    /// Kind of the part.
    pub kind: Kind,
    /// Surface, frame of `node`, mm.
    pub mesh: Mesh,
    /// Moments of the mass about the origin of that frame.
    pub inertia: Inertia,
}

impl<'a> Pieces<'a> {
    /// Computes the shapes and masses for a scene, with the scene's kind of struts.
    ///
    /// # Errors
    /// Returns [`BuildError::OpenSurface`] if the layers of a part do not form a closed surface.
    pub fn compute(assembly: &'a Assembly, scene: &Scene) -> Result<Self, BuildError> {
        let has_slotted_struts = scene.strut_spring.is_some();
        let mut bodies: Vec<&Body> = assembly.bodies().iter().collect();
        let mut pieces = Vec::new();
        // The scene's kind of struts may differ from the assembly's.
        if bodies.iter().any(|body| body.kind == Kind::Spring) != has_slotted_struts {
            bodies.retain(|body| !matches!(body.mount, Mount::Strut(_)));
            bodies.extend(assembly.alternatives());
            if has_slotted_struts {
                pieces.extend((0..4).map(|servo| make_spring_piece(assembly, servo)));
            }
        }
        for body in bodies {
            let density = bill::body_grams(body, assembly) / compute_volume(&body.prisms);
            for (node, prisms) in split_by_node(assembly, scene, body) {
                let is_on_mount = matches!(node, Node::OnMount(_));
                let name = match body.kind {
                    Kind::Printed if !is_on_mount => format!("{} of {}", node.name(), body.name),
                    _ => body.name.clone(),
                };
                let mesh = Mesh::from_prisms(&name, &prisms)?;
                pieces.push(Piece {
                    name,
                    node,
                    kind: body.kind,
                    inertia: Inertia::from_mesh(&mesh).scaled(density),
                    mesh,
                });
            }
        }
        Ok(Self { assembly, pieces })
    }
}

/// Makes the spring of a slotted strut if the assembly has rigid struts: a bar as wide as the coil, which ends one
/// coil diameter before each screw.
fn make_spring_piece(assembly: &Assembly, servo: usize) -> Piece {
    let spring = assembly.robot().parts().spring;
    let length = assembly.layout().legs[servo].strut_length;
    let radius = spring.outer_diameter / 2.0;
    let middle_z = assembly.stack().coil_middle;
    let size = Vector::new(length - 2.0 * spring.outer_diameter, spring.outer_diameter);
    let bar = Shape::rectangle(Vector::new(length / 2.0, 0.0), size, 0.0);
    let bar = Prism::solid([bar], [middle_z - radius, middle_z + radius]);
    let mesh = Mesh::from_solid(&Solid::from_prisms(&[bar]));
    let unit_inertia = Inertia::from_mesh(&mesh);
    Piece {
        name: format!("spring {}", LEG_NAMES[servo]),
        node: Node::SlotPin(servo),
        kind: Kind::Spring,
        inertia: unit_inertia.scaled(bill::spring_grams(&spring) / unit_inertia.mass),
        mesh,
    }
}

/// Groups the layers of a body by the rigid body of the model with which they move. Only a foot has two groups.
fn split_by_node(assembly: &Assembly, scene: &Scene, body: &Body) -> Vec<(Node, Vec<Prism>)> {
    let all_prisms_on = |node: Node| vec![(node, body.prisms.clone())];
    match body.mount {
        Mount::Foot(servo) => {
            let foot = assembly.layout().legs[servo].foot;
            let is_post = |prism: &Prism| (layer_centroid(prism) - foot).length() < POST_RADIUS;
            let (post_prisms, other_prisms): (Vec<_>, Vec<_>) =
                body.prisms.iter().cloned().partition(is_post);
            let mut groups = vec![
                (Node::Pad(servo), post_prisms),
                (Node::OnMount(body.mount), other_prisms),
            ];
            groups.retain(|(_, prisms)| !prisms.is_empty());
            groups
        }
        Mount::Link(servo) if body.kind == Kind::Horn && scene.play > 0.0 => {
            all_prisms_on(Node::Horn(servo))
        }
        Mount::Strut(servo) if body.kind == Kind::Spring => all_prisms_on(Node::SlotPin(servo)),
        mount => all_prisms_on(Node::OnMount(mount)),
    }
}

/// Centroid of a layer, mm.
fn layer_centroid(prism: &Prism) -> Vector {
    let outline = Outline::from_prism(prism);
    outline.first_moment() * (1.0 / outline.area())
}
