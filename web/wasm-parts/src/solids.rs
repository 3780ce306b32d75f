//! The triangles of all solids, as numbers that a graphics chip takes.

use lizard_parts::{Body, Mesh, Prism, Solid};
use wasm_bindgen::prelude::wasm_bindgen;

use crate::model::{Model, Refused};

/// The triangles of a solid.
#[derive(Clone, Debug)]
#[wasm_bindgen(getter_with_clone)]
pub struct Triangles {
    /// x, y and z of each corner, mm.
    pub corners: Vec<f32>,
    /// The three corners of each triangle.
    pub triangles: Vec<u32>,
}

impl Model {
    /// The triangles in the order of [`BodyEntry::solid`](crate::BodyEntry::solid): first those of each printed part, the same
    /// as in its STL file, then those of each bought body.
    ///
    /// # Errors
    /// Fails for a part whose layers make no body.
    pub fn solids(&self) -> Result<Vec<Triangles>, Refused> {
        let printed = self
            .needed()
            .map(|part| mesh(&part.name, &part.printed().0));
        let bought = self
            .bought_bodies()
            .map(|body| mesh(&body.name, &body.prisms));
        printed.chain(bought).collect()
    }

    fn bought_bodies(&self) -> impl Iterator<Item = &Body> {
        let bodies = self.assembly().bodies().iter();
        bodies.filter(|body| !self.needed().any(|part| part.bodies.contains(&body.name)))
    }
}

fn mesh(name: &str, prisms: &[Prism]) -> Result<Triangles, Refused> {
    let mesh = Mesh::of(&Solid::of(prisms));
    if !mesh.is_closed() {
        return Err(lizard_parts::Unfit::Surface(name.to_owned()).into());
    }
    let corners = mesh.corners.as_flattened().iter();
    let triangles = mesh.triangles.as_flattened().iter();
    Ok(Triangles {
        corners: corners.map(|&coordinate| coordinate as f32).collect(),
        triangles: triangles.map(|&corner| corner as u32).collect(),
    })
}
