//! The paper's table of link lengths.

/// Every link of the body in mm, by the paper's symbols. The table prints l16
/// twice; its second is l17.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // One line each would only repeat the headings.
pub struct Links {
    // Head: base, left crank, left coupler, right coupler, right crank.
    pub l0: f64,
    pub l1: f64,
    pub l2: f64,
    pub l3: f64,
    pub l4: f64,
    // Tail: base, left crank, left coupler, right coupler, right crank.
    pub l5: f64,
    pub l6: f64,
    pub l7: f64,
    pub l8: f64,
    pub l9: f64,
    // Left: chassis, rear arm, slider halves, front arm.
    pub l10: f64,
    pub l11: f64,
    pub l12: f64,
    pub l13: f64,
    pub l14: f64,
    // Right: chassis, rear arm, slider halves, front arm.
    pub l15: f64,
    pub l16: f64,
    pub l17: f64,
    pub l18: f64,
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
