//! Mesh files for URDF and SDF, one for each body and material.

use crate::files::OutputFile;
use crate::files::mesh::Mesh;
use crate::files::stl::encode_stl;
use crate::model::material::Material;
use crate::model::node::Node;
use crate::model::pieces::Piece;

/// Lists the materials of a body's parts.
pub(super) fn list_materials(pieces: &[Piece], node: Node) -> impl Iterator<Item = Material> {
    let is_present = move |material: &Material| {
        let mut node_pieces = pieces.iter().filter(|piece| piece.node == node);
        node_pieces.any(|piece| Material::for_kind(piece.kind) == *material)
    };
    Material::ALL.into_iter().filter(is_present)
}

/// Formats the name of the mesh file for a body's parts with a material.
pub(super) fn format_mesh_name(node: Node, material: Material) -> String {
    format!("{}-{}.stl", node.identifier(), material.name)
}

/// Makes the mesh files of all bodies, mm, each in the frame of its body.
pub(super) fn make_mesh_files(pieces: &[Piece], nodes: &[Node]) -> Vec<OutputFile> {
    let mut mesh_files = Vec::new();
    for &node in nodes {
        for material in list_materials(pieces, node) {
            let mut mesh = Mesh::default();
            let has_node_and_material =
                |piece: &&Piece| piece.node == node && Material::for_kind(piece.kind) == material;
            for piece in pieces.iter().filter(has_node_and_material) {
                let first_corner = mesh.corners.len();
                mesh.corners.extend(&piece.mesh.corners);
                let triangles = piece.mesh.triangles.iter();
                mesh.triangles
                    .extend(triangles.map(|triangle| triangle.map(|corner| first_corner + corner)));
            }
            mesh_files.push(OutputFile {
                bytes: encode_stl(&node.name(), &mesh),
                path: format_mesh_name(node, material),
            });
        }
    }
    mesh_files
}
