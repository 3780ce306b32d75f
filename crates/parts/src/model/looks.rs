//! The parts' colours. Parts of one body and one colour share a mesh.

use crate::layers::body::Kind;

/// The colour that some kinds of parts share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Material {
    /// The name of its material.
    pub name: &'static str,
    /// Red, green, blue and opacity, 0 to 1.
    pub colour: &'static str,
}

impl Material {
    /// All looks.
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

    /// The look of a kind of parts.
    pub fn of(kind: Kind) -> Self {
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
