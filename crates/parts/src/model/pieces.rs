//! Shapes and masses of the parts, sorted by the rigid bodies of the model.

use lizard_kinematics::Vector;
use lizard_robot::servo::LEG_NAMES;

use super::inertia::Inertia;
use super::node::Node;
use super::scene::Scene;
use crate::bill;
use crate::bodies::assembly::Assembly;
use crate::build_problem::BuildProblem;
use crate::files::mesh::Mesh;
use crate::files::solid::Solid;
use crate::layers::body::{Body, Kind, Mount, Prism};
use crate::layers::outline::Outline;
use crate::layers::shape::Shape;
use crate::part::volume;

/// Radius of a foot's post about its middle, mm. Layers of the foot that are farther away belong to the leaf and
/// the column.
const POST_RADIUS: f64 = 8.0;

/// The layers of one part that move with one body of the model.
pub(super) struct Piece {
    /// The name of the part, which also names the mesh.
    pub name: String,
    /// The body of the model with which the layers move.
    pub node: Node,
    /// The kind of the part.
    pub kind: Kind,
    /// The surface, mm, in the frame of `node`.
    pub mesh: Mesh,
    /// The moments of the mass about the origin of that frame.
    pub inertia: Inertia,
}

/// Computes the pieces of all parts, with the kind of struts that the scene has.
pub(super) fn compute_pieces(
    assembly: &Assembly,
    scene: &Scene,
) -> Result<Vec<Piece>, BuildProblem> {
    let has_slotted_struts = scene.strut_spring.is_some();
    let is_strut = |body: &&Body| matches!(body.mount, Mount::Strut(_));
    let has_spring = |bodies: &[Body]| bodies.iter().any(|body| body.kind == Kind::Spring);
    // The scene may have another kind of struts than the assembly.
    let swaps_struts = has_spring(assembly.bodies()) != has_slotted_struts;
    let all_bodies = assembly.bodies().iter();
    let kept_bodies = all_bodies.filter(|body| !(swaps_struts && is_strut(body)));
    let replacement_bodies = assembly.alternatives().iter().filter(|_| swaps_struts);
    let springs = (0..4).filter(|_| swaps_struts && has_slotted_struts);
    let mut pieces: Vec<Piece> = springs.map(|servo| spring_piece(assembly, servo)).collect();
    for body in kept_bodies.chain(replacement_bodies) {
        let grams = bill::body_grams(body, assembly);
        let volume = volume(&body.prisms);
        for (node, prisms) in split_by_node(assembly, scene, body) {
            let name = match node {
                Node::OnMount(_) => body.name.clone(),
                node if body.kind == Kind::Printed => format!("{} of {}", node.name(), body.name),
                _ => body.name.clone(),
            };
            let solid = Solid::of(&prisms);
            let mesh = Mesh::of(&solid);
            if !solid.is_closed() || !mesh.is_closed() {
                return Err(BuildProblem::OpenSurface(name));
            }
            pieces.push(Piece {
                name,
                node,
                kind: body.kind,
                inertia: Inertia::of(&mesh).scaled(grams / volume),
                mesh,
            });
        }
    }
    Ok(pieces)
}

/// The spring of a slotted strut that the assembly does not draw: a bar as wide as the coil, from screw to screw.
fn spring_piece(assembly: &Assembly, servo: usize) -> Piece {
    let spring = assembly.robot().parts().spring;
    let length = assembly.layout().legs[servo].strut_length;
    let radius = spring.outer_diameter / 2.0;
    let middle_z = assembly.stack().strut_floor[1];
    let size = Vector::new(length - 2.0 * spring.outer_diameter, spring.outer_diameter);
    let bar = Shape::rectangle(Vector::new(length / 2.0, 0.0), size, 0.0);
    let bar = Prism::solid([bar], [middle_z - radius, middle_z + radius]);
    let mesh = Mesh::of(&Solid::of(&[bar]));
    let inertia_at_unit_density = Inertia::of(&mesh);
    Piece {
        name: format!("spring {}", LEG_NAMES[servo]),
        node: Node::SlotPin(servo),
        kind: Kind::Spring,
        inertia: inertia_at_unit_density
            .scaled(bill::spring_grams(&spring) / inertia_at_unit_density.mass),
        mesh,
    }
}

/// Sorts the layers of a body by the rigid body of the model with which they move. Only a foot's layers move with
/// two of them.
fn split_by_node(assembly: &Assembly, scene: &Scene, body: &Body) -> Vec<(Node, Vec<Prism>)> {
    let all_prisms_on = |node: Node| vec![(node, body.prisms.clone())];
    match body.mount {
        Mount::Foot(servo) => {
            let foot = assembly.layout().legs[servo].foot;
            let is_post = |prism: &Prism| (centroid_of(prism) - foot).length() < POST_RADIUS;
            let (post_prisms, other_prisms): (Vec<_>, Vec<_>) =
                body.prisms.iter().cloned().partition(is_post);
            let groups = [
                (Node::Pad(servo), post_prisms),
                (Node::OnMount(body.mount), other_prisms),
            ]
            .into_iter();
            let nonempty_groups = groups.filter(|(_, prisms)| !prisms.is_empty());
            nonempty_groups.collect()
        }
        Mount::Link(servo) if body.kind == Kind::Horn && scene.play > 0.0 => {
            all_prisms_on(Node::Horn(servo))
        }
        Mount::Strut(servo) if body.kind == Kind::Spring => all_prisms_on(Node::SlotPin(servo)),
        mount => all_prisms_on(Node::OnMount(mount)),
    }
}

/// The centroid of a layer, mm.
fn centroid_of(prism: &Prism) -> Vector {
    let outline = Outline::of(prism);
    outline.first_moment() * (1.0 / outline.area())
}
