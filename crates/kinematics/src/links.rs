//! The paper's table of link lengths.

/// The lengths of the body's links, mm, with the paper's symbols. All are above 0 except l0 and
/// l5, which may be 0. The paper's table prints l16 twice; the second one is l17.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Links {
    /// Base of the head, between A1 and A2, mm.
    pub l0: f64,
    /// Head, left crank, mm.
    pub l1: f64,
    /// Head, left coupler, mm.
    pub l2: f64,
    /// Head, right coupler, mm.
    pub l3: f64,
    /// Head, right crank, mm.
    pub l4: f64,
    /// Base of the tail, between A4 and A3, mm.
    pub l5: f64,
    /// Tail, left crank, mm.
    pub l6: f64,
    /// Tail, left coupler, mm.
    pub l7: f64,
    /// Tail, right coupler, mm.
    pub l8: f64,
    /// Tail, right crank, mm.
    pub l9: f64,
    /// Chassis on the left, between A4 and A1, mm.
    pub l10: f64,
    /// Left rear slider arm, mm.
    pub l11: f64,
    /// Left slider, rear half, mm.
    pub l12: f64,
    /// Left slider, front half, mm.
    pub l13: f64,
    /// Left front slider arm, mm.
    pub l14: f64,
    /// Chassis on the right, between A3 and A2; equal to l10, mm.
    pub l15: f64,
    /// Right rear slider arm, mm.
    pub l16: f64,
    /// Right slider, rear half, mm.
    pub l17: f64,
    /// Right slider, front half, mm.
    pub l18: f64,
    /// Right front slider arm, mm.
    pub l19: f64,
}

impl Links {
    /// Returns the lengths of the links from l0 to l19, mm.
    pub const fn to_array(&self) -> [f64; 20] {
        [
            self.l0, self.l1, self.l2, self.l3, self.l4, self.l5, self.l6, self.l7, self.l8,
            self.l9, self.l10, self.l11, self.l12, self.l13, self.l14, self.l15, self.l16,
            self.l17, self.l18, self.l19,
        ]
    }
}

impl From<[f64; 20]> for Links {
    fn from(l: [f64; 20]) -> Self {
        Self {
            l0: l[0],
            l1: l[1],
            l2: l[2],
            l3: l[3],
            l4: l[4],
            l5: l[5],
            l6: l[6],
            l7: l[7],
            l8: l[8],
            l9: l[9],
            l10: l[10],
            l11: l[11],
            l12: l[12],
            l13: l[13],
            l14: l[14],
            l15: l[15],
            l16: l[16],
            l17: l[17],
            l18: l[18],
            l19: l[19],
        }
    }
}
