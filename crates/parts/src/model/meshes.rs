//! Mesh files for URDF and SDF: one for each body and material.

use crate::files::File;
use crate::files::mesh::Mesh;
use crate::files::stl::stl;
use crate::model::material::Material;
use crate::model::node::Node;
use crate::model::pieces::Piece;

/// The materials that occur among the parts of a body.
pub(super) fn materials_of(pieces: &[Piece], node: Node) -> impl Iterator<Item = Material> {
    let is_present = move |material: &Material| {
        let mut node_pieces = pieces.iter().filter(|piece| piece.node == node);
        node_pieces.any(|piece| Material::of(piece.kind) == *material)
    };
    Material::ALL.into_iter().filter(is_present)
}

/// The name of the mesh file of those parts of a body that have a given material.
pub(super) fn mesh_file_name(node: Node, material: Material) -> String {
    format!("{}-{}.stl", node.identifier(), material.name)
}

/// The mesh files of all bodies, mm, each in the frame of its body.
pub(super) fn mesh_files(pieces: &[Piece], nodes: &[Node]) -> Vec<File> {
    let mut mesh_files = Vec::new();
    for &node in nodes {
        for material in materials_of(pieces, node) {
            let mut mesh = Mesh::default();
            let has_node_and_material =
                |piece: &&Piece| piece.node == node && Material::of(piece.kind) == material;
            for piece in pieces.iter().filter(has_node_and_material) {
                let first_corner = mesh.corners.len();
                mesh.corners.extend(&piece.mesh.corners);
                let triangles = piece.mesh.triangles.iter();
                mesh.triangles
                    .extend(triangles.map(|triangle| triangle.map(|corner| first_corner + corner)));
            }
            mesh_files.push(File {
                bytes: stl(&node.name(), &mesh),
                path: mesh_file_name(node, material),
            });
        }
    }
    mesh_files
}
