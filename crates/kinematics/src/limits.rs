//! The limits of a safe pose, and the message for each violation.

use core::fmt;

use crate::end::End;
use crate::five_bar::FiveBarPose;
use crate::lizard::Solution;
use crate::margins::Check;
use crate::side::Side;

/// The smallest margins and the range of the sliders' travel that a robot allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Smallest type-2 margin of head and tail, a sine, 0 to 1.
    pub type2: f64,
    /// Smallest signed type-1 margin of the four arms, a sine, 0 to 1.
    pub type1: f64,
    /// Smallest signed margin of the four legs, a sine, 0 to 1.
    pub leg: f64,
    /// Smallest slider travel from the nominal length, mm, at most 0.
    pub stroke_min: f64,
    /// Largest slider travel from the nominal length, mm, at least 0.
    pub stroke_max: f64,
}

/// A violation of a limit by a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Violation {
    /// The condition that the pose does not meet.
    pub check: Check,
    /// The condition's value in the pose: a sine for margins, mm for slider travels and crossing.
    pub value: f64,
    /// The violated limit, in the same unit.
    pub limit: f64,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            check,
            value,
            limit,
        } = *self;
        // Rounding first, and adding 0.0, keeps a negative zero from being shown.
        let round_to = |scale: f64| libm::round(value * scale) / scale + 0.0;
        let (thousandths, hundredths) = (round_to(1e3), round_to(100.0));
        let write_stroke = |f: &mut fmt::Formatter<'_>, side: Side| {
            let relation = if value < limit { "below" } else { "above" };
            write!(
                f,
                "{side} slider travel {hundredths:+.2} mm is {relation} {limit:+.2} mm"
            )
        };
        let write_crossed = |f: &mut fmt::Formatter<'_>, end: End| {
            write!(
                f,
                "{end} crank tips are crossed: {hundredths:+.2} mm from left to right"
            )
        };
        match check {
            Check::StrokeLeft => write_stroke(f, Side::Left),
            Check::StrokeRight => write_stroke(f, Side::Right),
            Check::UncrossedHead => write_crossed(f, End::Head),
            Check::UncrossedTail => write_crossed(f, End::Tail),
            _ => write!(f, "margin {check} {thousandths:.3} is below {limit:.3}"),
        }
    }
}

impl Limits {
    /// Returns the violation of a condition's limit by a value (a sine or mm); `None` if the value is safe. A value at
    /// its limit is safe, but a distance of 0 mm between crank tips counts as crossed.
    pub fn violation(&self, check: Check, value: f64) -> Option<Violation> {
        let limit_if_below = |limit: f64| (value < limit).then_some(limit);
        let limit = match check {
            Check::Type2Head | Check::Type2Tail => limit_if_below(self.type2),
            Check::Type1A1 | Check::Type1A2 | Check::Type1A3 | Check::Type1A4 => {
                limit_if_below(self.type1)
            }
            Check::LegLf | Check::LegRf | Check::LegRh | Check::LegLh => limit_if_below(self.leg),
            Check::StrokeLeft | Check::StrokeRight => {
                let max = self.stroke_max;
                limit_if_below(self.stroke_min).or((value > max).then_some(max))
            }
            Check::UncrossedHead | Check::UncrossedTail => (value <= 0.0).then_some(0.0),
        };
        limit.map(|limit| Violation {
            check,
            value,
            limit,
        })
    }

    /// All limits that a solved pose violates; none if the pose is safe. This is the only definition of a safe pose.
    ///
    /// In addition to margins and slider travels, a safe pose requires crank tips that are not crossed: the x of
    /// [`FiveBarPose::gap`], the paper's K2, must be above 0. Poses with crossed tips may have good margins, too, but
    /// the robot cannot reach them without passing through a singularity.
    pub fn violations(&self, solution: &Solution) -> impl Iterator<Item = Violation> + use<> {
        let limits = *self;
        solution
            .conditions()
            .filter_map(move |(check, value)| limits.violation(check, value))
    }

    /// All limits that the five-bar of one end violates, regardless of the rest of the robot.
    pub fn end_violations(
        &self,
        end: End,
        pose: &FiveBarPose,
    ) -> impl Iterator<Item = Violation> + use<> {
        let limits = *self;
        pose.conditions(end)
            .into_iter()
            .filter_map(move |(check, value)| limits.violation(check, value))
    }

    /// True if a solved pose violates no limit.
    pub fn is_safe(&self, solution: &Solution) -> bool {
        self.violations(solution).next().is_none()
    }
}
