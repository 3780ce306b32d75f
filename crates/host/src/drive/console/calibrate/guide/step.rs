//! The steps of a calibration, in their order.

/// A step of a calibration; the number is the index of its servo, 0 to 3.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    Begin,
    Horns,
    Sign(usize),
    Trim(usize),
    /// Asks whether to set scales and limits as well.
    More,
    Scale(usize),
    Limit(usize),
    Walk,
    Save,
    Saved,
}

/// All steps in the order of a calibration.
pub(super) const STEPS: [Step; 22] = [
    Step::Begin,
    Step::Horns,
    Step::Sign(0),
    Step::Sign(1),
    Step::Sign(2),
    Step::Sign(3),
    Step::Trim(0),
    Step::Trim(1),
    Step::Trim(2),
    Step::Trim(3),
    Step::More,
    Step::Scale(0),
    Step::Scale(1),
    Step::Scale(2),
    Step::Scale(3),
    Step::Limit(0),
    Step::Limit(1),
    Step::Limit(2),
    Step::Limit(3),
    Step::Walk,
    Step::Save,
    Step::Saved,
];
