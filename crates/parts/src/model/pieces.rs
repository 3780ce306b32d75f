//! Shapes and masses of the parts, grouped by the rigid bodies of the model.

use lizard_kinematics::Vector;
use lizard_robot::servo::LEG_NAMES;

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

/// Computes the pieces of all parts, with the scene's kind of struts.
pub(super) fn compute_pieces(assembly: &Assembly, scene: &Scene) -> Result<Vec<Piece>, BuildError> {
    let has_slotted_struts = scene.strut_spring.is_some();
    let is_strut = |body: &&Body| matches!(body.mount, Mount::Strut(_));
    let has_spring = |bodies: &[Body]| bodies.iter().any(|body| body.kind == Kind::Spring);
    // The scene's kind of struts may differ from the assembly's.
    let swaps_struts = has_spring(assembly.bodies()) != has_slotted_struts;
    let all_bodies = assembly.bodies().iter();
    let kept_bodies = all_bodies.filter(|body| !(swaps_struts && is_strut(body)));
    let replacement_bodies = assembly.alternatives().iter().filter(|_| swaps_struts);
    let missing_springs = (0..4).filter(|_| swaps_struts && has_slotted_struts);
    let mut pieces: Vec<Piece> = missing_springs
        .map(|servo| make_spring_piece(assembly, servo))
        .collect();
    for body in kept_bodies.chain(replacement_bodies) {
        let grams = bill::body_grams(body, assembly);
        let volume = compute_volume(&body.prisms);
        for (node, prisms) in split_by_node(assembly, scene, body) {
            let name = match node {
                Node::OnMount(_) => body.name.clone(),
                node if body.kind == Kind::Printed => format!("{} of {}", node.name(), body.name),
                _ => body.name.clone(),
            };
            let solid = Solid::from_prisms(&prisms);
            let mesh = Mesh::from_solid(&solid);
            if !solid.is_closed() || !mesh.is_closed() {
                return Err(BuildError::OpenSurface(name));
            }
            pieces.push(Piece {
                name,
                node,
                kind: body.kind,
                inertia: Inertia::from_mesh(&mesh).scaled(grams / volume),
                mesh,
            });
        }
    }
    Ok(pieces)
}

/// Makes the spring of a slotted strut if the assembly has rigid struts: a bar as wide as the coil, from screw to
/// screw.
fn make_spring_piece(assembly: &Assembly, servo: usize) -> Piece {
    let spring = assembly.robot().parts().spring;
    let length = assembly.layout().legs[servo].strut_length;
    let radius = spring.outer_diameter / 2.0;
    let middle_z = assembly.stack().strut_floor[1];
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
