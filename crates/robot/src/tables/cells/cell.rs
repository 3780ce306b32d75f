//! A cell: a rectangle of two servos' angles. Proves that all poses of a cell keep a condition of the guard.

use std::f64::consts::TAU;

use lizard_core::numbers::units::TURN;
use lizard_kinematics::Vector;

/// Largest number of successive divisions of a cell in four before it counts as not proven. A bound over a cell is
/// too wide by an amount about proportional to the cell's size, so each division proves cells that lie half as far
/// from a limit.
const DIVISIONS: u32 = 4;

/// Allowance for floating-point errors, both as a sine and in mm; far larger than these errors are.
pub(super) const ROUNDING_ALLOWANCE: f64 = 1e-9;

/// A range of one servo's angles in the chassis frame, in 1/65536 turn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub low: f64,
    pub high: f64,
}

/// The ranges of two servos' angles: first that of a map's row, then that of its column.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell(pub [Span; 2]);

/// The result of judging a condition over a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// The condition, as the firmware computes it in integers, is true at every pose of the cell.
    Kept,
    /// The centre of the cell breaks the condition.
    Broken,
    /// The bounds over the cell are too wide for a decision.
    Open,
}

/// A condition of the guard that depends on two servos.
pub(super) trait Condition {
    /// The indices of the servo of the rows and the servo of the columns.
    fn servos(&self) -> [usize; 2];

    /// Judges the condition over a cell.
    fn judge(&self, cell: &Cell) -> Verdict;
}

impl Span {
    /// The middle of the span, degrees.
    pub fn centre(&self) -> f64 {
        (self.low + self.high) / 2.0 * 360.0 / f64::from(TURN)
    }

    /// Half the width of the span, radians.
    pub fn half(&self) -> f64 {
        (self.high - self.low) / 2.0 * TAU / f64::from(TURN)
    }

    /// Unit vector at the middle of the span.
    pub fn direction(&self) -> Vector {
        Vector::direction(self.centre())
    }

    fn halves(self) -> [Self; 2] {
        let middle = (self.low + self.high) / 2.0;
        [
            Self {
                high: middle,
                ..self
            },
            Self {
                low: middle,
                ..self
            },
        ]
    }
}

impl Cell {
    /// True if a condition is proven in the whole cell, divided up to [`DIVISIONS`] times.
    pub fn proves(&self, condition: &impl Condition) -> bool {
        self.proves_within(condition, DIVISIONS)
    }

    fn proves_within(&self, condition: &impl Condition, divisions: u32) -> bool {
        match condition.judge(self) {
            Verdict::Kept => true,
            Verdict::Broken => false,
            Verdict::Open => {
                let [rows, columns] = self.0.map(Span::halves);
                divisions > 0
                    && rows.into_iter().all(|row| {
                        columns.into_iter().all(|column| {
                            Self([row, column]).proves_within(condition, divisions - 1)
                        })
                    })
            }
        }
    }
}
