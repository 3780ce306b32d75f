//! A mesh as a binary STL file, mm.

use crate::files::mesh::Mesh;

/// Encodes a mesh as a binary STL file; its header has the part's `name`.
pub fn encode_stl(name: &str, mesh: &Mesh) -> Vec<u8> {
    let mut bytes = format!("lizard parts: {name}, mm").into_bytes();
    bytes.resize(80, b' ');
    let count = u32::try_from(mesh.triangles.len()).unwrap_or(u32::MAX);
    bytes.extend(count.to_le_bytes());
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|index| mesh.corners[index]);
        let [u, v] = [b, c].map(|end| [0, 1, 2].map(|i| end[i] - a[i]));
        let normal = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| u[i] * v[j] - u[j] * v[i]);
        let squares = normal.map(|component| component * component);
        let length = squares.iter().sum::<f64>().sqrt();
        let unit_normal = match length > 0.0 {
            true => normal.map(|component| component / length),
            false => [0.0; 3],
        };
        for vector in [unit_normal, a, b, c] {
            for component in vector {
                // Adding 0 turns -0 into 0, so that equal meshes give equal bytes.
                bytes.extend((component as f32 + 0.0).to_le_bytes());
            }
        }
        // The number of attribute bytes: none.
        bytes.extend([0, 0]);
    }
    bytes
}
