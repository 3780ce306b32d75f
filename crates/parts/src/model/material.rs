//! Materials: the colours of the parts. All parts of a body with the same material have a common mesh file.

use crate::layers::body::Kind;

/// A named colour for some kinds of parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Material {
    /// Name of the material, which is also part of the mesh files' names.
    pub name: &'static str,
    /// Red, green, blue and opacity, 0 to 1.
    pub colour: &'static str,
}

impl Material {
    /// All materials.
    pub const ALL: [Self; 7] = [
        Self::new("printed", "0.36 0.62 0.36 1"),
        Self::new("servo", "0.15 0.3 0.65 1"),
        Self::new("horn", "0.95 0.95 0.95 1"),
        Self::new("board", "0.0 0.5 0.55 1"),
        Self::new("battery", "0.25 0.25 0.28 1"),
        Self::new("rubber", "0.15 0.15 0.15 1"),
        Self::new("metal", "0.6 0.6 0.62 1"),
    ];

    const fn new(name: &'static str, colour: &'static str) -> Self {
        Self { name, colour }
    }

    /// Returns the material of a kind of parts.
    pub fn for_kind(kind: Kind) -> Self {
        let [printed, servo, horn, board, battery, rubber, metal] = Self::ALL;
        match kind {
            Kind::Printed => printed,
            Kind::Servo => servo,
            Kind::Horn => horn,
            Kind::Board => board,
            Kind::Battery => battery,
            Kind::Pad => rubber,
            _ => metal,
        }
    }
}
