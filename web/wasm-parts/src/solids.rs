//! The triangles of all solids, as arrays for the graphics processor.

use lizard_parts::{Body, Mesh, Prism};
use wasm_bindgen::prelude::wasm_bindgen;

use crate::model::{Model, Refusal};

/// The triangles of a solid.
#[derive(Clone, Debug)]
#[wasm_bindgen(getter_with_clone)]
pub struct Triangles {
    /// x, y and z of each corner, mm.
    pub corners: Vec<f32>,
    /// The indices of each triangle's three corners.
    pub triangles: Vec<u32>,
}

impl Model {
    /// Makes the triangles of each solid, in the order of [`BodyEntry::solid`](crate::BodyEntry::solid): first the
    /// printed parts, as in their STL files, then the bought bodies.
    ///
    /// # Errors
    /// Fails if the layers of a part do not form a closed body.
    pub fn make_solids(&self) -> Result<Vec<Triangles>, Refusal> {
        let parts = self.needed_parts();
        let printed = parts.map(|part| make_triangles(&part.name, &part.build_printed_layers().0));
        let is_bought = |body: &&Body| !self.needed_parts().any(|part| part.prints_body(body));
        let bodies = self.assembly.bodies().iter().filter(is_bought);
        let bought = bodies.map(|body| make_triangles(&body.name, &body.prisms));
        printed.chain(bought).collect()
    }
}

fn make_triangles(name: &str, prisms: &[Prism]) -> Result<Triangles, Refusal> {
    let mesh = Mesh::from_prisms(name, prisms)?;
    let corners = mesh.corners.as_flattened().iter();
    let triangles = mesh.triangles.as_flattened().iter();
    Ok(Triangles {
        corners: corners.map(|&coordinate| coordinate as f32).collect(),
        triangles: triangles.map(|&corner| corner as u32).collect(),
    })
}
