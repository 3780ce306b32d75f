//! The steps of a calibration, in their order.

/// A step of a calibration. A step with a number is about one servo; the number is its index, 0 to 3.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    /// Says what the user needs.
    Begin,
    /// Holds all servos in their middle, so that the horns can be fitted.
    Horns,
    /// Asks for the direction in which the servo has turned.
    Sign(usize),
    /// Turns the crank to its neutral angle.
    Trim(usize),
    /// Asks whether to set scales and limits as well.
    OfferScales,
    /// Adjusts the pulse width per degree.
    Scale(usize),
    /// Adjusts the two limits of the travel.
    Limit(usize),
    /// Walks as a test.
    Walk,
    /// Shows the calibration that Enter will save.
    Save,
    /// Says that the calibration is saved.
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
    Step::OfferScales,
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
