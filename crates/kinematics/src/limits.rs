//! What a pose must keep clear of, and the sentence when it does not.

use core::fmt;

use crate::end::End;
use crate::five_bar::FiveBarPose;
use crate::lizard::Solution;
use crate::margins::Check;

/// Smallest margins and the slider's travel that a robot allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Least type-2 margin of head and tail, a sine, 0 to 1.
    pub type2: f64,
    /// Least signed type-1 margin of the four arms, a sine, 0 to 1.
    pub type1: f64,
    /// Least signed margin of the four legs, a sine, 0 to 1.
    pub leg: f64,
    /// Least slider travel from nominal, mm, at most 0.
    pub stroke_min: f64,
    /// Greatest slider travel from nominal, mm, at least 0.
    pub stroke_max: f64,
}

/// A limit that a pose breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Violation {
    /// What is out of bounds.
    pub what: Check,
    /// Its value: a sine for margins, mm for stroke and crossing.
    pub value: f64,
    /// The bound that it passes, in the same unit.
    pub limit: f64,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, value, limit } = *self;
        // To the last digit shown, without the sign of a zero.
        let shown = |scale: f64| libm::round(value * scale) / scale + 0.0;
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
                    "{side} slider travel {:+.2} mm is {passes} {limit:+.2} mm",
                    shown(100.0)
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
                    "{part} crank tips are crossed: {:+.2} mm from left to right",
                    shown(100.0)
                )
            }
            _ => write!(f, "margin {what} {:.3} is below {limit:.3}", shown(1e3)),
        }
    }
}

impl Limits {
    /// The limit that a condition breaks with a value (a sine, or mm), if it
    /// breaks one. A value at its limit is safe; crank tips at 0 mm are crossed.
    pub fn broken(&self, what: Check, value: f64) -> Option<Violation> {
        let (least, most) = match what {
            Check::Type2Head | Check::Type2Tail => (self.type2, f64::INFINITY),
            Check::Type1A1 | Check::Type1A2 | Check::Type1A3 | Check::Type1A4 => {
                (self.type1, f64::INFINITY)
            }
            Check::LegLf | Check::LegRf | Check::LegRh | Check::LegLh => (self.leg, f64::INFINITY),
            Check::StrokeLeft | Check::StrokeRight => (self.stroke_min, self.stroke_max),
            Check::UncrossedHead | Check::UncrossedTail => {
                let limit = 0.0;
                return (value <= limit).then_some(Violation { what, value, limit });
            }
        };
        let limit = if value < least {
            least
        } else if value > most {
            most
        } else {
            return None;
        };
        Some(Violation { what, value, limit })
    }

    /// Every limit that a solved pose breaks; none if it is safe. This is what
    /// safe means, everywhere.
    ///
    /// Besides margins and strokes it asks that the crank tips are not crossed
    /// (K2 > 0): beyond d = 0 lies a second region with good margins that the
    /// robot cannot be in.
    pub fn violations(&self, solution: &Solution) -> impl Iterator<Item = Violation> + use<> {
        let limits = *self;
        solution
            .conditions()
            .filter_map(move |(what, value)| limits.broken(what, value))
    }

    /// Every limit that a five-bar breaks by itself, as the given end, whatever
    /// the rest of the robot does.
    pub fn end_violations(
        &self,
        end: End,
        pose: &FiveBarPose,
    ) -> impl Iterator<Item = Violation> + use<> {
        let limits = *self;
        pose.conditions(end)
            .into_iter()
            .filter_map(move |(what, value)| limits.broken(what, value))
    }

    /// True if a solved pose breaks no limit.
    pub fn allow(&self, solution: &Solution) -> bool {
        self.violations(solution).next().is_none()
    }
}
