//! What is wrong with a pose, and by how much: the guard's reason.

/// One of the twelve conditions of a safe pose, in the order in which they are
/// checked: type-2 of head and tail, type-1 at A1..A4, legs at A1..A4, slider
/// strokes left and right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Check(u8);

/// The kinds of conditions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The two couplers of a loop are too near to one line.
    Type2,
    /// Crank and coupler are too near to one line, or the elbow is bent inwards.
    Type1,
    /// The parallelogram of a leg is too near to flat.
    Leg,
    /// The slider of a side leaves its stroke.
    Stroke,
}

impl Check {
    /// The number of conditions that are margins; strokes come after them.
    pub const MARGINS: usize = 10;

    /// The condition at a place of the order, 0..=11.
    pub const fn at(place: u8) -> Self {
        Self(place)
    }

    /// What kind of condition this is.
    pub const fn kind(self) -> Kind {
        match self.0 {
            0..2 => Kind::Type2,
            2..6 => Kind::Type1,
            6..10 => Kind::Leg,
            _ => Kind::Stroke,
        }
    }

    /// Which one of its kind, from 0: head and tail, A1 to A4, left and right.
    pub const fn which(self) -> u8 {
        match self.kind() {
            Kind::Type2 => self.0,
            Kind::Type1 => self.0 - 2,
            Kind::Leg => self.0 - 6,
            Kind::Stroke => self.0 - 10,
        }
    }
}

/// The first condition that a pose breaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hazard {
    /// Which one.
    pub check: Check,
    /// A margin in Q15, or a slider's travel from nominal in 1/256 mm.
    pub value: i16,
}
