//! The margins of a five-bar linkage to its singularities, in integers.
//!
//! Two cranks carry two couplers, whose common joint is the end point, the head or the tail. If the couplers line up,
//! the end point can move although both servos hold: a type-2 singularity. If a crank lines up with its coupler, the
//! elbow between them can change to its other working mode: a type-1 singularity. Each margin is the sine of the angle
//! between two links, so 0 is singular and 1 is a right angle.
//!
//! As in the paper, theta1 and theta4 are the directions of the left and the right crank, theta2 and theta3 the
//! directions of their couplers. `k` is the vector from the left crank tip to the right one; `a` is the left coupler,
//! `b` the right one; [`crate::numbers::couplers`] defines rise and skew at `s = |k|^2`. For a crank of direction `u`,
//! `cross = k_x u_y - k_y u_x` and `dot = k . u`. Then
//!
//! ```text
//! type-2       2 a b sin(theta3 - theta2) = rise s
//! type-1, left   2 a sin(theta1 - theta2) = (1 + skew) cross - rise dot
//! type-1, right  2 b sin(theta3 - theta4) = (1 - skew) cross + rise dot
//! ```
//!
//! The paper's printed conditions, sin(theta2 + theta3) = 0 and sin(2 theta11) = 0, are not used: both hold in the
//! neutral pose, in which the robot stands safely, and neither holds at the real singularity.

use lizard_avr::{mul, mul_unsigned};

use crate::guard::trig::Direction;
use crate::numbers::couplers::{CouplerTables, Couplers, TriangleShape};
use crate::numbers::link_lengths::LinkLengths;
use crate::numbers::part::End;
use crate::numbers::robot::Robot;
use crate::numbers::units::Sine;

/// A five-bar linkage: its link lengths and the tables of its couplers.
#[derive(Clone, Copy, Debug)]
pub struct FiveBar<'a> {
    links: LinkLengths,
    tables: CouplerTables<'a>,
}

/// The margins of an end's five-bar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EndMargins {
    /// sin(theta3 - theta2). Negative if the crank tips have crossed, which no robot can reach without passing the
    /// singularity.
    pub type2: Sine,
    /// sin(theta1 - theta2); negative if the left elbow is bent inwards.
    pub type1_left: Sine,
    /// sin(theta3 - theta4); negative if the right elbow is bent inwards.
    pub type1_right: Sine,
}

impl<'a> FiveBar<'a> {
    /// Creates a linkage from its link lengths and the tables of its couplers.
    pub const fn new(links: LinkLengths, tables: CouplerTables<'a>) -> Self {
        Self { links, tables }
    }

    /// Computes the margins for these directions of the cranks, in the end's own frame. All margins are zero if the
    /// loop cannot close or the tables have no value; the true type-2 margin is then below a tenth.
    #[inline(never)]
    pub fn margins(&self, left: &Direction, right: &Direction) -> EndMargins {
        let links = &self.links;
        // One unit is two steps of the links, so that the vector fits into 16 bits and each product is shifted by whole
        // bytes.
        let tips = TipVector {
            x: (links.base >> 1).wrapping_add(rounded_upper_half(
                mul(links.right_crank, right.cos) - mul(links.left_crank, left.cos),
            )),
            y: rounded_upper_half(
                mul(links.right_crank, right.sin) - mul(links.left_crank, left.sin),
            ),
        };
        let tips_sq = mul(tips.x, tips.x).wrapping_add(mul(tips.y, tips.y)) as u32;
        let Some(TriangleShape { rise, skew }) =
            Couplers::new(links.couplers, self.tables).shape_at(tips_sq)
        else {
            return EndMargins::default();
        };
        // Rounded to nearest, because a small margin has few bits.
        let square = (tips_sq + (1 << (links.square_shift - 1))) >> links.square_shift;
        let square = square.min(0x7fff) as i16;
        let area = (mul(rise, square) >> links.area_shift) as u16;
        let magnitude = saturate((mul_unsigned(area, links.area_reciprocal) >> 15) as i32);
        EndMargins {
            type2: Sine(if tips.x > 0 { magnitude } else { -magnitude }),
            type1_left: tips.type1_sine(left, rise.wrapping_neg(), skew, links.left_reciprocal),
            type1_right: tips.type1_sine(right, rise, skew.wrapping_neg(), links.right_reciprocal),
        }
    }
}

impl<'a> Robot<'a> {
    /// Returns an end's five-bar, in the frame of that end.
    pub fn five_bar(&self, end: End) -> FiveBar<'a> {
        FiveBar::new(self.link_lengths(end), self.coupler_tables(end))
    }
}

/// The vector from the left crank tip to the right one, in units of two steps of the links; x is along the base.
#[derive(Clone, Copy)]
struct TipVector {
    x: i16,
    y: i16,
}

impl TipVector {
    /// Computes the type-1 margin of a crank: `(1 + skew) cross + rise dot`, divided by twice the length of the
    /// coupler.
    #[inline(never)]
    fn type1_sine(self, crank: &Direction, rise: i16, skew: i16, coupler_reciprocal: i16) -> Sine {
        let cross = rounded_upper_half((mul(self.x, crank.sin) - mul(self.y, crank.cos)) << 1);
        let dot = rounded_upper_half((mul(self.x, crank.cos) + mul(self.y, crank.sin)) << 1);
        // The sum is at most twice the coupler, so overflows of its terms beyond 16 bits cancel.
        let mut scaled_sine = cross.wrapping_add((mul(rise, dot) >> 10) as i16);
        if skew != 0 {
            scaled_sine = scaled_sine.wrapping_add((mul(skew, cross) >> 10) as i16);
        }
        Sine(saturate(mul(scaled_sine, coupler_reciprocal) >> 12))
    }
}

/// Limits a sine whose magnitude exceeds 1 because of rounding.
fn saturate(margin: i32) -> i16 {
    margin.clamp(-0x7fff, 0x7fff) as i16
}

/// Returns the upper 16 bits of a product, rounded to nearest.
pub(crate) fn rounded_upper_half(product: i32) -> i16 {
    (product.wrapping_add(0x8000) >> 16) as i16
}

#[cfg(test)]
mod tests;
