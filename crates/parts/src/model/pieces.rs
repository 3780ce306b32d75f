//! Shapes and masses of the parts, sorted by the rigid bodies of the model.

use lizard_kinematics::Vector;
use lizard_robot::servo::LEGS;

use super::inertia::Inertia;
use super::node::Node;
use super::scene::Scene;
use crate::bill;
use crate::bodies::assembly::Assembly;
use crate::files::mesh::Mesh;
use crate::files::solid::Solid;
use crate::layers::body::{Body, Kind, Mount, Prism};
use crate::layers::outline::Outline;
use crate::layers::shape::Shape;
use crate::part::volume;
use crate::unfit::BuildProblem;

/// Radius of a foot's post about its middle, mm. Layers of the foot that are farther away belong to the leaf and
/// the column.
const POST_RADIUS: f64 = 8.0;

/// The layers of one part that move with one body of the model.
pub(super) struct Piece {
    pub name: String,
    pub node: Node,
    pub kind: Kind,
    pub mesh: Mesh,
    pub inertia: Inertia,
}

/// Computes the pieces of all parts, with the kind of struts that the scene has.
pub(super) fn pieces(assembly: &Assembly, scene: &Scene) -> Result<Vec<Piece>, BuildProblem> {
    let is_slotted = scene.pull.is_some();
    let is_strut = |body: &&Body| matches!(body.mount, Mount::Strut(_));
    let has_spring = |bodies: &[Body]| bodies.iter().any(|body| body.kind == Kind::Spring);
    // The scene may use the other kind of strut than the assembly does.
    let is_swapped = has_spring(assembly.bodies()) != is_slotted;
    let own_bodies = assembly.bodies().iter();
    let own_bodies = own_bodies.filter(|body| !(is_swapped && is_strut(body)));
    let other_bodies = assembly.alternatives().iter().filter(|_| is_swapped);
    let springs = (0..4).filter(|_| is_swapped && is_slotted);
    let mut pieces: Vec<Piece> = springs.map(|servo| spring_piece(assembly, servo)).collect();
    for body in own_bodies.chain(other_bodies) {
        let grams = bill::grams(body, assembly);
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
                return Err(BuildProblem::Surface(name));
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
    let coil = assembly.robot().parts().spring;
    let length = assembly.layout().legs[servo].strut_length;
    let radius = coil.outer / 2.0;
    let middle = assembly.stack().strut[1];
    let size = Vector::new(length - 2.0 * coil.outer, coil.outer);
    let bar = Shape::rectangle(Vector::new(length / 2.0, 0.0), size, 0.0);
    let bar = Prism::solid([bar], [middle - radius, middle + radius]);
    let mesh = Mesh::of(&Solid::of(&[bar]));
    let shape = Inertia::of(&mesh);
    Piece {
        name: format!("spring {}", LEGS[servo]),
        node: Node::Slot(servo),
        kind: Kind::Spring,
        inertia: shape.scaled(bill::spring_grams(&coil) / shape.mass),
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
            let filled_groups = groups.filter(|(_, prisms)| !prisms.is_empty());
            filled_groups.collect()
        }
        Mount::Link(servo) if body.kind == Kind::Horn && scene.play > 0.0 => {
            all_prisms_on(Node::Horn(servo))
        }
        Mount::Strut(servo) if body.kind == Kind::Spring => all_prisms_on(Node::Slot(servo)),
        mount => all_prisms_on(Node::OnMount(mount)),
    }
}

/// The centroid of a layer, mm.
fn centroid_of(prism: &Prism) -> Vector {
    let outline = Outline::of(prism);
    outline.moment() * (1.0 / outline.area())
}
