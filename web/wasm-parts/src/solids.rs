//! The triangles of all solids, as bytes that a graphics chip takes.
//!
//! For each solid in the order of [`BodyEntry::solid`](crate::BodyEntry::solid): the number of its
//! corners and of its triangles, then the corners' x, y and z in mm, then the triangles' corners; all of it
//! little-endian in four bytes, counts and corners as integers and lengths as floats.

use lizard_parts::{Body, Mesh, Prism, Solid};

use crate::model::{Model, Refused};

impl Model {
    /// The triangles: first those of each printed part, the same as in its STL file, then those of
    /// each bought body.
    ///
    /// # Errors
    /// Fails for a part whose layers make no body.
    pub fn solids(&self) -> Result<Vec<u8>, Refused> {
        let mut bytes = Vec::new();
        for part in self.needed() {
            append_mesh(&part.name, &part.printed().0, &mut bytes)?;
        }
        for body in self.bought_bodies() {
            append_mesh(&body.name, &body.prisms, &mut bytes)?;
        }
        Ok(bytes)
    }

    fn bought_bodies(&self) -> impl Iterator<Item = &Body> {
        let bodies = self.assembly().bodies().iter();
        bodies.filter(|body| !self.needed().any(|part| part.bodies.contains(&body.name)))
    }
}

fn append_mesh(name: &str, prisms: &[Prism], bytes: &mut Vec<u8>) -> Result<(), Refused> {
    let mesh = Mesh::of(&Solid::of(prisms));
    if !mesh.is_closed() {
        return Err(lizard_parts::Unfit::Surface(name.to_owned()).into());
    }
    for count in [mesh.corners.len(), mesh.triangles.len()] {
        bytes.extend((count as u32).to_le_bytes());
    }
    for coordinate in mesh.corners.as_flattened() {
        bytes.extend((*coordinate as f32).to_le_bytes());
    }
    for corner in mesh.triangles.as_flattened() {
        bytes.extend((*corner as u32).to_le_bytes());
    }
    Ok(())
}
