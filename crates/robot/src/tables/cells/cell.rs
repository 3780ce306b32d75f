//! A cell: a rectangle in the plane of two servos' angles, and the proof that all its poses meet a condition of the
//! guard.

use std::f64::consts::TAU;

use lizard_core::numbers::units::STEPS_PER_TURN;
use lizard_kinematics::Vector;

/// Largest number of successive divisions of a cell into four. A bound over a cell is too wide by an amount roughly
/// proportional to the cell's size, so each division halves the distance from a limit at which a cell can be proven.
const MAX_DIVISIONS: u32 = 4;

/// Allowance for floating-point errors, in a sine (no unit) and in a length (mm). It is far larger than these errors.
pub(super) const ROUNDING_ALLOWANCE: f64 = 1e-9;

/// A range of one servo's angles in the chassis frame, in 1/65536 turn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub min: f64,
    pub max: f64,
}

/// The ranges of two servos' angles: first the servo of the rows of a map of cells, then the servo of its columns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell(pub [Span; 2]);

/// The verdict on a condition in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// Every pose of the cell meets the condition, as the firmware computes it in integers.
    Proven,
    /// The centre of the cell violates the condition.
    Violated,
    /// The bounds over the cell are too wide for a decision.
    Undetermined,
}

/// The verdicts on a single pose at these distances from a limit, as fractions of the error bound; for tests.
#[cfg(test)]
pub(super) const VERDICTS_BY_CLEARANCE: [(f64, Verdict); 4] = [
    (1.01, Verdict::Proven),
    (0.99, Verdict::Undetermined),
    (0.01, Verdict::Undetermined),
    (-0.01, Verdict::Violated),
];

/// A condition of the guard that depends on two servos.
pub(super) trait Condition {
    /// The indices of the servo of the rows and the servo of the columns.
    fn servos(&self) -> [usize; 2];

    /// Evaluates the condition over a cell.
    fn evaluate(&self, cell: &Cell) -> Verdict;
}

impl Span {
    /// A span of a single angle.
    #[cfg(test)]
    pub fn single_angle(angle: f64) -> Self {
        Self {
            min: angle,
            max: angle,
        }
    }

    /// Half the width of the span, radians.
    pub fn half_width_rad(&self) -> f64 {
        (self.max - self.min) / 2.0 * TAU / f64::from(STEPS_PER_TURN)
    }

    /// Unit vector in the direction of the span's middle.
    pub fn direction(&self) -> Vector {
        let centre_deg = (self.min + self.max) / 2.0 * 360.0 / f64::from(STEPS_PER_TURN);
        Vector::from_angle(centre_deg)
    }

    /// The lower and the upper half of the span.
    fn halves(self) -> [Self; 2] {
        let middle = (self.min + self.max) / 2.0;
        [[self.min, middle], [middle, self.max]].map(|[min, max]| Self { min, max })
    }
}

impl Cell {
    /// True if a condition is proven in the whole cell, divided up to [`MAX_DIVISIONS`] times.
    pub fn has_proof_of(&self, condition: &impl Condition) -> bool {
        self.has_proof_within(condition, MAX_DIVISIONS)
    }

    /// Like [`Cell::has_proof_of`], with at most this many successive divisions.
    fn has_proof_within(&self, condition: &impl Condition, max_divisions: u32) -> bool {
        match condition.evaluate(self) {
            Verdict::Proven => true,
            Verdict::Violated => false,
            Verdict::Undetermined => {
                let [rows, columns] = self.0.map(Span::halves);
                max_divisions > 0
                    && rows.into_iter().all(|row| {
                        columns.into_iter().all(|column| {
                            Self([row, column]).has_proof_within(condition, max_divisions - 1)
                        })
                    })
            }
        }
    }
}
