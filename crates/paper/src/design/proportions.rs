//! The parameter design space: the dimensionless lengths r1 (crank), r2 (coupler) and r3 (half the base) of a
//! symmetrical five-bar, with r1 + r2 + r3 = 0.9.

use lizard_kinematics::FiveBar;
use serde::{Deserialize, Serialize};

/// The sum r1 + r2 + r3 of every design.
pub const PROPORTION_SUM: f64 = 0.9;

/// The smallest r1, r2 or r3 of a design. With smaller values, `factor_for_base` could overflow.
const MIN_PROPORTION: f64 = 0.001;

/// A point of the design space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Proportions {
    /// Crank, l1 / D.
    pub r1: f64,
    /// Coupler, l2 / D.
    pub r2: f64,
    /// Half the base, l0 / (2 D).
    pub r3: f64,
}

impl Proportions {
    /// The paper's proportions; according to the paper, they were measured on a gecko's head.
    pub const PAPER: Self = Self {
        r1: 0.3,
        r2: 0.5,
        r3: 0.1,
    };

    /// Creates proportions that meet the constraints of the design space: 0 < r1, r2 < 0.9; 0 < r3 < 0.45, so that
    /// r1 + r2 > r3 and the mechanism can be assembled; the sum 0.9; and no value below 0.001.
    ///
    /// # Errors
    /// Returns a message that names the violated constraint.
    pub fn new(r1: f64, r2: f64, r3: f64) -> Result<Self, String> {
        for (name, value, max) in [
            ("r1", r1, PROPORTION_SUM),
            ("r2", r2, PROPORTION_SUM),
            ("r3", r3, PROPORTION_SUM / 2.0),
        ] {
            if !(value > 0.0 && value < max) {
                return Err(format!(
                    "{name} is {value}, but must be greater than 0 and less than {max}"
                ));
            }
            if value < MIN_PROPORTION {
                return Err(format!(
                    "{name} is {value:.1e}, but must be at least {MIN_PROPORTION}"
                ));
            }
        }
        let sum = r1 + r2 + r3;
        if (sum - PROPORTION_SUM).abs() > 1e-9 {
            let factor = PROPORTION_SUM / sum;
            let [r1, r2, r3] = [r1, r2, r3].map(|length| length * factor);
            return Err(format!(
                "r1 + r2 + r3 is {sum:.6}, but must be {PROPORTION_SUM}; the same shape has r1 {r1:.6}, \
                 r2 {r2:.6}, r3 {r3:.6}"
            ));
        }
        Ok(Self { r1, r2, r3 })
    }

    /// The five-bar with the dimensional factor `d` (mm).
    pub fn five_bar(&self, d: f64) -> FiveBar {
        FiveBar {
            base: 2.0 * self.r3 * d,
            left_crank_length: self.r1 * d,
            left_coupler_length: self.r2 * d,
            right_coupler_length: self.r2 * d,
            right_crank_length: self.r1 * d,
        }
    }

    /// The dimensional factor (mm) for a base l0: D = R3 / r3.
    pub fn factor_for_base(&self, l0: f64) -> f64 {
        l0 / 2.0 / self.r3
    }
}

/// Returns the points of the design space on a grid with this step of r1 and r2. The edges are omitted.
pub fn grid_points(step: f64) -> Vec<Proportions> {
    let step_count = (PROPORTION_SUM / step + 1e-9) as usize;
    let mut points = Vec::new();
    for i in 1..step_count {
        for j in 1..step_count {
            // Multiplied, because a sum of steps would accumulate rounding errors.
            let (r1, r2) = (i as f64 * step, j as f64 * step);
            let r3 = PROPORTION_SUM - r1 - r2;
            if r3 > step * 1e-6 && r3 < PROPORTION_SUM / 2.0 - step * 1e-6 {
                points.push(Proportions { r1, r2, r3 });
            }
        }
    }
    points
}
