//! What a pose must keep clear of, and the sentence when it does not.

use core::fmt;

use crate::lizard::Solution;
use crate::margins::Check;

/// Smallest margins and the slider's travel that a robot allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Least type-2 margin, head and tail.
    pub type2: f64,
    /// Least signed type-1 margin of the four arms.
    pub type1: f64,
    /// Least margin of the four legs.
    pub leg: f64,
    /// Shortest slider travel from nominal, mm.
    pub stroke_min: f64,
    /// Longest slider travel from nominal, mm.
    pub stroke_max: f64,
}

/// A limit that a pose breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Violation {
    /// What is out of bounds.
    pub what: Check,
    /// Its value: a sine for margins, mm for stroke and crossing.
    pub value: f64,
    /// The bound that it passes.
    pub limit: f64,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, value, limit } = *self;
        match what {
            Check::StrokeLeft | Check::StrokeRight => {
                let side = if what == Check::StrokeLeft {
                    "left"
                } else {
                    "right"
                };
                let passes = if value < limit { "below" } else { "above" };
                write!(
                    f,
                    "{side} slider travel {value:+.2} mm is {passes} {limit:+.2} mm"
                )
            }
            Check::UncrossedHead | Check::UncrossedTail => {
                let part = if what == Check::UncrossedHead {
                    "head"
                } else {
                    "tail"
                };
                write!(
                    f,
                    "{part} crank tips are crossed: {value:+.2} mm from left to right"
                )
            }
            _ => write!(f, "margin {what} {value:.3} is below {limit:.3}"),
        }
    }
}

impl Limits {
    /// Every limit that a solved pose breaks; none if it is safe.
    ///
    /// Besides margins and stroke this asks that the crank tips are not crossed
    /// (K2 > 0): beyond d = 0 lies a second region with good margins that the
    /// robot cannot be in.
    pub fn violations(&self, solution: &Solution) -> impl Iterator<Item = Violation> + use<> {
        let limits = *self;
        let margins = solution.margins.iter().filter_map(move |(what, value)| {
            let limit = match what {
                Check::ApexHead | Check::ApexTail => limits.type2,
                Check::LegFl | Check::LegFr | Check::LegBr | Check::LegBl => limits.leg,
                _ => limits.type1,
            };
            (value < limit).then_some(Violation { what, value, limit })
        });
        let strokes = [
            (Check::StrokeLeft, solution.left.s),
            (Check::StrokeRight, solution.right.s),
        ]
        .into_iter()
        .filter_map(move |(what, value)| {
            if value < limits.stroke_min {
                let limit = limits.stroke_min;
                Some(Violation { what, value, limit })
            } else if value > limits.stroke_max {
                let limit = limits.stroke_max;
                Some(Violation { what, value, limit })
            } else {
                None
            }
        });
        let crossings = [
            (Check::UncrossedHead, solution.head.gap.x),
            (Check::UncrossedTail, solution.tail.gap.x),
        ]
        .into_iter()
        .filter(|(_, across)| *across <= 0.0)
        .map(|(what, value)| Violation {
            what,
            value,
            limit: 0.0,
        });
        margins.chain(strokes).chain(crossings)
    }

    /// True if a solved pose breaks no limit.
    pub fn allow(&self, solution: &Solution) -> bool {
        self.violations(solution).next().is_none()
    }
}
