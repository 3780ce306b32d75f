//! Mesh files for URDF and SDF, one for each body and material.

use crate::files::OutputFile;
use crate::files::mesh::Mesh;
use crate::files::stl::encode_stl;
use crate::model::material::Material;
use crate::model::node::Node;
use crate::model::pieces::Piece;
use crate::model::{Pieces, Scene};

/// Lists the materials of a body's parts.
pub(super) fn list_materials(pieces: &[Piece], node: Node) -> impl Iterator<Item = Material> {
    let is_present =
        move |material: &Material| pieces.iter().any(|piece| piece.belongs_to(node, *material));
    Material::ALL.into_iter().filter(is_present)
}

/// Formats the name of the mesh file for a body's parts with a material.
pub(super) fn format_mesh_name(node: Node, material: Material) -> String {
    format!("{}-{}.stl", node.identifier(), material.name)
}

impl Piece {
    /// True if the piece is a part of a body and has a material.
    fn belongs_to(&self, node: Node, material: Material) -> bool {
        self.node == node && Material::for_kind(self.kind) == material
    }
}

impl Pieces<'_> {
    /// Makes the meshes for URDF and SDF, mm, each in the frame of its body and with its file name in the mesh folder.
    pub fn make_meshes(&self, scene: &Scene) -> Vec<OutputFile> {
        let mut mesh_files = Vec::new();
        for node in Node::all(scene.strut_spring.is_some(), scene.play > 0.0) {
            for material in list_materials(&self.pieces, node) {
                let mut mesh = Mesh::default();
                let pieces = self.pieces.iter();
                for piece in pieces.filter(|piece| piece.belongs_to(node, material)) {
                    let first_corner = mesh.corners.len();
                    mesh.corners.extend(&piece.mesh.corners);
                    let triangles = piece.mesh.triangles.iter();
                    mesh.triangles
                        .extend(triangles.map(|triangle| triangle.map(|i| first_corner + i)));
                }
                let stl = encode_stl(&node.name(), &mesh);
                mesh_files.push(OutputFile::new(format_mesh_name(node, material), stl));
            }
        }
        mesh_files
    }
}
