//! The paper's table of link lengths.

/// Every link of the body in mm, all above 0 but l0 and l5, by the paper's symbols. The table prints l16
/// twice; its second is l17.
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
    /// Left rear arm, mm.
    pub l11: f64,
    /// Left slider, rear half, mm.
    pub l12: f64,
    /// Left slider, front half, mm.
    pub l13: f64,
    /// Left front arm, mm.
    pub l14: f64,
    /// Chassis on the right, between A3 and A2; equal to l10, mm.
    pub l15: f64,
    /// Right rear arm, mm.
    pub l16: f64,
    /// Right slider, rear half, mm.
    pub l17: f64,
    /// Right slider, front half, mm.
    pub l18: f64,
    /// Right front arm, mm.
    pub l19: f64,
}

impl Links {
    /// The links from l0 to l19.
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
        let [
            l0,
            l1,
            l2,
            l3,
            l4,
            l5,
            l6,
            l7,
            l8,
            l9,
            l10,
            l11,
            l12,
            l13,
            l14,
            l15,
            l16,
            l17,
            l18,
            l19,
        ] = l;
        Self {
            l0,
            l1,
            l2,
            l3,
            l4,
            l5,
            l6,
            l7,
            l8,
            l9,
            l10,
            l11,
            l12,
            l13,
            l14,
            l15,
            l16,
            l17,
            l18,
            l19,
        }
    }
}
